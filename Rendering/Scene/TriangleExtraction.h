// From the cells of a vtkPolyData to a list of triangles. Triangulation follows VTK's own mapper
// where that one is right - a fan for convex polygons, alternating winding in strips - and cuts
// ears where a fan would leave the polygon. This is also the door at which broken cells are
// refused.
#pragma once

#include "Rendering/Core/Geometry/Coordinates.h" // the largest coordinate that is not refused
#include "Rendering/Core/Snapshot.h"

#include "vtkType.h"

#include <array>
#include <cstdint>
#include <vector>

class vtkPolyData;

namespace hrt
{
namespace scene
{

struct SourceTriangle
{
  std::array<vtkIdType, 3> points; // of the vtkPolyData
  vtkIdType cell;                  // of the vtkPolyData
};

// What was refused, or repaired, in one vtkPolyData.
struct TriangleReport
{
  std::uint64_t nonFinitePoints = 0;
  std::uint64_t invalidIndices = 0;
  std::uint64_t degenerateTriangles = 0;
  std::uint64_t replacedNormals = 0; // triangles whose normals were not numbers

  bool operator==(const TriangleReport& o) const
  {
    return nonFinitePoints == o.nonFinitePoints && invalidIndices == o.invalidIndices &&
      degenerateTriangles == o.degenerateTriangles && replacedNormals == o.replacedNormals;
  }
};

using Triangles = std::vector<SourceTriangle>;
using Points = std::vector<glm::dvec3>;

// The points in double, as the cells index them; empty when there are none.
Points readPoints(vtkPolyData* input);

// Every triangle of the polygons and strips whose points exist and are finite, in cell order.
Triangles triangulate(vtkPolyData* input, const Points& points, TriangleReport& report);

// The origin for coordinates in a box: see the derivation in TriangleExtraction.cxx.
glm::dvec3 originOfBox(const glm::dvec3& lower, const glm::dvec3& upper);

// Fills origin, positions, cellIds and bounds of the geometry; drops the triangles without area
// from the list, so that it stays in step with the geometry.
void writePositions(
  Triangles& triangles, const Points& points, Geometry& geometry, TriangleReport& report);

// Fills the geometry's normals as VTK's mapper chooses them: point normals unless shading is flat,
// else cell normals, else none.
void writeNormals(vtkPolyData* input, bool flat, const Triangles& triangles, Geometry& geometry,
  TriangleReport& report);

} // namespace scene
} // namespace hrt
