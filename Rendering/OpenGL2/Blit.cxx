// See Blit.h.
#include "Rendering/OpenGL2/Blit.h"

#include "Rendering/OpenGL2/Shader.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include "Blit_fs.h"
#include "ScreenTriangle_vs.h"

#include <string>

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
Blit::Blit(ObjectPool& pool)
  : VertexArray(pool.makeVertexArray())
{
}

//------------------------------------------------------------------------------
bool Blit::draw(vtkOpenGLRenderWindow* window, const Picture& picture, const PixelBounds& bounds,
  bool margin, int x, int y)
{
  std::string fragments = Blit_fs;
  vtkShaderProgram::Substitute(fragments, "//HRT::Define", margin ? "#define HRT_MARGIN" : "");
  vtkShaderProgram* program = readyProgram(window, ScreenTriangle_vs, fragments);
  if (!program)
  {
    return false;
  }
  vtkOpenGLState* state = window->GetState();
  vtkOpenGLState::ScopedglViewport viewport(state);
  vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  vtkOpenGLState::ScopedglEnableDisable culling(state, GL_CULL_FACE);
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
  vtkOpenGLState::ScopedglEnableDisable scissorTest(state, GL_SCISSOR_TEST);
  vtkOpenGLState::ScopedglScissor scissor(state);
  state->vtkglViewport(x, y, picture.primary.width(), picture.primary.height());
  if (bounds != PixelBounds().within(picture.primary.width(), picture.primary.height()))
  {
    state->vtkglEnable(GL_SCISSOR_TEST);
    state->vtkglScissor(x + bounds.x0, y + bounds.y0, bounds.width(), bounds.height());
  }
  state->vtkglDisable(GL_BLEND);
  state->vtkglDisable(GL_CULL_FACE);
  // What an earlier layer left in a preserved depth buffer still hides us.
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglDepthFunc(GL_LEQUAL);

  ScopedTextureUnits units(3);
  picture.primary.bind(0);
  (picture.useSecondary ? picture.secondary : picture.primary).bind(1);
  picture.hits.depth().bind(2);
  const int origin[2] = { x, y };
  program->SetUniformi("primaryImage", 0);
  program->SetUniformi("secondaryImage", 1);
  program->SetUniformi("hitDepth", 2);
  program->SetUniform2i("viewportOrigin", origin);
  program->SetUniformi("useSecondary", picture.useSecondary ? 1 : 0);
  program->SetUniformi("reversedDepth", picture.hits.convention().reversed ? 1 : 0);

  if (margin)
  {
    program->SetUniform2f("perW", picture.margin.perW);
    program->SetUniformf("marginByW", picture.margin.byW);
    program->SetUniformf("fixedMargin", DepthMargin::kFixed);
    program->SetUniformf("marginBySlope", DepthMargin::kBySlope);
    program->SetUniformf("steepestChange", DepthMargin::kSteepest);
  }

  glBindVertexArray(this->VertexArray);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  releaseProgram(window);
  return true;
}

} // namespace gl
} // namespace hrt
