// Shader programs come from VTK's cache, which adds the version line for the context at hand, shares
// programs between passes and frees them with the window. This puts the one shading source and the
// table layouts into a shader's text and readies the program.
#pragma once

#include "Rendering/Core/Plan/Facts.h"

#include <string>

class vtkOpenGLRenderWindow;
class vtkShaderProgram;

namespace hrt
{
namespace gl
{

// Null after an error message when a shader does not compile.
vtkShaderProgram* readyProgram(
  vtkOpenGLRenderWindow* window, const std::string& vertexShader, const std::string& fragmentShader);

// The primary shader's fragment stage with the shared shading source and the layouts filled in. What no
// surface in view has is not in it: a scene does not pay for the features of others.
std::string primaryShaderSource(const SurfaceFeatures& features);

// A fragment shader that rasterises parts: as it is, or made to leave out the holes of their textures, or
// to show them at other depths (DepthOffset).
std::string depthSource(const char* text, bool holes, bool offset);

// A vertex shader that rasterises parts: of a part without copies, or with.
std::string depthVertexSource(const char* text, bool copies);

// Forgets the current program, in VTK's cache too.
void releaseProgram(vtkOpenGLRenderWindow* window);

} // namespace gl
} // namespace hrt
