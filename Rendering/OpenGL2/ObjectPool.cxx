// See ObjectPool.h.
#include "Rendering/OpenGL2/ObjectPool.h"

#include "Rendering/OpenGL2/PixelStore.h"

#include "vtkOpenGLRenderWindow.h"

#include <stdexcept>
#include <string>

namespace hrt
{
namespace gl
{
namespace
{

// Storage that the driver would not give; caught where a frame is rendered.
void checkMemory(const char* what, std::size_t size)
{
  if (glGetError() == GL_OUT_OF_MEMORY)
  {
    throw std::runtime_error(
      std::string("OpenGL has no memory for ") + what + " of size " + std::to_string(size));
  }
}

} // namespace

//------------------------------------------------------------------------------
ObjectPool::ObjectPool(vtkOpenGLRenderWindow* window)
  : Window(window)
  , ContextTime(window->GetContextCreationTime())
{
}

//------------------------------------------------------------------------------
ObjectPool::~ObjectPool()
{
  vtkOpenGLRenderWindow* window = this->Window;
  if (!window || window->GetContextCreationTime() != this->ContextTime)
  {
    return; // the names died with their context
  }
  // Leaves the caller's context current: a pass may die while another window is being drawn.
  window->PushContext();
  if (window->IsCurrent())
  {
    glDeleteTextures(static_cast<GLsizei>(this->Textures.size()), this->Textures.data());
    glDeleteBuffers(static_cast<GLsizei>(this->Buffers.size()), this->Buffers.data());
    glDeleteFramebuffers(static_cast<GLsizei>(this->Framebuffers.size()), this->Framebuffers.data());
    glDeleteVertexArrays(static_cast<GLsizei>(this->VertexArrays.size()), this->VertexArrays.data());
  }
  window->PopContext();
}

//------------------------------------------------------------------------------
GLuint ObjectPool::makeTexture()
{
  GLuint name = 0;
  glGenTextures(1, &name);
  this->Textures.push_back(name);
  return name;
}

//------------------------------------------------------------------------------
GLuint ObjectPool::makeBuffer()
{
  GLuint name = 0;
  glGenBuffers(1, &name);
  this->Buffers.push_back(name);
  return name;
}

//------------------------------------------------------------------------------
GLuint ObjectPool::makeFramebuffer()
{
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  this->Framebuffers.push_back(name);
  return name;
}

//------------------------------------------------------------------------------
GLuint ObjectPool::makeVertexArray()
{
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  this->VertexArrays.push_back(name);
  return name;
}

//------------------------------------------------------------------------------
vtkOpenGLRenderWindow* ObjectPool::window() const
{
  return this->Window;
}

//------------------------------------------------------------------------------
bool ObjectPool::belongsToCurrentContextOf(vtkOpenGLRenderWindow* window) const
{
  return window && this->Window.GetPointer() == window &&
    window->GetContextCreationTime() == this->ContextTime;
}

//------------------------------------------------------------------------------
TextureBuffer::TextureBuffer(ObjectPool& pool, GLenum internalFormat)
  : Buffer(pool.makeBuffer())
  , Texture(pool.makeTexture())
  , InternalFormat(internalFormat)
{
  this->upload(nullptr, 0, GL_STATIC_DRAW);
}

//------------------------------------------------------------------------------
void TextureBuffer::upload(const void* data, std::size_t bytes, GLenum usage)
{
  static const char zeroTexel[16] = {};
  glBindBuffer(GL_TEXTURE_BUFFER, this->Buffer);
  glBufferData(GL_TEXTURE_BUFFER,
    static_cast<GLsizeiptr>(bytes ? bytes : sizeof(zeroTexel)), bytes ? data : zeroTexel, usage);
  {
    const ScopedTexture bound(GL_TEXTURE_BUFFER, this->Texture);
    glTexBuffer(GL_TEXTURE_BUFFER, this->InternalFormat, this->Buffer);
  }
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
  checkMemory("a table of the scene", bytes);
}

//------------------------------------------------------------------------------
void TextureBuffer::uploadRange(std::size_t offset, const void* data, std::size_t bytes)
{
  glBindBuffer(GL_TEXTURE_BUFFER, this->Buffer);
  glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
    data);
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

//------------------------------------------------------------------------------
void TextureBuffer::bind(int unit) const
{
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_BUFFER, this->Texture);
}

//------------------------------------------------------------------------------
Image2D::Image2D(ObjectPool& pool)
  : Texture(pool.makeTexture())
{
}

//------------------------------------------------------------------------------
bool Image2D::allocate(int width, int height, GLenum internalFormat, GLenum format, GLenum type)
{
  if (width == this->Width && height == this->Height && internalFormat == this->InternalFormat)
  {
    return false;
  }
  this->Width = this->Height = 0; // until the storage is there
  this->InternalFormat = internalFormat;
  this->Format = format;
  this->Type = type;
  {
    const ScopedTexture bound(GL_TEXTURE_2D, this->Texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    const ScopedPixelStore store(ScopedPixelStore::Direction::FromHost);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalFormat), width, height, 0, format,
      type, nullptr);
  }
  checkMemory("a picture", std::size_t(width) * height);
  this->Width = width;
  this->Height = height;
  return true;
}

//------------------------------------------------------------------------------
void Image2D::upload(const void* pixels, const PixelBounds& bounds)
{
  const ScopedTexture bound(GL_TEXTURE_2D, this->Texture);
  const ScopedPixelStore store(
    ScopedPixelStore::Direction::FromHost, { this->Width, bounds.x0, bounds.y0 });
  glTexSubImage2D(GL_TEXTURE_2D, 0, bounds.x0, bounds.y0, bounds.width(), bounds.height(),
    this->Format, this->Type, pixels);
}

//------------------------------------------------------------------------------
void Image2D::bind(int unit) const
{
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, this->Texture);
}

//------------------------------------------------------------------------------
ScopedTextureUnits::ScopedTextureUnits(int count)
  : Units(static_cast<std::size_t>(count))
{
  glGetIntegerv(GL_ACTIVE_TEXTURE, &this->Active);
  for (std::size_t unit = 0; unit < this->Units.size(); ++unit)
  {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &this->Units[unit].texture2D);
    glGetIntegerv(GL_TEXTURE_BINDING_BUFFER, &this->Units[unit].textureBuffer);
  }
}

//------------------------------------------------------------------------------
ScopedTextureUnits::~ScopedTextureUnits()
{
  for (std::size_t unit = 0; unit < this->Units.size(); ++unit)
  {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(this->Units[unit].texture2D));
    glBindTexture(GL_TEXTURE_BUFFER, static_cast<GLuint>(this->Units[unit].textureBuffer));
  }
  glActiveTexture(static_cast<GLenum>(this->Active));
}

//------------------------------------------------------------------------------
ScopedTexture::ScopedTexture(GLenum target, GLuint texture)
  : Target(target)
{
  glGetIntegerv(
    target == GL_TEXTURE_2D ? GL_TEXTURE_BINDING_2D : GL_TEXTURE_BINDING_BUFFER, &this->Before);
  glBindTexture(target, texture);
}

//------------------------------------------------------------------------------
ScopedTexture::~ScopedTexture()
{
  glBindTexture(this->Target, static_cast<GLuint>(this->Before));
}

} // namespace gl
} // namespace hrt
