// See TextureBuffers.h.
#include "Rendering/OpenGL2/TextureBuffers.h"

#include <vector>

namespace hrt
{
namespace gl
{
namespace
{

// Each texture once, in the order of the parts.
std::vector<const Texture*> distinctTextures(const Snapshot& snapshot, bool floats)
{
  std::map<std::uint64_t, bool> seen;
  std::vector<const Texture*> textures;
  for (const Part& part : snapshot.parts)
  {
    for (const TextureLayer& layer : part.material.textures.layers)
    {
      if (!layer.texture->floats.empty() == floats &&
        seen.emplace(layer.texture->version, true).second)
      {
        textures.push_back(layer.texture.get());
      }
    }
  }
  return textures;
}

// Fills one of the buffers, unless it holds these very textures. Returns the bytes that were uploaded.
template <class Texels>
std::uint64_t fill(TextureBuffer& buffer, std::map<std::uint64_t, std::uint64_t>& places,
  const std::vector<const Texture*>& textures, Texels texels)
{
  std::map<std::uint64_t, std::uint64_t> wanted;
  std::uint64_t count = 0;
  for (const Texture* texture : textures)
  {
    wanted[texture->version] = count;
    count += texture->texelCount();
  }
  if (wanted == places)
  {
    return 0;
  }
  const std::size_t size = sizeof(*texels(*textures.front()));
  buffer.upload(nullptr, count * size, GL_STATIC_DRAW);
  for (const Texture* texture : textures)
  {
    buffer.uploadRange(
      wanted[texture->version] * size, texels(*texture), texture->texelCount() * size);
  }
  places = wanted;
  return count * size;
}

} // namespace

//------------------------------------------------------------------------------
TextureBuffers::TextureBuffers(ObjectPool& pool)
  : Bytes(pool, GL_RGBA8)
  , Floats(pool, GL_RGBA32F)
{
}

//------------------------------------------------------------------------------
bool TextureBuffers::update(const Snapshot& snapshot, std::string& error)
{
  this->UploadedBytes = 0;
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  for (const bool floats : { false, true })
  {
    const std::vector<const Texture*> textures = distinctTextures(snapshot, floats);
    std::uint64_t texels = 0;
    for (const Texture* texture : textures)
    {
      texels += texture->texelCount();
    }
    if (texels > static_cast<std::uint64_t>(limit))
    {
      error = "the scene's textures have " + std::to_string(texels) +
        " texels, this OpenGL context holds at most " + std::to_string(limit) +
        " in a texture buffer";
      return false;
    }
    // What no part shows any more stays until something else is to be shown.
    if (!textures.empty())
    {
      this->UploadedBytes += floats
        ? fill(this->Floats, this->FloatTextures, textures,
            [](const Texture& t) { return t.floats.data(); })
        : fill(this->Bytes, this->ByteTextures, textures,
            [](const Texture& t) { return t.bytes.data(); });
    }
  }
  return true;
}

//------------------------------------------------------------------------------
void TextureBuffers::describe(const Part& part, std::vector<glm::vec4>& table) const
{
  for (const TextureLayer& layer : part.material.textures.layers)
  {
    const Texture& texture = *layer.texture;
    const bool floats = !texture.floats.empty();
    const Places& places = floats ? this->FloatTextures : this->ByteTextures;
    const std::uint64_t first = places.at(texture.version);
    table.emplace_back(static_cast<float>(texture.width), static_cast<float>(texture.height),
      static_cast<float>(first / 65536), static_cast<float>(first % 65536));
    table.emplace_back(floats ? 1.0f : 0.0f, static_cast<float>(texture.wrap),
      texture.linear ? 1.0f : 0.0f, static_cast<float>(layer.blend));
    table.push_back(texture.border);
  }
}

//------------------------------------------------------------------------------
void TextureBuffers::bindTables(int firstUnit) const
{
  this->Bytes.bind(firstUnit);
  this->Floats.bind(firstUnit + 1);
}

} // namespace gl
} // namespace hrt
