// See HitReadBack.h.
#include "Rendering/OpenGL2/HitReadBack.h"

#include "Rendering/OpenGL2/OffscreenState.h"

#include <cstring>

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
HitReadBack::HitReadBack(ObjectPool& pool)
  : Pixels(pool)
{
}

//------------------------------------------------------------------------------
bool HitReadBack::read(vtkOpenGLRenderWindow* window, const ObjectIntersectionBuffer& hits,
  std::vector<std::uint32_t>& ids, const std::function<void(int)>& rowsReady)
{
  const int width = hits.hits().width();
  const int height = hits.hits().height();
  ids.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<PixelReadBack::Piece> pieces;
  PixelReadBack::cut({ 0, 0, width, height }, kReadBackRows, pieces);
  OffscreenState state(window, hits.framebuffer(), width, height);
  // Only the first component is asked for, in direct rendering too: (u, v) is computed again in
  // double from the ray and the triangle, which is more exact than what the rasteriser interpolated.
  return this->Pixels.read(pieces, { GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof(ids[0]) },
    [&](const PixelReadBack::Piece& piece, const void* texels) {
      std::memcpy(ids.data() + static_cast<std::size_t>(piece.y) * width, texels,
        sizeof(ids[0]) * piece.width * piece.height);
      rowsReady(piece.y + piece.height);
    });
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
