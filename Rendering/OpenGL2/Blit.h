// The last stage of every frame: the finished image and its true GL depth into the framebuffer that
// VTK draws to. The only stage of a still scene.
#pragma once

#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/Picture.h"

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

class Blit
{
public:
  explicit Blit(ObjectPool& pool);

  // Draws to the framebuffer that is bound, with the picture's corner at (x, y), the pixels within
  // the bounds. `margin`: whether the depth is put behind by the picture's margin, for what VTK draws next.
  bool draw(vtkOpenGLRenderWindow* window, const Picture& picture, const PixelBounds& bounds,
    bool margin, int x, int y);

private:
  GLuint VertexArray;
};

} // namespace gl
} // namespace hrt
