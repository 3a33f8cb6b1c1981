// Which sides of a mesh's triangles are edges of the cells of a vtkPolyData, as VTK's mapper has them:
// the borders of polygons, without the diagonals that cut them into triangles, and every side of a
// strip's triangles.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"
#include "Rendering/Scene/VertexExtraction.h"

class vtkPolyData;

namespace hrt
{
namespace scene
{

// Fills the geometry's sides. Its cells must still be those of the input.
void writeSides(vtkPolyData* input, const VertexPoints& pointOf, Geometry& geometry);

} // namespace scene
} // namespace hrt
