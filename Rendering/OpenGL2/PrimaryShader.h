// The GPU ray caster (paper, section 3.2): one screen-sized triangle shades every pixel of the object
// intersection buffer into a float image. Nothing is read back. The same shader, told to, writes
// instead the visible share of one light, for the user's "shadow" buffer.
#pragma once

#include "Rendering/OpenGL2/GeometryBuffers.h"
#include "Rendering/OpenGL2/ObjectIntersectionBuffer.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PartTables.h"
#include "Rendering/OpenGL2/Shader.h"
#include "Rendering/OpenGL2/ShadowMaps.h"
#include "Rendering/OpenGL2/TextureBuffers.h"

#include "Rendering/Core/Snapshot.h"

#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

class PrimaryShader
{
public:
  explicit PrimaryShader(ObjectPool& pool);

  // Everything the shader reads.
  struct Inputs
  {
    const Snapshot& snapshot;
    const GeometryBuffers& geometry;
    const PartTables& tables;
    const TextureBuffers& textures;
    const ShadowMaps& shadows;
    const ObjectIntersectionBuffer& hits;
    const PixelBounds& bounds; // what is shaded
    SurfaceFeatures features;  // of the parts in view
  };

  // Shades the primary image into `target`, of the hits' size. False after an error message.
  bool draw(vtkOpenGLRenderWindow* window, const Inputs& inputs, const Image2D& target);
  // The visible share of one light per pixel, row 0 at the bottom; NaN where there is no hit and
  // outside the bounds.
  bool readShadow(vtkOpenGLRenderWindow* window, const Inputs& inputs, int light,
    std::vector<float>& share);

private:
  bool shade(vtkOpenGLRenderWindow* window, const Inputs& inputs, const Image2D& target,
    int shadowLight, std::vector<float>* readBack);

  Image2D Share;
  GLuint Framebuffer;
  GLuint VertexArray;
};

} // namespace gl
} // namespace hrt
