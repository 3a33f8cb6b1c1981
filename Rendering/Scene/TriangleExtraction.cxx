// The triangulation of TriangleExtraction.h. Cell numbers follow vtkPolyData: verts, then lines,
// polygons and strips.

#include "Rendering/Scene/TriangleExtraction.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkSmartPointer.h"
#include "vtkVersionMacros.h" // For the name of vtkPolygon's triangulation

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hrt
{
namespace scene
{
namespace
{

bool isFinite(const glm::dvec3& point)
{
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

//------------------------------------------------------------------------------
enum class CellState
{
  Good,
  InvalidIndex,
  NonFinitePoint,
  DistantPoint
};

//------------------------------------------------------------------------------
CellState inspect(const vtkIdType* ids, vtkIdType count, const VectorReader& points)
{
  CellState state = CellState::Good;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (ids[i] < 0 || ids[i] >= static_cast<vtkIdType>(points.size()))
    {
      return CellState::InvalidIndex;
    }
    const glm::dvec3 point = points[ids[i]];
    if (!isAdmissible(point) && state != CellState::NonFinitePoint)
    {
      state = isFinite(point) ? CellState::DistantPoint : CellState::NonFinitePoint;
    }
  }
  return state;
}

//------------------------------------------------------------------------------
// True for a good cell; else counts the triangles that are lost with it.
bool admit(CellState state, std::uint64_t triangles, TriangleReport& report)
{
  if (state == CellState::InvalidIndex)
  {
    report.invalidIndices += triangles;
  }
  else if (state == CellState::NonFinitePoint)
  {
    report.nonFinitePoints += triangles;
  }
  else if (state == CellState::DistantPoint)
  {
    report.distantPoints += triangles;
  }
  return state == CellState::Good;
}

//------------------------------------------------------------------------------
glm::dvec3 areaVector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  return glm::cross(b - a, c - a);
}

//------------------------------------------------------------------------------
// Newell's normal: twice the polygon's area vector, however bent or concave it is.
glm::dvec3 polygonNormal(const vtkIdType* ids, vtkIdType count, const VectorReader& points)
{
  glm::dvec3 normal(0.0);
  for (vtkIdType i = 1; i + 1 < count; ++i)
  {
    normal += areaVector(points[ids[0]], points[ids[i]], points[ids[i + 1]]);
  }
  return normal;
}

//------------------------------------------------------------------------------
// A fan covers the polygon exactly once unless one of its triangles is turned over. Polygons that
// pass, concave ones with a lucky first point among them, get the very triangles of VTK's mapper.
bool fanIsRight(const vtkIdType* ids, vtkIdType count, const VectorReader& points)
{
  const glm::dvec3 normal = polygonNormal(ids, count, points);
  for (vtkIdType i = 1; i + 1 < count; ++i)
  {
    if (glm::dot(areaVector(points[ids[0]], points[ids[i]], points[ids[i + 1]]), normal) < 0.0)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
void append(vtkIdType a, vtkIdType b, vtkIdType c, vtkIdType cell, Triangles& triangles)
{
  triangles.points.push_back({ static_cast<PointNumber>(a), static_cast<PointNumber>(b),
    static_cast<PointNumber>(c) });
  triangles.cells.push_back(cell);
}

//------------------------------------------------------------------------------
void appendFan(const vtkIdType* ids, vtkIdType count, vtkIdType cell, Triangles& triangles)
{
  for (vtkIdType i = 1; i + 1 < count; ++i)
  {
    append(ids[0], ids[i], ids[i + 1], cell, triangles);
  }
}

//------------------------------------------------------------------------------
// Whether the border runs from a to b and back over itself to c.
bool isSpike(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  return areaVector(a, b, c) == glm::dvec3(0.0) && glm::dot(b - a, c - b) < 0.0;
}

//------------------------------------------------------------------------------
// The polygon without what encloses nothing: corners that repeat the one before - map makers write
// the first once more at the end - and ways there and back. Neither changes its area, but both
// keep it from being cut into ears. A corner taken out may leave another of the kind: the corners
// kept so far are looked at again.
std::vector<vtkIdType> simpleBorder(
  const vtkIdType* ids, vtkIdType count, const VectorReader& points)
{
  std::vector<vtkIdType> border;
  const auto at = [&](std::size_t fromEnd) { return points[border[border.size() - fromEnd]]; };
  for (vtkIdType i = 0; i < count; ++i)
  {
    border.push_back(ids[i]);
    for (bool changed = true; changed;)
    {
      changed = border.size() > 1 && at(1) == at(2);
      if (changed)
      {
        border.pop_back();
        continue;
      }
      changed = border.size() > 2 && isSpike(at(3), at(2), at(1));
      if (changed)
      {
        border.erase(border.end() - 2);
      }
    }
  }
  // The same where the end meets the beginning.
  for (bool changed = true; changed && border.size() > 2;)
  {
    const glm::dvec3 first = points[border.front()], second = points[border[1]];
    const bool endRepeats = at(1) == first || isSpike(at(2), at(1), first);
    const bool beginningIsSpike = !endRepeats && isSpike(at(1), first, second);
    changed = endRepeats || beginningIsSpike;
    if (endRepeats)
    {
      border.pop_back();
    }
    else if (beginningIsSpike)
    {
      border.erase(border.begin());
    }
  }
  return border;
}

//------------------------------------------------------------------------------
// Cuts ears, of the polygon as seen along its normal: corners a little off the plane do not matter.
// False, and nothing appended, when it cannot be triangulated, for instance because it crosses itself.
bool appendEars(
  const std::vector<vtkIdType>& ids, const VectorReader& points, vtkIdType cell,
  Triangles& triangles)
{
  const auto count = static_cast<vtkIdType>(ids.size());
  const glm::dvec3 normal = glm::normalize(polygonNormal(ids.data(), count, points));
  const glm::dvec3 size = glm::abs(normal);
  const glm::dvec3 across = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
    : size.y <= size.z                                           ? glm::dvec3(0, 1, 0)
                                                                 : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(across, normal)), v = glm::cross(normal, u);
  vtkNew<vtkPolygon> polygon;
  polygon->GetPoints()->SetDataTypeToDouble();
  polygon->GetPoints()->SetNumberOfPoints(count);
  polygon->GetPointIds()->SetNumberOfIds(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const glm::dvec3 p = points[ids[i]] - points[ids[0]];
    polygon->GetPoints()->SetPoint(i, glm::dot(p, u), glm::dot(p, v), 0.0);
    polygon->GetPointIds()->SetId(i, i);
  }
  vtkNew<vtkIdList> corners;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 4, 0)
  const bool cut = polygon->TriangulateLocalIds(0, corners) != 0; // its name from this release on
#else
  const bool cut = polygon->Triangulate(corners) != 0;
#endif
  // A simple polygon of n points has n - 2 triangles, however it is cut.
  if (!cut || corners->GetNumberOfIds() != 3 * (count - 2))
  {
    return false;
  }
  for (vtkIdType i = 0; i < corners->GetNumberOfIds(); i += 3)
  {
    append(ids[corners->GetId(i)], ids[corners->GetId(i + 1)], ids[corners->GetId(i + 2)], cell,
      triangles);
  }
  return true;
}

//------------------------------------------------------------------------------
void appendPolygon(
  const vtkIdType* ids, vtkIdType count, const VectorReader& points, vtkIdType cell,
  Triangles& triangles)
{
  if (count == 3 || fanIsRight(ids, count, points))
  {
    appendFan(ids, count, cell, triangles);
    return;
  }
  const std::vector<vtkIdType> border = simpleBorder(ids, count, points);
  const auto corners = static_cast<vtkIdType>(border.size());
  const bool simple = corners >= 3;
  if (simple &&
    (fanIsRight(border.data(), corners, points) || !appendEars(border, points, cell, triangles)))
  {
    appendFan(border.data(), corners, cell, triangles);
  }
  else if (!simple)
  {
    appendFan(ids, count, cell, triangles); // without area, to be counted as such
  }
}

//------------------------------------------------------------------------------
// Every second triangle of a strip runs backwards; two of its corners are swapped so that all show
// the same side. Broken points spoil only the triangles that name them.
void appendStrip(const vtkIdType* ids, vtkIdType count, const VectorReader& points, vtkIdType cell,
  Triangles& triangles, TriangleReport& report)
{
  for (vtkIdType i = 0; i + 2 < count; ++i)
  {
    if (admit(inspect(ids + i, 3, points), 1, report))
    {
      const vtkIdType odd = i % 2;
      append(ids[i], ids[i + 1 + odd], ids[i + 2 - odd], cell, triangles);
    }
  }
}

//------------------------------------------------------------------------------
// Calls f(ids, count, cell id) for each cell, whichever way the array stores it.
template <typename F>
void forEachCell(vtkCellArray* cells, vtkIdType firstCell, F&& f)
{
  auto it = vtk::TakeSmartPointer(cells->NewIterator());
  for (it->GoToFirstCell(); !it->IsDoneWithTraversal(); it->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    it->GetCurrentCell(count, ids);
    f(ids, count, firstCell + it->GetCurrentCellId());
  }
}

//------------------------------------------------------------------------------
// A simple polygon or a strip of n points has n - 2 triangles.
std::size_t trianglesOf(vtkCellArray* cells)
{
  const vtkIdType count = cells->GetNumberOfConnectivityIds() - 2 * cells->GetNumberOfCells();
  return static_cast<std::size_t>(std::max<vtkIdType>(count, 0));
}

} // anonymous namespace

//------------------------------------------------------------------------------
VectorReader readPoints(vtkPolyData* input)
{
  vtkPoints* points = input->GetPoints();
  return VectorReader(points ? points->GetData() : nullptr);
}

//------------------------------------------------------------------------------
Triangles triangulate(vtkPolyData* input, const VectorReader& points, TriangleReport& report)
{
  if (points.size() > std::numeric_limits<PointNumber>::max())
  {
    throw std::length_error("a vtkPolyData has more than 2^32 - 1 points");
  }
  Triangles triangles;
  const std::size_t expected = trianglesOf(input->GetPolys()) + trianglesOf(input->GetStrips());
  triangles.points.reserve(expected);
  triangles.cells.reserve(expected);

  const vtkIdType firstPolygon = input->GetNumberOfVerts() + input->GetNumberOfLines();
  forEachCell(input->GetPolys(), firstPolygon,
    [&](const vtkIdType* ids, vtkIdType count, vtkIdType cell)
    {
      // As in VTK's mapper, polygons of less than three points are place holders: nothing is lost.
      if (count >= 3 &&
        admit(inspect(ids, count, points), static_cast<std::uint64_t>(count - 2), report))
      {
        appendPolygon(ids, count, points, cell, triangles);
      }
    });

  const vtkIdType firstStrip = firstPolygon + input->GetNumberOfPolys();
  forEachCell(input->GetStrips(), firstStrip,
    [&](const vtkIdType* ids, vtkIdType count, vtkIdType cell)
    { appendStrip(ids, count, points, cell, triangles, report); });
  return triangles;
}

} // namespace scene
} // namespace hrt
