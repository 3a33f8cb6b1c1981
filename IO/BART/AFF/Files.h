// Where the text of AFF files comes from: the disk, or memory for tests and fuzzing.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace hrt
{
namespace bart
{

class FileSource
{
public:
  virtual ~FileSource() = default;
  // Gives the text of a file. False, with a reason, if there is none or it has more than most
  // bytes.
  virtual bool read(
    const std::string& path, std::size_t most, std::string& text, std::string& reason) = 0;
};

class DiskFiles : public FileSource
{
public:
  bool read(
    const std::string& path, std::size_t most, std::string& text, std::string& reason) override;
};

class MemoryFiles : public FileSource
{
public:
  std::map<std::string, std::string> files;
  bool read(
    const std::string& path, std::size_t most, std::string& text, std::string& reason) override;
};

// The path of a file that another one names: relative to the folder of the one that names it.
std::string pathBeside(const std::string& namedBy, const std::string& name);

// The path of a texture: beside the file that names it, or in the folder TextureFiles there or
// beside that folder, as BART's scenes are laid out. Empty where there is none.
std::string findTexture(const std::string& namedBy, const std::string& name);

} // namespace bart
} // namespace hrt
