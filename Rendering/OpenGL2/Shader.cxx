// See Shader.h.
#include "Rendering/OpenGL2/Shader.h"

#include "Rendering/OpenGL2/PartTables.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkShaderProgram.h"

#include "Copies.h"
#include "Edges.h"
#include "Holes.h"
#include "Offset.h"
#include "Pbr.h"
#include "PrimaryShader_fs.h"
#include "Shading.h"
#include "ShadowLookup.h"
#include "Sides.h"
#include "Surface.h"
#include "SurfaceColors.h"
#include "TextureLookup.h"
#include "TextureFetch.h"

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

std::string definitions(const SurfaceFeatures& features)
{
  std::ostringstream text;
  text.imbue(std::locale::classic()); // a host may have set one with decimal commas
  text.precision(9);
  text << std::showpoint;
  text << "#define real float\n#define HRT_FUNCTION\n";
  text << (features.textures ? "#define HRT_TEXTURES\n" : "");
  text << (features.edges ? "#define HRT_EDGES\n" : "");
  text << (features.physical ? "#define HRT_PHYSICAL\n" : "");
  text << (features.copies ? "#define HRT_COPIES\n" : "");
  text << "#define PART_TEXELS " << kPartTexels << "\n";
  text << "#define LAYOUT_TEXELS " << kLayoutTexels << "\n";
  text << "#define LIGHT_TEXELS " << kLightTexels << "\n";
  text << "#define TEXTURE_TEXELS " << kTextureTexels << "\n";
  text << "#define FACE_TEXELS " << kFaceTexels << "\n";
  text << "#define FACE_SEAM " << kFaceSeam << "\n";
  text << "#define ROUNDING " << kShadowRounding << "\n";
  text << "#define MINIMUM_COSINE2 " << kMinimumCosine2 << "\n";
  text << "#define BEND " << kBend << "\n";
  text << "#define HRT_SHADOW_FACE(i) texelFetch(shadowFaces, i)\n";
  text << "#define HRT_SHADOW_DEPTH(place) texelFetch(shadowAtlas, place, 0).r\n";
  text << "#define HRT_SHADOW_CLEAR shadowClearDepth\n";
  // One reciprocal root; in C++, where it matters, the exact quotient.
  text << "#define HRT_DIRECTION(v) normalize(v)\n";
  text << "#define HRT_SELECT(condition, a, b) ((condition) ? (a) : (b))\n";
  text << "#define HRT_ANY(condition) (condition)\n#define HRT_BOOL bool\n";
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
std::string primaryShaderSource(const SurfaceFeatures& features)
{
  std::string text = PrimaryShader_fs;
  vtkShaderProgram::Substitute(text, "//HRT::Fetch", kFetchVector);
  vtkShaderProgram::Substitute(
    text, "//HRT::Shading", definitions(features) + Shading + Sides + Surface + ShadowLookup);
  vtkShaderProgram::Substitute(text, "//HRT::SurfaceColors", SurfaceColors);
  vtkShaderProgram::Substitute(text, "//HRT::Textures",
    features.textures ? std::string(TextureFetch) + TextureLookup : std::string());
  vtkShaderProgram::Substitute(text, "//HRT::Edges", features.edges ? Edges : "");
  vtkShaderProgram::Substitute(text, "//HRT::Physical", features.physical ? Pbr : "");
  return text;
}

//------------------------------------------------------------------------------
std::string depthSource(const char* text, bool holes, bool offset)
{
  std::string result = text;
  std::string code;
  if (holes)
  {
    code = "#define HRT_HOLES\n" + definitions({}) + Shading + Sides + Surface + Holes;
    vtkShaderProgram::Substitute(
      code, "//HRT::Textures", std::string(TextureFetch) + TextureLookup);
  }
  vtkShaderProgram::Substitute(result, "//HRT::Holes", code);
  vtkShaderProgram::Substitute(
    result, "//HRT::Offset", offset ? std::string("#define HRT_OFFSET\n") + Offset : std::string());
  return result;
}

//------------------------------------------------------------------------------
std::string depthVertexSource(const char* text, bool copies)
{
  std::string result = text;
  vtkShaderProgram::Substitute(result, "//HRT::Define", copies ? "#define HRT_COPIES" : "");
  vtkShaderProgram::Substitute(result, "//HRT::Copies", ::Copies); // the text, not hrt::Copies
  return result;
}

//------------------------------------------------------------------------------
void releaseProgram(vtkOpenGLRenderWindow* window)
{
  window->GetShaderCache()->ReleaseCurrentShader();
}

} // namespace gl
} // namespace hrt
