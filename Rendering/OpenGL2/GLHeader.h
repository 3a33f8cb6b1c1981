// The OpenGL declarations, from whichever loader the installed VTK has: glew up to 9.3, glad later.
#pragma once

#if __has_include("vtk_glad.h")
#include "vtk_glad.h"
#else
#include "vtk_glew.h"
#endif
