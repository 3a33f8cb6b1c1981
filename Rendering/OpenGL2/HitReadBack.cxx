// See HitReadBack.h.
#include "Rendering/OpenGL2/HitReadBack.h"

#include "Rendering/OpenGL2/OffscreenState.h"
#include "Rendering/OpenGL2/PixelStore.h"

#include <algorithm>

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
  const PixelBounds& bounds, std::vector<std::uint32_t>& ids,
  const std::function<void(int)>& rowsReady)
{
  const int width = hits.hits().width();
  const int height = hits.hits().height();
  ids.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (bounds.pixels() != ids.size())
  {
    std::fill(ids.begin(), ids.end(), 0); // in place: the tracer holds on to it
  }
  std::vector<PixelReadBack::Piece> pieces;
  PixelReadBack::cut(
    { bounds.x0, bounds.y0, bounds.width(), bounds.height() }, kReadBackRows, pieces);
  OffscreenState state(window, hits.framebuffer(), width, height);
  // Only the first component is asked for, in direct rendering too: (u, v) is computed again in
  // double from the ray and the triangle, which is more exact than what the rasteriser interpolated.
  return this->Pixels.read(pieces, { GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof(ids[0]) },
    [&](const PixelReadBack::Piece& piece, const void* texels) {
      placeRows(static_cast<const std::uint32_t*>(texels),
        PixelBounds{ piece.x, piece.x + piece.width, piece.y, piece.y + piece.height }, width, ids);
      const int top = piece.y + piece.height;
      rowsReady(top == bounds.y1 ? height : top); // above the bounds nothing follows
    });
}

//------------------------------------------------------------------------------
bool HitReadBack::readBarycentrics(vtkOpenGLRenderWindow* window,
  const ObjectIntersectionBuffer& hits, const PixelBounds& bounds,
  std::vector<glm::dvec2>& barycentrics)
{
  if (hits.visibility() != Visibility::DirectRendering)
  {
    return false;
  }
  const int width = hits.hits().width();
  const int height = hits.hits().height();
  std::vector<glm::uvec4> texels(bounds.pixels());
  {
    OffscreenState state(window, hits.framebuffer(), width, height);
    const ScopedPixelStore store(ScopedPixelStore::Direction::ToHost);
    glReadPixels(bounds.x0, bounds.y0, bounds.width(), bounds.height(), GL_RGBA_INTEGER,
      GL_UNSIGNED_INT, texels.data());
  }
  std::vector<glm::dvec2> inside;
  inside.reserve(texels.size());
  for (const glm::uvec4& texel : texels)
  {
    inside.emplace_back(texel.y / kBarycentricOne, texel.z / kBarycentricOne);
  }
  barycentrics.assign(
    static_cast<std::size_t>(width) * static_cast<std::size_t>(height), glm::dvec2(0.0));
  placeRows(inside.data(), bounds, width, barycentrics);
  return true;
}

} // namespace gl
} // namespace hrt
