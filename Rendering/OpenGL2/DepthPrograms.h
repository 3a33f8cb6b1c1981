// The two programs by which a pass rasterises parts: a plain one, and one that looks textures up for
// parts whose textures have holes. A pass draws its parts in their order and asks for each one's
// program; where no part has holes the second is never made.
#pragma once

#include "Rendering/OpenGL2/GeometryBuffers.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PartTables.h"
#include "Rendering/OpenGL2/TextureBuffers.h"

#include "Rendering/Core/Snapshot.h"

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
  // What parts are drawn from; all must outlive it. Of parts and textures only perforated ones ask.
  struct Tables
  {
    const GeometryBuffers& geometry;
    const PartTables& parts;
    const TextureBuffers& textures;
  };

  DepthPrograms(vtkOpenGLRenderWindow* window, const char* vertexShader,
    const char* fragmentShader, const Tables& tables);
  ~DepthPrograms();
  DepthPrograms(const DepthPrograms&) = delete;
  DepthPrograms& operator=(const DepthPrograms&) = delete;

  // Makes the part's program current, fed with the geometry's vertices. Null after an error message.
  vtkShaderProgram* use(const Snapshot& snapshot, std::size_t part);

private:
  vtkShaderProgram* make(bool holes);

  vtkOpenGLRenderWindow* Window;
  const char* VertexShader;
  const char* FragmentShader;
  Tables From;
  vtkShaderProgram* Programs[2] = { nullptr, nullptr }; // plain, with holes
  vtkShaderProgram* Current = nullptr;
  std::unique_ptr<ScopedTextureUnits> Units; // bound for the second program
};

} // namespace gl
} // namespace hrt
