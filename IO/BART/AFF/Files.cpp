// Implements the sources of text. Only ordinary files are opened: a scene that names a device or a
// pipe would otherwise never end.
#include "IO/BART/AFF/Files.h"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace hrt
{
namespace bart
{
namespace
{

const char* const kTextureFolder = "TextureFiles";

bool isFile(const std::filesystem::path& path)
{
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

std::string tooLong(std::size_t size, std::size_t most)
{
  return "has " + std::to_string(size) + " bytes, more than the " + std::to_string(most) +
    " that are left to this scene";
}

} // anonymous namespace

//------------------------------------------------------------------------------
bool DiskFiles::read(
  const std::string& path, std::size_t most, std::string& text, std::string& reason)
{
  std::error_code error;
  if (!isFile(path))
  {
    reason = "is not an existing file";
    return false;
  }
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > most)
  {
    reason = tooLong(static_cast<std::size_t>(size), most);
    return false;
  }
  std::ifstream stream(path, std::ios::binary);
  text.resize(error ? 0 : static_cast<std::size_t>(size));
  if (error || !stream || !stream.read(text.data(), static_cast<std::streamsize>(text.size())))
  {
    reason = "cannot be read";
    return false;
  }
  return true;
}

//------------------------------------------------------------------------------
bool MemoryFiles::read(
  const std::string& path, std::size_t most, std::string& text, std::string& reason)
{
  const auto found = this->files.find(path);
  if (found == this->files.end())
  {
    reason = "is not an existing file";
    return false;
  }
  if (found->second.size() > most)
  {
    reason = tooLong(found->second.size(), most);
    return false;
  }
  text = found->second;
  return true;
}

//------------------------------------------------------------------------------
std::string pathBeside(const std::string& namedBy, const std::string& name)
{
  return (std::filesystem::path(namedBy).parent_path() / name).lexically_normal().string();
}

//------------------------------------------------------------------------------
std::string findTexture(const std::string& namedBy, const std::string& name)
{
  const std::filesystem::path folder = std::filesystem::path(namedBy).parent_path();
  for (const std::filesystem::path& candidate :
    { folder / name, folder / kTextureFolder / name, folder / ".." / kTextureFolder / name })
  {
    if (isFile(candidate))
    {
      return candidate.lexically_normal().string();
    }
  }
  return {};
}

} // namespace bart
} // namespace hrt
