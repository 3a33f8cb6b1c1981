// Spheres and cones of an AFF scene as triangles: VTK's own sources know neither truncated cones
// without caps nor surfaces that are seen from inside.
#pragma once

#include "IO/BART/AFF/Scene.h"

#include "vtkSmartPointer.h"

class vtkPolyData;

namespace hrt
{
namespace bart
{

vtkSmartPointer<vtkPolyData> toPolyData(const Sphere& sphere);
vtkSmartPointer<vtkPolyData> toPolyData(const Cone& cone);

} // namespace bart
} // namespace hrt
