// See Shader.h.
#include "Rendering/OpenGL2/Shader.h"

#include "Rendering/OpenGL2/PartTables.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkShaderProgram.h"

#include "DirectRendering_vs.h"
#include "RayCaster_fs.h"
#include "Shading.h"
#include "ShadowLookup.h"

#include <locale>
#include <sstream>

namespace hrt
{
namespace gl
{
namespace
{

// Texels of three components would need OpenGL 4.0, and four would waste a quarter of the memory.
const char* const kFetchVector = R"(
vec3 fetchVector(samplerBuffer table, int i)
{
  return vec3(texelFetch(table, 3 * i).r, texelFetch(table, 3 * i + 1).r,
    texelFetch(table, 3 * i + 2).r);
}
)";

std::string definitions()
{
  std::ostringstream text;
  text.imbue(std::locale::classic()); // a host may have set one with decimal commas
  text.precision(9);
  text << std::showpoint;
  text << "#define real float\n#define HRT_FUNCTION\n";
  text << "#define PART_TEXELS " << kPartTexels << "\n";
  text << "#define LAYOUT_TEXELS " << kLayoutTexels << "\n";
  text << "#define LIGHT_TEXELS " << kLightTexels << "\n";
  text << "#define FACE_TEXELS " << kFaceTexels << "\n";
  text << "#define FACE_SEAM " << kFaceSeam << "\n";
  text << "#define ROUNDING " << kShadowRounding << "\n";
  text << "#define MINIMUM_COSINE2 " << kMinimumCosine2 << "\n";
  text << "#define HRT_SHADOW_FACE(i) texelFetch(shadowFaces, i)\n";
  text << "#define HRT_SHADOW_DEPTH(place) texelFetch(shadowAtlas, place, 0).r\n";
  text << "#define HRT_SHADOW_CLEAR shadowClearDepth\n";
  return text.str();
}

} // namespace

//------------------------------------------------------------------------------
vtkShaderProgram* readyProgram(
  vtkOpenGLRenderWindow* window, const std::string& vertexShader, const std::string& fragmentShader)
{
  return window->GetShaderCache()->ReadyShaderProgram(
    vertexShader.c_str(), fragmentShader.c_str(), "");
}

//------------------------------------------------------------------------------
const std::string& rayCasterSource()
{
  static const std::string source = [] {
    std::string text = RayCaster_fs;
    vtkShaderProgram::Substitute(text, "//HRT::Fetch", kFetchVector);
    vtkShaderProgram::Substitute(text, "//HRT::Shading", definitions() + Shading + ShadowLookup);
    return text;
  }();
  return source;
}

//------------------------------------------------------------------------------
const std::string& directRenderingSource()
{
  static const std::string source = [] {
    std::string text = DirectRendering_vs;
    vtkShaderProgram::Substitute(text, "//HRT::Fetch", kFetchVector);
    return text;
  }();
  return source;
}

//------------------------------------------------------------------------------
void releaseProgram(vtkOpenGLRenderWindow* window)
{
  window->GetShaderCache()->ReleaseCurrentShader();
}

} // namespace gl
} // namespace hrt
