// See PixelStore.h.
#include "Rendering/OpenGL2/PixelStore.h"

namespace hrt
{
namespace gl
{
namespace
{

// Of one direction; both have the same parameters under names of their own.
struct Names
{
  GLenum parameters[5];
  GLenum buffer;
  GLenum bufferBinding;
};

const Names& namesOf(ScopedPixelStore::Direction direction)
{
  static const Names toHost = { { GL_PACK_SWAP_BYTES, GL_PACK_ALIGNMENT, GL_PACK_ROW_LENGTH,
                                  GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS },
    GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING };
  static const Names fromHost = { { GL_UNPACK_SWAP_BYTES, GL_UNPACK_ALIGNMENT,
                                    GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS,
                                    GL_UNPACK_SKIP_ROWS },
    GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING };
  return direction == ScopedPixelStore::Direction::ToHost ? toHost : fromHost;
}

// Rows begin at multiples of so many bytes, as those of whole texels do; OpenGL's default.
constexpr GLint kAlignment = 4;

} // namespace

//------------------------------------------------------------------------------
ScopedPixelStore::ScopedPixelStore(Direction direction, const PixelRows& rows)
  : Way(direction)
{
  const Names& names = namesOf(direction);
  const GLint values[kParameters] = { GL_FALSE, kAlignment, rows.rowLength, rows.skipPixels,
    rows.skipRows };
  for (int i = 0; i < kParameters; ++i)
  {
    glGetIntegerv(names.parameters[i], &this->Before[i]);
    glPixelStorei(names.parameters[i], values[i]);
  }
  glGetIntegerv(names.bufferBinding, &this->BufferBefore);
  glBindBuffer(names.buffer, 0);
}

//------------------------------------------------------------------------------
ScopedPixelStore::~ScopedPixelStore()
{
  const Names& names = namesOf(this->Way);
  for (int i = 0; i < kParameters; ++i)
  {
    glPixelStorei(names.parameters[i], this->Before[i]);
  }
  glBindBuffer(names.buffer, static_cast<GLuint>(this->BufferBefore));
}

} // namespace gl
} // namespace hrt
