// See DrawThrottle.h.
#include "Rendering/OpenGL2/DrawThrottle.h"

#include "Rendering/OpenGL2/Animation.h"

namespace hrt
{
namespace gl
{
namespace
{

// Nanoseconds. When they are over the pass goes on: only memory was at stake.
constexpr GLuint64 kPatience = 1000000000;

} // namespace

//------------------------------------------------------------------------------
DrawThrottle::DrawThrottle(std::size_t triangles)
  : Active(triangles >= kTrianglesOfScene && !isHardwareContext())
{
}

//------------------------------------------------------------------------------
DrawThrottle::~DrawThrottle()
{
  if (this->Before)
  {
    glDeleteSync(this->Before);
  }
}

//------------------------------------------------------------------------------
void DrawThrottle::drawn(std::size_t triangles)
{
  if (!this->Active)
  {
    return;
  }
  this->Room -= std::min(this->Room, triangles);
  if (this->Room == 0)
  {
    this->finishPiece();
    this->Room = kTrianglesOfPiece;
  }
}

//------------------------------------------------------------------------------
void DrawThrottle::finishPiece()
{
  const GLsync done = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  if (this->Before)
  {
    glClientWaitSync(this->Before, 0, kPatience);
    glDeleteSync(this->Before);
  }
  this->Before = done;
}

} // namespace gl
} // namespace hrt
