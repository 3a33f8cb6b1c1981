// The texels of a scene's textures on the GPU, in buffers: they are looked up by the shared source and
// not by OpenGL's filters. A texture that several parts show is there once.
#pragma once

#include "Rendering/OpenGL2/ObjectPool.h"

#include "Rendering/Core/Snapshot.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hrt
{
namespace gl
{

// Texels of the part table that describe one texture of one part:
//   (width, height, first texel / 65536, first texel modulo 65536)
//   (floats, wrap, linear, blend) (border)
inline constexpr int kTextureTexels = 3;

class TextureBuffers
{
public:
  explicit TextureBuffers(ObjectPool& pool);

  // Brings the buffers in line with the snapshot. Returns false, with a reason, when its texels do
  // not fit into the context's texture buffers.
  bool update(const Snapshot& snapshot, std::string& error);

  // Appends the descriptions of a part's textures, as of the last update.
  void describe(const Part& part, std::vector<glm::vec4>& table) const;

  // texels, float texels
  static constexpr int kUnits = 2;
  void bindTables(int firstUnit) const;

  std::uint64_t uploadedBytes() const { return this->UploadedBytes; }

private:
  using Places = std::map<std::uint64_t, std::uint64_t>; // first texel by version

  TextureBuffer Bytes, Floats;
  Places ByteTextures, FloatTextures;
  std::uint64_t UploadedBytes = 0; // in the last update
};

} // namespace gl
} // namespace hrt
