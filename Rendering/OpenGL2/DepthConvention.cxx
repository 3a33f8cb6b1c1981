// See DepthConvention.h.
#include "Rendering/OpenGL2/DepthConvention.h"

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
DepthConvention DepthConvention::ofCurrentContext()
{
  DepthConvention convention;
#if defined(GL_ZERO_TO_ONE)
  convention.reversed = glClipControl != nullptr;
#endif
  return convention;
}

//------------------------------------------------------------------------------
glm::dmat4 DepthConvention::drawMatrix(const glm::dmat4& clip) const
{
  return this->reversed ? this->storedDepthMatrix(clip) : clip;
}

//------------------------------------------------------------------------------
glm::dmat4 DepthConvention::storedDepthMatrix(const glm::dmat4& clip) const
{
  // Stored depth is (w - z) / 2w when reversed and (w + z) / 2w otherwise.
  const double sign = this->reversed ? -0.5 : 0.5;
  glm::dmat4 m = clip;
  for (int column = 0; column < 4; ++column)
  {
    m[column][2] = sign * clip[column][2] + 0.5 * clip[column][3];
  }
  return m;
}

//------------------------------------------------------------------------------
ScopedDepthConvention::ScopedDepthConvention(const DepthConvention& convention)
  : Convention(convention)
{
#if defined(GL_ZERO_TO_ONE)
  if (convention.reversed)
  {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  }
#endif
}

//------------------------------------------------------------------------------
ScopedDepthConvention::~ScopedDepthConvention()
{
#if defined(GL_ZERO_TO_ONE)
  if (this->Convention.reversed)
  {
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  }
#endif
}

} // namespace gl
} // namespace hrt
