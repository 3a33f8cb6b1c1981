// The colours of a part's triangles, as vtkMapper makes them from scalars. The mapping itself is
// left to the mapper, whose many modes are thereby all supported; only where its result is stored
// and what it is attached to is read here.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"
#include "Rendering/Scene/VertexExtraction.h"

class vtkMapper;
class vtkPolyData;

namespace hrt
{
namespace scene
{

// Lets the mapper map its scalars and fills colorSource and the colours, or the coordinates and the
// look-up table, of a geometry that has its vertices. False when the mapper's colours do not cover
// the input, in which case the colour is the property's.
bool writeColors(
  vtkMapper* mapper, vtkPolyData* input, const VertexPoints& pointOf, Geometry& geometry);

// Fills the geometry's texture coordinates as VTK's mapper chooses them, of one or two components;
// leaves them empty where VTK shows no texture. After writeColors.
void writeTextureCoordinates(
  vtkPolyData* input, const VertexPoints& pointOf, Geometry& geometry);

} // namespace scene
} // namespace hrt
