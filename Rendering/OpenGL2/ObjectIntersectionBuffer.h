// The object intersection buffer (paper, section 2.1): per pixel the visible triangle and, in direct
// rendering, the rasteriser's (u, v). Filled by rasterisation, or with what primary rays have found. An
// own single-sample framebuffer with one integer target: the paper codes the number in RGB (2^24
// triangles), an integer target holds 2^32 - 1.
#pragma once

#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/DepthPrograms.h"
#include "Rendering/OpenGL2/ObjectPool.h"

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

// Direct rendering stores (u, v) as whole multiples of 1 / kBarycentricOne; the shaders use the same.
inline constexpr double kBarycentricOne = 2147483648.0; // 2^31

class ObjectIntersectionBuffer
{
public:
  ObjectIntersectionBuffer(ObjectPool& pool, const DepthConvention& convention);

  // Makes the target fit; true when what it held is lost.
  bool resize(int width, int height, Visibility visibility);

  // Rasterises those parts within those pixels, without the holes of their textures; what the others hold is left undefined. Returns false
  // when a shader or the framebuffer is not usable; an error message has been given then.
  bool draw(vtkOpenGLRenderWindow* window, const Snapshot& snapshot,
    const DepthPrograms::Tables& tables, const std::vector<bool>& parts,
    const PixelBounds& bounds);

  // Takes the ids and depths that primary rays have found within the bounds instead.
  void upload(const PrimaryHits& primary, const PixelBounds& bounds);

  const Image2D& hits() const { return this->Hits; }
  const Image2D& depth() const { return this->Depth; }
  Visibility visibility() const { return this->Mode; }
  const DepthConvention& convention() const { return this->Convention; }
  GLuint framebuffer() const { return this->Framebuffer; }
  std::uint64_t trianglesDrawn() const { return this->TrianglesDrawn; }

private:
  Image2D Hits, Depth;
  GLuint Framebuffer;
  DepthConvention Convention;
  Visibility Mode = Visibility::ItemBuffer;
  std::uint64_t TrianglesDrawn = 0; // in the last draw
  std::vector<float> StoredDepths;  // of the last upload; kept for its memory
};

} // namespace gl
} // namespace hrt
