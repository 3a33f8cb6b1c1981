// Brings pixels of a framebuffer to host memory through two alternating pixel buffer objects with
// fences (paper, section 3.1): while one piece is in flight, the piece before it is already handed to
// whoever works on it.
#pragma once

#include "Rendering/OpenGL2/ObjectPool.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace hrt
{
namespace gl
{

// Rows of a piece: of a picture 800 pixels wide 200 kB, a few tens of microseconds on a bus, and two
// rows of the tracer's tiles.
inline constexpr int kReadBackRows = 64;

class PixelReadBack
{
public:
  explicit PixelReadBack(ObjectPool& pool);

  struct Piece
  {
    int x = 0, y = 0, width = 0, height = 0;
  };
  struct Format
  {
    GLenum format;     // of a texel, as glReadPixels takes it
    GLenum type;
    std::size_t bytes; // of a texel; a multiple of four, so that rows are packed
  };
  // Gets the texels of a piece, row by row from the bottom.
  using Receive = std::function<void(const Piece& piece, const void* texels)>;

  // Cuts a rectangle into pieces of at most `rows` rows, from the bottom up.
  static void cut(const Piece& whole, int rows, std::vector<Piece>& pieces);

  // Reads the pieces of the bound framebuffer, in order. False when the driver would not map a
  // buffer; the pieces before have been received.
  bool read(const std::vector<Piece>& pieces, const Format& format, const Receive& receive);

private:
  class Transfer;

  GLuint Buffers[2];
};

} // namespace gl
} // namespace hrt
