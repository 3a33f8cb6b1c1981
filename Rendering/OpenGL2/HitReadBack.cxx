// See HitReadBack.h.
#include "Rendering/OpenGL2/HitReadBack.h"

#include <cstring>

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
HitReadBack::HitReadBack(ObjectPool& pool)
  : Buffer(pool.makeBuffer())
{
}

//------------------------------------------------------------------------------
void HitReadBack::begin(const ObjectIntersectionBuffer& hits)
{
  const auto pixels =
    static_cast<std::uint64_t>(hits.hits().width()) * static_cast<std::uint64_t>(hits.hits().height());
  this->Bytes = pixels * sizeof(std::uint32_t);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, this->Buffer);
  glBufferData(
    GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(this->Bytes), nullptr, GL_STREAM_READ);
  // Only the first component is asked for, in direct rendering too: (u, v) is computed again in
  // double from the ray and the triangle, which is more exact than what the rasteriser interpolated.
  {
    const ScopedTexture bound(GL_TEXTURE_2D, hits.hits().name());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

//------------------------------------------------------------------------------
bool HitReadBack::finish(std::vector<std::uint32_t>& ids)
{
  ids.resize(static_cast<std::size_t>(this->Bytes / sizeof(std::uint32_t)));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, this->Buffer);
  const void* data = glMapBufferRange(
    GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(this->Bytes), GL_MAP_READ_BIT);
  if (data)
  {
    std::memcpy(ids.data(), data, static_cast<std::size_t>(this->Bytes));
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  return data != nullptr;
}

//------------------------------------------------------------------------------
bool HitReadBack::readBarycentrics(
  const ObjectIntersectionBuffer& hits, std::vector<glm::dvec2>& barycentrics)
{
  if (hits.visibility() != Visibility::DirectRendering)
  {
    return false;
  }
  std::vector<glm::uvec4> texels(
    static_cast<std::size_t>(hits.hits().width()) * static_cast<std::size_t>(hits.hits().height()));
  {
    const ScopedTexture bound(GL_TEXTURE_2D, hits.hits().name());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texels.data());
  }
  barycentrics.clear();
  for (const glm::uvec4& texel : texels)
  {
    barycentrics.emplace_back(texel.y / kBarycentricOne, texel.z / kBarycentricOne);
  }
  return true;
}

} // namespace gl
} // namespace hrt
