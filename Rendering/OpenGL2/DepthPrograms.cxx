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
  nullptr, "partLayout", nullptr, "partTable", nullptr, "texels", "floatTexels" };
constexpr int kSamplerCount = static_cast<int>(sizeof(kSamplers) / sizeof(kSamplers[0]));
static_assert(
  kSamplerCount == GeometryBuffers::kUnits + PartTables::kUnits + TextureBuffers::kUnits,
  "every table has its place");

} // namespace

//------------------------------------------------------------------------------
DepthPrograms::DepthPrograms(vtkOpenGLRenderWindow* window, const Snapshot& snapshot,
  const Shaders& shaders, bool corners, const Tables& tables, float offsets)
  : Window(window)
  , Scene(snapshot)
  , Sources(shaders)
  , AllCorners(corners)
  , From(tables)
  , Offsets(offsets)
  , Throttle(snapshot.triangleCount)
{
}

//------------------------------------------------------------------------------
DepthPrograms::~DepthPrograms()
{
  glBindVertexArray(0);
  releaseProgram(this->Window);
}

//------------------------------------------------------------------------------
unsigned int DepthPrograms::kindOf(const Part& part) const
{
  return (part.perforated ? Corners | Holes : this->AllCorners ? Corners : Shared) |
    (part.copies ? WithCopies : Shared) |
    (part.material.depthOffset.any() && this->Offsets != 0.0f ? WithOffset : Shared);
}

//------------------------------------------------------------------------------
void DepthPrograms::bindTables(vtkShaderProgram* program)
{
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
}

//------------------------------------------------------------------------------
vtkShaderProgram* DepthPrograms::make(unsigned int kind)
{
  const bool corners = (kind & Corners) != 0, copies = (kind & WithCopies) != 0;
  const bool offset = (kind & WithOffset) != 0;
  vtkShaderProgram* program = readyProgram(this->Window,
    depthVertexSource(corners ? Corners_vs : this->Sources.vertex, copies),
    depthSource(corners ? this->Sources.cornerFragment : this->Sources.fragment,
      (kind & Holes) != 0, offset));
  if (program && (corners || copies))
  {
    this->bindTables(program);
  }
  return program;
}

//------------------------------------------------------------------------------
bool DepthPrograms::use(unsigned int kind)
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
    if ((kind & Corners) != 0)
    {
      this->From.geometry.bindForFetching();
    }
    else
    {
      this->From.geometry.bindForDrawing(static_cast<GLuint>(wanted->GetHandle()));
    }
    this->Current = wanted;
  }
  return true;
}

//------------------------------------------------------------------------------
bool DepthPrograms::draw(std::size_t part, const glm::dmat4& worldToClip)
{
  const Part& of = this->Scene.parts[part];
  const unsigned int kind = this->kindOf(of);
  if (!this->use(kind))
  {
    return false;
  }
  if ((kind & WithOffset) != 0)
  {
    const DepthOffset& offset = of.material.depthOffset;
    this->Current->SetUniformf("offsetBySlope", this->Offsets * offset.slope);
    this->Current->SetUniformf("offsetConstant", this->Offsets * offset.constant);
  }
  const GeometryBuffers& geometry = this->From.geometry;
  const auto set = [this](const char* name, int value) {
    if (this->Current->IsUniformUsed(name))
    {
      this->Current->SetUniformi(name, value);
    }
  };
  glm::mat4 matrix(worldToClip * bufferToWorld(of));
  this->Current->SetUniformMatrix4x4("positionToClip", &matrix[0][0]);
  if (of.copies)
  {
    const GeometryBuffers::CopyPlace copies = geometry.copies(part);
    set("firstCopy", copies.first);
    set("copyTexels", copies.texels);
    set("trianglesOfCopy", copies.triangles);
  }
  const auto copiesBefore = [&set](int count) { set("copiesBefore", count); };
  if ((kind & Corners) == 0)
  {
    set("vertexToTriangle", geometry.vertexToTriangle(part));
    geometry.draw(part, this->Throttle, copiesBefore);
    return true;
  }
  set("cornerToTriangle", geometry.cornerToTriangle(part));
  set("part", static_cast<int>(part));
  geometry.drawCorners(part, this->Throttle, copiesBefore);
  return true;
}

} // namespace gl
} // namespace hrt
