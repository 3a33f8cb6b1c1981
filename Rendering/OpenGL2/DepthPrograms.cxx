// See DepthPrograms.h.
#include "Rendering/OpenGL2/DepthPrograms.h"

#include "Rendering/OpenGL2/Shader.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkShaderProgram.h"

#include "Corners_vs.h"

namespace hrt
{
namespace gl
{
namespace
{

// The samplers in the order in which the tables are bound; null: not asked for.
const char* const kSamplers[] = { nullptr, "indices", "positions", nullptr, nullptr, "coordinates",
  nullptr, "partLayout", "partTable", nullptr, "texels", "floatTexels" };
constexpr int kSamplerCount = static_cast<int>(sizeof(kSamplers) / sizeof(kSamplers[0]));
static_assert(
  kSamplerCount == GeometryBuffers::kUnits + PartTables::kUnits + TextureBuffers::kUnits,
  "every table has its place");

} // namespace

//------------------------------------------------------------------------------
DepthPrograms::DepthPrograms(
  vtkOpenGLRenderWindow* window, const Shaders& shaders, bool corners, const Tables& tables)
  : Window(window)
  , Sources(shaders)
  , AllCorners(corners)
  , From(tables)
{
}

//------------------------------------------------------------------------------
DepthPrograms::~DepthPrograms()
{
  glBindVertexArray(0);
  releaseProgram(this->Window);
}

//------------------------------------------------------------------------------
vtkShaderProgram* DepthPrograms::make(Kind kind)
{
  if (kind == Shared)
  {
    return readyProgram(this->Window, this->Sources.vertex, this->Sources.fragment);
  }
  vtkShaderProgram* program = readyProgram(
    this->Window, Corners_vs, depthSource(this->Sources.cornerFragment, kind == CornersWithHoles));
  if (!program)
  {
    return nullptr;
  }
  if (!this->Units)
  {
    this->Units = std::make_unique<ScopedTextureUnits>(kSamplerCount);
    int unit = 0;
    this->From.geometry.bindTables(unit);
    unit += GeometryBuffers::kUnits;
    this->From.parts.bindTables(unit);
    unit += PartTables::kUnits;
    this->From.textures.bindTables(unit);
  }
  for (int i = 0; i < kSamplerCount; ++i)
  {
    if (kSamplers[i] && program->IsUniformUsed(kSamplers[i]))
    {
      program->SetUniformi(kSamplers[i], i);
    }
  }
  return program;
}

//------------------------------------------------------------------------------
bool DepthPrograms::use(Kind kind)
{
  vtkShaderProgram*& wanted = this->Programs[kind];
  if (!wanted)
  {
    wanted = this->make(kind);
  }
  if (!wanted)
  {
    return false;
  }
  if (wanted != this->Current)
  {
    this->Window->GetShaderCache()->ReadyShaderProgram(wanted);
    if (kind == Shared)
    {
      this->From.geometry.bindForDrawing(static_cast<GLuint>(wanted->GetHandle()));
    }
    else
    {
      this->From.geometry.bindForFetching();
    }
    this->Current = wanted;
  }
  return true;
}

//------------------------------------------------------------------------------
bool DepthPrograms::draw(
  const Snapshot& snapshot, std::size_t part, const glm::dmat4& worldToClip)
{
  const bool holes = snapshot.parts[part].perforated;
  const Kind kind = holes ? CornersWithHoles : this->AllCorners ? Corners : Shared;
  if (!this->use(kind))
  {
    return false;
  }
  glm::mat4 matrix(worldToClip * snapshot.parts[part].positionsToWorld());
  this->Current->SetUniformMatrix4x4("positionToClip", &matrix[0][0]);
  if (kind != Shared)
  {
    if (holes)
    {
      this->Current->SetUniformi("part", static_cast<int>(part));
    }
    this->From.geometry.drawCorners(part);
    return true;
  }
  if (this->Current->IsUniformUsed("vertexToTriangle"))
  {
    this->Current->SetUniformi("vertexToTriangle", this->From.geometry.vertexToTriangle(part));
  }
  this->From.geometry.draw(part);
  return true;
}

} // namespace gl
} // namespace hrt
