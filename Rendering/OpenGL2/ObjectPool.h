// Owns every GL object of one pass on one context. VTK's own wrappers cannot be used throughout
// (integer attachments, depth atlases and fences have none), and raw names would leak or, worse, be
// deleted in the wrong context. So all names are made here, counted, and freed in one place: when
// VTK releases the graphics resources, when the pass dies, or, without a GL call, when the context
// they belonged to is already gone.
#pragma once

#include "Rendering/OpenGL2/GLHeader.h"

#include "Rendering/Core/PixelBounds.h"

#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <cstddef>
#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

class ObjectPool
{
public:
  // The window's context must be current.
  explicit ObjectPool(vtkOpenGLRenderWindow* window);
  ~ObjectPool();
  ObjectPool(const ObjectPool&) = delete;
  ObjectPool& operator=(const ObjectPool&) = delete;

  GLuint makeTexture();
  GLuint makeBuffer();
  GLuint makeFramebuffer();
  GLuint makeVertexArray();

  vtkOpenGLRenderWindow* window() const;

  // False once the window is gone or has made itself a new context: the names mean nothing then.
  bool belongsToCurrentContextOf(vtkOpenGLRenderWindow* window) const;

  std::size_t size() const
  {
    return this->Textures.size() + this->Buffers.size() + this->Framebuffers.size() +
      this->VertexArrays.size();
  }

private:
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkMTimeType ContextTime = 0;
  std::vector<GLuint> Textures, Buffers, Framebuffers, VertexArrays;
};

// A buffer object seen by shaders as a one-dimensional table of texels.
class TextureBuffer
{
public:
  TextureBuffer(ObjectPool& pool, GLenum internalFormat);

  // Replaces the contents; an empty table still holds one zero texel so that fetches are defined.
  void upload(const void* data, std::size_t bytes, GLenum usage);
  // Replaces a range of what was uploaded before.
  void uploadRange(std::size_t offset, const void* data, std::size_t bytes);

  void bind(int unit) const;
  GLuint buffer() const { return this->Buffer; }

private:
  GLuint Buffer;
  GLuint Texture;
  GLenum InternalFormat;
};

// A texture read by texel only: no filter, no mipmap, clamped.
class Image2D
{
public:
  explicit Image2D(ObjectPool& pool);
  // True when the storage was made anew (size or format differ from before).
  bool allocate(int width, int height, GLenum internalFormat, GLenum format, GLenum type);
  // Copies the pixels within the bounds, which lie within the image. `pixels`: of the whole image.
  void upload(const void* pixels, const PixelBounds& bounds);
  void bind(int unit) const;
  GLuint name() const { return this->Texture; }
  int width() const { return this->Width; }
  int height() const { return this->Height; }

private:
  GLuint Texture;
  int Width = 0, Height = 0;
  GLenum InternalFormat = 0, Format = 0, Type = 0;
};

// Texture units are bound with raw calls while a pass draws; VTK's state cache must find the active
// unit as it left it, and every texture where VTK has bound it: the environment maps of physically
// based actors, for one, stay bound through the whole frame.
class ScopedTextureUnits
{
public:
  explicit ScopedTextureUnits(int count);
  ~ScopedTextureUnits();
  ScopedTextureUnits(const ScopedTextureUnits&) = delete;
  ScopedTextureUnits& operator=(const ScopedTextureUnits&) = delete;

private:
  struct Unit
  {
    GLint texture2D = 0;
    GLint textureBuffer = 0;
  };
  std::vector<Unit> Units;
  GLint Active = 0;
};

// Binds a texture to the active unit for the time it lives.
class ScopedTexture
{
public:
  ScopedTexture(GLenum target, GLuint texture);
  ~ScopedTexture();
  ScopedTexture(const ScopedTexture&) = delete;
  ScopedTexture& operator=(const ScopedTexture&) = delete;

private:
  GLenum Target;
  GLint Before = 0;
};

} // namespace gl
} // namespace hrt
