// From the cells of a vtkPolyData to a list of triangles. Triangulation follows VTK's own mapper
// where that one is right - a fan for convex polygons, alternating winding in strips - and cuts
// ears where a fan would leave the polygon. This is also the door at which broken cells are
// refused. What vertices the triangles get is decided in VertexExtraction.h.
#pragma once

#include "Rendering/Core/Geometry/CellIds.h"
#include "Rendering/Core/Geometry/Coordinates.h" // the largest coordinate that is not refused
#include "Rendering/Scene/VectorReader.h"

#include <array>
#include <cstdint>
#include <vector>

class vtkPolyData;

namespace hrt
{
namespace scene
{

// What was refused in one vtkPolyData.
struct TriangleReport
{
  std::uint64_t nonFinitePoints = 0;
  std::uint64_t distantPoints = 0; // triangles with points that are finite, but beyond kLargestCoordinate
  std::uint64_t invalidIndices = 0;
  std::uint64_t degenerateTriangles = 0;

  bool operator==(const TriangleReport& o) const
  {
    return nonFinitePoints == o.nonFinitePoints && distantPoints == o.distantPoints &&
      invalidIndices == o.invalidIndices && degenerateTriangles == o.degenerateTriangles;
  }
};

// A point's number in its vtkPolyData.
using PointNumber = std::uint32_t;

// Triangles between points of a vtkPolyData, with the cells that they came from.
struct Triangles
{
  std::vector<std::array<PointNumber, 3>> points;
  CellIds cells;

  std::size_t size() const { return this->points.size(); }
};

// The points as the cells number them; none when there are none.
VectorReader readPoints(vtkPolyData* input);

// Every triangle of the polygons and strips whose points exist and are admissible, in cell order.
// Throws std::length_error when there are more points than a PointNumber can tell apart.
Triangles triangulate(vtkPolyData* input, const VectorReader& points, TriangleReport& report);

} // namespace scene
} // namespace hrt
