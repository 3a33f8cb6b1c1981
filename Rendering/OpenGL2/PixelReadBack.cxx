// See PixelReadBack.h.
#include "Rendering/OpenGL2/PixelReadBack.h"

#include "Rendering/OpenGL2/PixelStore.h"

#include <algorithm>

namespace hrt
{
namespace gl
{

// A piece on its way into a buffer.
class PixelReadBack::Transfer
{
public:
  Transfer() = default;
  ~Transfer()
  {
    if (this->Fence)
    {
      glDeleteSync(this->Fence);
    }
  }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  void begin(GLuint buffer, const Piece& piece, const Format& format)
  {
    this->Buffer = buffer;
    this->What = piece;
    this->Bytes = format.bytes * piece.width * piece.height;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBufferData(
      GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(this->Bytes), nullptr, GL_STREAM_READ);
    glReadPixels(
      piece.x, piece.y, piece.width, piece.height, format.format, format.type, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    this->Fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
  }

  bool underway() const { return this->Fence != nullptr; }

  bool finish(const Receive& receive)
  {
    // Mapping would wait too, but on drivers that cannot tell which command the buffer waits for it
    // waits for everything queued, the next piece included.
    constexpr GLuint64 kTenthOfASecond = 100000000; // in nanoseconds
    GLenum state = GL_TIMEOUT_EXPIRED;
    while (state == GL_TIMEOUT_EXPIRED)
    {
      state = glClientWaitSync(this->Fence, 0, kTenthOfASecond);
    }
    glDeleteSync(this->Fence);
    this->Fence = nullptr;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, this->Buffer);
    const void* texels = state == GL_WAIT_FAILED
      ? nullptr
      : glMapBufferRange(
          GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(this->Bytes), GL_MAP_READ_BIT);
    if (texels)
    {
      receive(this->What, texels);
      glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    return texels != nullptr;
  }

private:
  GLuint Buffer = 0;
  GLsync Fence = nullptr;
  Piece What;
  std::size_t Bytes = 0;
};

//------------------------------------------------------------------------------
PixelReadBack::PixelReadBack(ObjectPool& pool)
  : Buffers{ pool.makeBuffer(), pool.makeBuffer() }
{
}

//------------------------------------------------------------------------------
void PixelReadBack::cut(const Piece& whole, int rows, std::vector<Piece>& pieces)
{
  for (int y = 0; y < whole.height; y += rows)
  {
    pieces.push_back({ whole.x, whole.y + y, whole.width, std::min(rows, whole.height - y) });
  }
}

//------------------------------------------------------------------------------
bool PixelReadBack::read(
  const std::vector<Piece>& pieces, const Format& format, const Receive& receive)
{
  const ScopedPixelStore store(ScopedPixelStore::Direction::ToHost);
  Transfer transfers[2];
  for (std::size_t i = 0; i < pieces.size() + 1; ++i)
  {
    if (i < pieces.size())
    {
      transfers[i % 2].begin(this->Buffers[i % 2], pieces[i], format);
    }
    Transfer& before = transfers[(i + 1) % 2];
    if (before.underway() && !before.finish(receive))
    {
      return false;
    }
  }
  return true;
}

} // namespace gl
} // namespace hrt
