// The GL state of drawing into an own framebuffer, put back as VTK left it when the scope ends. All
// changes go through vtkOpenGLState, whose cache would otherwise be wrong afterwards.
#pragma once

#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/GLHeader.h"

#include "Rendering/Core/PixelBounds.h"

class vtkOpenGLRenderWindow;
class vtkOpenGLState;

namespace hrt
{
namespace gl
{

class OffscreenState
{
public:
  OffscreenState(vtkOpenGLRenderWindow* window, GLuint framebuffer, int width, int height);
  ~OffscreenState();
  OffscreenState(const OffscreenState&) = delete;
  OffscreenState& operator=(const OffscreenState&) = delete;

  // Checks the framebuffer after its attachments are set; says which one is not usable and why.
  bool complete(const char* what) const;

  // For a framebuffer that has no colour attachment.
  void useDepthOnly();
  // Depth test and writes on, blending and culling off.
  void beginDepthPass(const DepthConvention& convention);
  // Every pixel is written once: no depth test, no blending.
  void beginScreenPass();
  // Restricts drawing and clearing to a part of the target.
  void setViewport(int x, int y, int width, int height);
  // The same without moving the viewport: what is drawn inside is what would be drawn without it.
  void setScissor(const PixelBounds& bounds);

private:
  vtkOpenGLRenderWindow* Window;
  vtkOpenGLState* State;
};

} // namespace gl
} // namespace hrt
