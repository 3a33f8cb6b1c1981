// Brings the object intersection buffer to host memory, piece by piece, so that the CPU starts on the
// rows that have arrived while the rest is in flight (paper, section 3.1).
#pragma once

#include "Rendering/OpenGL2/ObjectIntersectionBuffer.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PixelReadBack.h"

#include "Rendering/Core/PixelBounds.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

class HitReadBack
{
public:
  explicit HitReadBack(ObjectPool& pool);

  // Fills in width x height triangle numbers plus one (0: no hit, or outside the bounds), row 0 at the
  // bottom, and calls rowsReady(n) each time more rows are there: [0, n) then are. Only what lies within
  // the bounds is transferred. False when the driver would not map a buffer.
  bool read(vtkOpenGLRenderWindow* window, const ObjectIntersectionBuffer& hits,
    const PixelBounds& bounds, std::vector<std::uint32_t>& ids,
    const std::function<void(int)>& rowsReady);

  // The (u, v) that direct rendering stored within the bounds, at once; zero outside. False when the
  // buffer is an item buffer.
  static bool readBarycentrics(vtkOpenGLRenderWindow* window, const ObjectIntersectionBuffer& hits,
    const PixelBounds& bounds, std::vector<glm::dvec2>& barycentrics);

private:
  PixelReadBack Pixels;
};

} // namespace gl
} // namespace hrt
