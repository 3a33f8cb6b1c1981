// See OffscreenState.h.
#include "Rendering/OpenGL2/OffscreenState.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
OffscreenState::OffscreenState(
  vtkOpenGLRenderWindow* window, GLuint framebuffer, int width, int height)
  : Window(window)
  , State(window->GetState())
{
  this->State->Push(); // the framebuffer bindings too
  this->State->vtkglBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  this->State->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  this->setViewport(0, 0, width, height);
}

//------------------------------------------------------------------------------
OffscreenState::~OffscreenState()
{
  this->State->Pop();
}

//------------------------------------------------------------------------------
bool OffscreenState::complete(const char* what) const
{
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
  {
    vtkErrorWithObjectMacro(this->Window,
      "the framebuffer of the " << what << " is not usable on this OpenGL (status 0x" << std::hex
                                << status << std::dec << ")");
    return false;
  }
  return true;
}

//------------------------------------------------------------------------------
void OffscreenState::useDepthOnly()
{
  this->State->vtkglDrawBuffer(GL_NONE);
  this->State->vtkglReadBuffer(GL_NONE);
}

//------------------------------------------------------------------------------
void OffscreenState::beginDepthPass(const DepthConvention& convention)
{
  this->State->vtkglDisable(GL_BLEND);
  this->State->vtkglDisable(GL_CULL_FACE);
  this->State->vtkglEnable(GL_DEPTH_TEST);
  this->State->vtkglDepthMask(GL_TRUE);
  this->State->vtkglDepthFunc(convention.compare());
}

//------------------------------------------------------------------------------
void OffscreenState::beginScreenPass()
{
  this->State->vtkglDisable(GL_BLEND);
  this->State->vtkglDisable(GL_CULL_FACE);
  this->State->vtkglDisable(GL_DEPTH_TEST);
}

//------------------------------------------------------------------------------
void OffscreenState::setViewport(int x, int y, int width, int height)
{
  this->State->vtkglViewport(x, y, width, height);
  this->State->vtkglEnable(GL_SCISSOR_TEST);
  this->State->vtkglScissor(x, y, width, height);
}

//------------------------------------------------------------------------------
void OffscreenState::setScissor(const PixelBounds& bounds)
{
  this->State->vtkglEnable(GL_SCISSOR_TEST);
  this->State->vtkglScissor(bounds.x0, bounds.y0, bounds.width(), bounds.height());
}

} // namespace gl
} // namespace hrt
