// How rows of pixels lie in host memory is a state of the context, and so is the buffer object that
// may stand in for host memory. VTK knows of parts of it only, and a host that draws with OpenGL
// itself leaves the rest as it pleases. Whoever moves pixels therefore says here how they lie, for
// as long as it takes, and the host finds what it left.
#pragma once

#include "Rendering/OpenGL2/GLHeader.h"

namespace hrt
{
namespace gl
{

// Host memory's side of a rectangle: a part of rows of `rowLength` texels, in the machine's byte
// order and without gaps between the rows. Texels are of a multiple of four bytes.
struct PixelRows
{
  int rowLength = 0;  // 0: as long as the rectangle is wide
  int skipPixels = 0; // before the rectangle's first column
  int skipRows = 0;   // before its first row
};

class ScopedPixelStore
{
public:
  enum class Direction
  {
    ToHost,  // glReadPixels
    FromHost // glTexImage2D, glTexSubImage2D
  };

  // No buffer object is bound: pointers are of host memory until one is.
  explicit ScopedPixelStore(Direction direction, const PixelRows& rows = {});
  ~ScopedPixelStore();
  ScopedPixelStore(const ScopedPixelStore&) = delete;
  ScopedPixelStore& operator=(const ScopedPixelStore&) = delete;

private:
  static constexpr int kParameters = 5;

  Direction Way;
  GLint Before[kParameters];
  GLint BufferBefore = 0;
};

} // namespace gl
} // namespace hrt
