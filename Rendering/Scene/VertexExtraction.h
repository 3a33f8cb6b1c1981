// From triangles between the points of a vtkPolyData to an indexed mesh. A vertex is a point that
// some triangle uses, so that what the point carries is stored once; vertices are numbered as the
// triangles first name them, so that neighbours lie side by side however the points were ordered.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"
#include "Rendering/Scene/TriangleExtraction.h"

#include <vector>

class vtkPolyData;

namespace hrt
{
namespace scene
{

// The point that each vertex of a geometry came from.
using VertexPoints = std::vector<PointNumber>;

// The origin for coordinates in a box: see the derivation in VertexExtraction.cxx.
glm::dvec3 originOfBox(const glm::dvec3& lower, const glm::dvec3& upper);

// Fills all of the geometry but its colours, from triangles that have an area; the others are
// dropped. Normals are those that VTK's mapper chooses: of the points unless shading is flat, else
// of the cells, else none. A triangle whose normals are of no use gets that of its face, and
// vertices of its own where normals belong to vertices.
VertexPoints writeVertices(vtkPolyData* input, bool flat, Triangles triangles, Geometry& geometry,
  TriangleReport& report);

} // namespace scene
} // namespace hrt
