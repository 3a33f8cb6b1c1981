// The camera's matrices and the background that a ray sees when it leaves the scene.
#pragma once

#include "Rendering/Core/Snapshot.h"

class vtkRenderer;

namespace hrt
{
namespace scene
{

// From the composed matrices, as vtkOpenGLCamera hands them to the shaders: explicit projections,
// off-axis and off-centre windows, tiles and stereo need no case of their own. The picture is width x
// height pixels large.
Camera extractCamera(vtkRenderer* renderer, int width, int height);

// Solid or gradient. A textured background is known to rays by its solid colour.
Background extractBackground(vtkRenderer* renderer, const Camera& camera);

} // namespace scene
} // namespace hrt
