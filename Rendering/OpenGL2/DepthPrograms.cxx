// See DepthPrograms.h.
#include "Rendering/OpenGL2/DepthPrograms.h"

#include "Rendering/OpenGL2/Shader.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkShaderProgram.h"

namespace hrt
{
namespace gl
{
namespace
{

// The samplers in the order in which the tables are bound; null: not asked for.
const char* const kSamplers[] = { nullptr, nullptr, nullptr, nullptr, "coordinates", nullptr,
  "partLayout", "partTable", nullptr, "texels", "floatTexels" };
constexpr int kSamplerCount = static_cast<int>(sizeof(kSamplers) / sizeof(kSamplers[0]));
static_assert(
  kSamplerCount == GeometryBuffers::kUnits + PartTables::kUnits + TextureBuffers::kUnits,
  "every table has its place");

} // namespace

//------------------------------------------------------------------------------
DepthPrograms::DepthPrograms(vtkOpenGLRenderWindow* window, const char* vertexShader,
  const char* fragmentShader, const Tables& tables)
  : Window(window)
  , VertexShader(vertexShader)
  , FragmentShader(fragmentShader)
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
vtkShaderProgram* DepthPrograms::make(bool holes)
{
  vtkShaderProgram* program =
    readyProgram(this->Window, depthSource(this->VertexShader, holes, false).c_str(),
      depthSource(this->FragmentShader, holes, true));
  if (program && holes)
  {
    this->Units = std::make_unique<ScopedTextureUnits>(kSamplerCount);
    int unit = 0;
    this->From.geometry.bindTables(unit);
    unit += GeometryBuffers::kUnits;
    this->From.parts.bindTables(unit);
    unit += PartTables::kUnits;
    this->From.textures.bindTables(unit);
    for (int i = 0; i < kSamplerCount; ++i)
    {
      if (kSamplers[i] && program->IsUniformUsed(kSamplers[i]))
      {
        program->SetUniformi(kSamplers[i], i);
      }
    }
  }
  return program;
}

//------------------------------------------------------------------------------
vtkShaderProgram* DepthPrograms::use(const Snapshot& snapshot, std::size_t part)
{
  const bool holes = snapshot.parts[part].perforated;
  vtkShaderProgram*& wanted = this->Programs[holes ? 1 : 0];
  if (!wanted)
  {
    wanted = this->make(holes);
    if (!wanted)
    {
      return nullptr;
    }
  }
  if (wanted != this->Current)
  {
    this->Window->GetShaderCache()->ReadyShaderProgram(wanted);
    this->From.geometry.bindForDrawing(static_cast<GLuint>(wanted->GetHandle()));
    this->Current = wanted;
  }
  if (holes)
  {
    wanted->SetUniformi("part", static_cast<int>(part));
  }
  return wanted;
}

} // namespace gl
} // namespace hrt
