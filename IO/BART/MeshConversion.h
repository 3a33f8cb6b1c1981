// From the geometry of an AFF scene to vtkPolyData.
#pragma once

#include "IO/BART/AFF/Scene.h"

#include "vtkSmartPointer.h"

class vtkPolyData;

namespace hrt
{
namespace bart
{

// AFF gives a corner its vertex, normal and texture coordinate by three indices, VTK by one: a
// point is made for each combination that occurs.
vtkSmartPointer<vtkPolyData> toPolyData(const Mesh& mesh);

// Three points a triangle, not yet at any time: see moveTo.
vtkSmartPointer<vtkPolyData> toPolyData(const AnimatedTriangles& triangles);

// Sets the points and normals to those of a time. False, and nothing is touched, if they are there.
bool moveTo(const AnimatedTriangles& triangles, double time, vtkPolyData* surface);

} // namespace bart
} // namespace hrt
