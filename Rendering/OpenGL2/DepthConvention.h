// How this context's off-screen depth buffers store depth. With ARB_clip_control they are reversed
// (near 1, far 0, clip space from 0 to w), which spreads the precision of a float buffer evenly over
// distance; without it they are OpenGL's own. VTK's state cache does not know glClipControl, so the
// setting is always restored.
#pragma once

#include "Rendering/OpenGL2/GLHeader.h"

#include <glm/glm.hpp>

namespace hrt
{
namespace gl
{

struct DepthConvention
{
  bool reversed = false;

  // What the current context can do.
  static DepthConvention ofCurrentContext();

  float clearDepth() const { return this->reversed ? 0.0f : 1.0f; }
  // The stored depth of a clip-space z / w.
  float storedDepth(double z) const
  {
    return static_cast<float>(this->reversed ? 0.5 - 0.5 * z : 0.5 + 0.5 * z);
  }
  // Of equal depths the last drawn stays, as in VTK.
  GLenum compare() const { return this->reversed ? GL_GEQUAL : GL_LEQUAL; }

  // What grows by one where OpenGL's own depth grows by one.
  float direction() const { return this->reversed ? -1.0f : 1.0f; }

  // The matrix to draw with, from one for OpenGL's clip space (z from -w to w).
  glm::dmat4 drawMatrix(const glm::dmat4& clip) const;
  // Maps to (x, y, d, w) where d / w is the stored depth.
  glm::dmat4 storedDepthMatrix(const glm::dmat4& clip) const;
};

// Switches clip control for the time it lives.
class ScopedDepthConvention
{
public:
  explicit ScopedDepthConvention(const DepthConvention& convention);
  ~ScopedDepthConvention();
  ScopedDepthConvention(const ScopedDepthConvention&) = delete;
  ScopedDepthConvention& operator=(const ScopedDepthConvention&) = delete;

private:
  DepthConvention Convention;
};

} // namespace gl
} // namespace hrt
