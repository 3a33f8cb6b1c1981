// See PrimaryShader.h.
#include "Rendering/OpenGL2/PrimaryShader.h"

#include "Rendering/OpenGL2/OffscreenState.h"
#include "Rendering/OpenGL2/PixelStore.h"
#include "Rendering/OpenGL2/Shader.h"

#include "Rendering/Core/Shading/ShadingFrame.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkShaderProgram.h"

#include "ScreenTriangle_vs.h"

#include <algorithm>
#include <limits>

namespace hrt
{
namespace gl
{
namespace
{

// The samplers in the order in which the tables are bound.
const char* const kSamplers[] = { "hitBuffer", "trianglePart", "indices", "positions", "normals",
  "colors", "coordinates", "lookups", "partLayout", "triangleSides", "partTable", "lightTable",
  "shadowFaces", "shadowAtlas", "texels", "floatTexels" };
constexpr int kSamplerCount = static_cast<int>(sizeof(kSamplers) / sizeof(kSamplers[0]));
static_assert(kSamplerCount ==
    1 + GeometryBuffers::kUnits + PartTables::kUnits + ShadowMaps::kUnits + TextureBuffers::kUnits,
  "every table has its sampler");

void setVector(vtkShaderProgram* program, const char* name, const glm::dvec3& value)
{
  const float v[3] = { static_cast<float>(value.x), static_cast<float>(value.y),
    static_cast<float>(value.z) };
  program->SetUniform3f(name, v);
}

void setRays(vtkShaderProgram* program, const CameraRays& rays)
{
  // Only the direction matters to the hit; a length near 1 keeps explicit projections with large
  // elements within float.
  const double scale = 1.0 / glm::length(rays.direction0);
  setVector(program, "rayOrigin0", rays.origin0);
  setVector(program, "rayOriginX", rays.originX);
  setVector(program, "rayOriginY", rays.originY);
  setVector(program, "rayDirection0", rays.direction0 * scale);
  setVector(program, "rayDirectionX", rays.directionX * scale);
  setVector(program, "rayDirectionY", rays.directionY * scale);
}

} // namespace

//------------------------------------------------------------------------------
PrimaryShader::PrimaryShader(ObjectPool& pool)
  : Share(pool)
  , Framebuffer(pool.makeFramebuffer())
  , VertexArray(pool.makeVertexArray())
{
}

//------------------------------------------------------------------------------
bool PrimaryShader::draw(vtkOpenGLRenderWindow* window, const Inputs& inputs, const Image2D& target)
{
  return this->shade(window, inputs, target, -1, nullptr);
}

//------------------------------------------------------------------------------
bool PrimaryShader::readShadow(vtkOpenGLRenderWindow* window, const Inputs& inputs, int light,
  std::vector<float>& share)
{
  const int width = inputs.hits.hits().width();
  const int height = inputs.hits.hits().height();
  this->Share.allocate(width, height, GL_RGBA32F, GL_RGBA, GL_FLOAT);
  share.assign(
    static_cast<std::size_t>(width) * height, std::numeric_limits<float>::quiet_NaN());
  std::vector<float> inside(inputs.bounds.pixels());
  if (!this->shade(window, inputs, this->Share, light, &inside))
  {
    return false;
  }
  placeRows(inside.data(), inputs.bounds, width, share);
  return true;
}

//------------------------------------------------------------------------------
bool PrimaryShader::shade(vtkOpenGLRenderWindow* window, const Inputs& inputs, const Image2D& target,
  int shadowLight, std::vector<float>* readBack)
{
  OffscreenState state(window, this->Framebuffer, target.width(), target.height());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name(), 0);
  if (!state.complete("primary image"))
  {
    return false;
  }
  vtkShaderProgram* program = readyProgram(window, ScreenTriangle_vs, primaryShaderSource(inputs.features));
  if (!program)
  {
    return false;
  }
  state.beginScreenPass();
  state.setScissor(inputs.bounds);
  // No hit: alpha 0 in the image, NaN in the user's buffer.
  const float none = readBack ? std::numeric_limits<float>::quiet_NaN() : 0.0f;
  const float noHit[4] = { none, none, none, none };

  ScopedTextureUnits units(kSamplerCount);
  inputs.hits.hits().bind(0);
  int unit = 1;
  inputs.geometry.bindTables(unit);
  unit += GeometryBuffers::kUnits;
  inputs.tables.bindTables(unit);
  unit += PartTables::kUnits;
  inputs.shadows.bindTables(unit);
  unit += ShadowMaps::kUnits;
  inputs.textures.bindTables(unit);
  for (int i = 0; i < kSamplerCount; ++i)
  {
    if (program->IsUniformUsed(kSamplers[i]))
    {
      program->SetUniformi(kSamplers[i], i);
    }
  }
  const Snapshot& snapshot = inputs.snapshot;
  const float size[2] = { static_cast<float>(target.width()),
    static_cast<float>(target.height()) };
  program->SetUniform2f("viewportSize", size);
  program->SetUniform4f("noHit", noHit);
  program->SetUniformf("shadowClearDepth", inputs.shadows.clearDepth());
  program->SetUniformi("lightCount", static_cast<int>(snapshot.lights.size()));
  program->SetUniformi("unlitScene", snapshot.lights.empty() ? 1 : 0);
  program->SetUniformi(
    "directRendering", inputs.hits.visibility() == Visibility::DirectRendering ? 1 : 0);
  program->SetUniformi("shadowLight", shadowLight);
  program->SetUniformi("triangleLimit", static_cast<int>(snapshot.triangleCount));
  if (program->IsUniformUsed("firstCopied"))
  {
    const auto copied = std::find_if(snapshot.parts.begin(), snapshot.parts.end(),
      [](const Part& part) { return part.copies != nullptr; });
    program->SetUniformi("firstCopied", static_cast<int>(copied->firstTriangle));
    program->SetUniformi("lastPart", static_cast<int>(snapshot.parts.size()) - 1);
  }
  const ShadingFrame frame(snapshot);
  setRays(program, frame.rays);
  setVector(program, "viewer", frame.viewer);
  if (program->IsUniformUsed("frameToWindow"))
  {
    glm::mat4 matrix(
      snapshot.camera.clipToWindow() * snapshot.camera.viewToClip * frame.toView);
    program->SetUniformMatrix4x4("frameToWindow", &matrix[0][0]);
  }

  glBindVertexArray(this->VertexArray);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  if (readBack)
  {
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    const ScopedPixelStore store(ScopedPixelStore::Direction::ToHost);
    glReadPixels(inputs.bounds.x0, inputs.bounds.y0, inputs.bounds.width(),
      inputs.bounds.height(), GL_RED, GL_FLOAT, readBack->data());
  }
  releaseProgram(window);
  return true;
}

} // namespace gl
} // namespace hrt
