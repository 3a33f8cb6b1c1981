// How a pass rasterises parts into depths and numbers: with vertices shared among triangles, or, where
// fragments have to know a triangle's corners, each corner drawn by itself - for direct rendering, and
// for parts whose textures have holes. What no part needs is never made.
#pragma once

#include "Rendering/OpenGL2/GeometryBuffers.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PartTables.h"
#include "Rendering/OpenGL2/TextureBuffers.h"

#include "Rendering/Core/Snapshot.h"

#include <array>
#include <cstddef>
#include <memory>

class vtkOpenGLRenderWindow;
class vtkShaderProgram;

namespace hrt
{
namespace gl
{

class DepthPrograms
{
public:
  // What parts are drawn from; all must outlive it, and so must the snapshot. Of parts and textures only
  // perforated ones ask.
  struct Tables
  {
    const GeometryBuffers& geometry;
    const PartTables& parts;
    const TextureBuffers& textures;
  };
  // The shaders for shared vertices, and the fragment shader for single corners.
  struct Shaders
  {
    const char* vertex;
    const char* fragment;
    const char* cornerFragment;
  };

  // `corners`: all parts are drawn corner by corner. `offsets`: what a polygon offset adds to the stored
  // depth, 1 or -1; 0: nothing.
  DepthPrograms(vtkOpenGLRenderWindow* window, const Snapshot& snapshot, const Shaders& shaders,
    bool corners, const Tables& tables, float offsets = 0.0f);
  ~DepthPrograms();
  DepthPrograms(const DepthPrograms&) = delete;
  DepthPrograms& operator=(const DepthPrograms&) = delete;

  // Draws a part. False after an error message.
  bool draw(std::size_t part, const glm::dmat4& worldToClip);

private:
  // What a part needs, as bits.
  enum Kind : unsigned int
  {
    Shared = 0,
    Corners = 1,
    Holes = 2, // corners too
    WithCopies = 4,
    WithOffset = 8,
    KindCount = 16
  };
  unsigned int kindOf(const Part& part) const;
  bool use(unsigned int kind);
  vtkShaderProgram* make(unsigned int kind);
  void bindTables(vtkShaderProgram* program);

  vtkOpenGLRenderWindow* Window;
  const Snapshot& Scene;
  Shaders Sources;
  bool AllCorners;
  Tables From;
  float Offsets;
  std::array<vtkShaderProgram*, KindCount> Programs{};
  vtkShaderProgram* Current = nullptr;
  DrawThrottle Throttle;
  std::unique_ptr<ScopedTextureUnits> Units; // of the tables, for the programs that fetch
};

} // namespace gl
} // namespace hrt
