// The triangulation of TriangleExtraction.h. Cell numbers follow vtkPolyData: verts, then lines,
// polygons and strips.

#include "Rendering/Scene/TriangleExtraction.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkSmartPointer.h"
#include "vtkVersionMacros.h" // For the name of vtkPolygon's triangulation

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace scene
{
namespace
{

enum class CellState
{
  Good,
  InvalidIndex,
  NonFinitePoint
};

//------------------------------------------------------------------------------
CellState inspect(const vtkIdType* ids, vtkIdType count, const Points& points)
{
  CellState state = CellState::Good;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (ids[i] < 0 || ids[i] >= static_cast<vtkIdType>(points.size()))
    {
      return CellState::InvalidIndex;
    }
    if (!isAdmissible(points[ids[i]]))
    {
      state = CellState::NonFinitePoint;
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
  return state == CellState::Good;
}

//------------------------------------------------------------------------------
glm::dvec3 areaVector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  return glm::cross(b - a, c - a);
}

//------------------------------------------------------------------------------
// Newell's normal: twice the polygon's area vector, however bent or concave it is.
glm::dvec3 polygonNormal(const vtkIdType* ids, vtkIdType count, const Points& points)
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
bool fanIsRight(const vtkIdType* ids, vtkIdType count, const Points& points)
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
void appendFan(const vtkIdType* ids, vtkIdType count, vtkIdType cell, Triangles& triangles)
{
  for (vtkIdType i = 1; i + 1 < count; ++i)
  {
    triangles.push_back({ { ids[0], ids[i], ids[i + 1] }, cell });
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
std::vector<vtkIdType> simpleBorder(const vtkIdType* ids, vtkIdType count, const Points& points)
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
    const glm::dvec3 &first = points[border.front()], &second = points[border[1]];
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
  const std::vector<vtkIdType>& ids, const Points& points, vtkIdType cell, Triangles& triangles)
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
    triangles.push_back(
      { { ids[corners->GetId(i)], ids[corners->GetId(i + 1)], ids[corners->GetId(i + 2)] }, cell });
  }
  return true;
}

//------------------------------------------------------------------------------
void appendPolygon(
  const vtkIdType* ids, vtkIdType count, const Points& points, vtkIdType cell, Triangles& triangles)
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
void appendStrip(const vtkIdType* ids, vtkIdType count, const Points& points, vtkIdType cell,
  Triangles& triangles, TriangleReport& report)
{
  for (vtkIdType i = 0; i + 2 < count; ++i)
  {
    if (admit(inspect(ids + i, 3, points), 1, report))
    {
      const vtkIdType odd = i % 2;
      triangles.push_back({ { ids[i], ids[i + 1 + odd], ids[i + 2 - odd] }, cell });
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
double powerOfTwoAtLeast(double x)
{
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent); // x = mantissa * 2^exponent, in [0.5, 1)
  return std::ldexp(1.0, mantissa == 0.5 ? exponent - 1 : exponent);
}

//------------------------------------------------------------------------------
void boxOf(const Triangles& triangles, const Points& points, glm::dvec3& lower, glm::dvec3& upper)
{
  lower = upper = points[triangles.front().points[0]];
  for (const SourceTriangle& triangle : triangles)
  {
    for (vtkIdType id : triangle.points)
    {
      lower = glm::min(lower, points[id]);
      upper = glm::max(upper, points[id]);
    }
  }
}

//------------------------------------------------------------------------------
// No area in the corners as they are stored: two of them equal or three in a line. Taken in double,
// so that slivers whose area single precision would round to zero are kept.
bool isDegenerate(const std::array<glm::vec3, 3>& p)
{
  return areaVector(glm::dvec3(p[0]), glm::dvec3(p[1]), glm::dvec3(p[2])) == glm::dvec3(0.0);
}

//------------------------------------------------------------------------------
vtkDataArray* withTuples(vtkDataArray* array, vtkIdType tuples)
{
  return array && array->GetNumberOfComponents() == 3 && array->GetNumberOfTuples() >= tuples
    ? array
    : nullptr;
}

//------------------------------------------------------------------------------
glm::vec3 readNormal(vtkDataArray* normals, vtkIdType id)
{
  double n[3];
  normals->GetTuple(id, n);
  return glm::vec3(n[0], n[1], n[2]);
}

//------------------------------------------------------------------------------
// Normals are of use when all are numbers and at least one has a direction.
bool areUsable(const std::array<glm::vec3, 3>& normals)
{
  bool finite = true;
  bool direction = false;
  for (const glm::vec3& n : normals)
  {
    finite = finite && std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z);
    direction = direction || n != glm::vec3(0.0f);
  }
  return finite && direction;
}

//------------------------------------------------------------------------------
glm::vec3 faceNormal(const Geometry& geometry, std::size_t triangle)
{
  const glm::vec3* p = &geometry.positions[3 * triangle];
  return glm::vec3(
    glm::normalize(areaVector(glm::dvec3(p[0]), glm::dvec3(p[1]), glm::dvec3(p[2]))));
}

} // anonymous namespace

//------------------------------------------------------------------------------
Points readPoints(vtkPolyData* input)
{
  Points points;
  if (vtkPoints* source = input->GetPoints())
  {
    points.resize(static_cast<std::size_t>(source->GetNumberOfPoints()));
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      source->GetPoint(static_cast<vtkIdType>(i), &points[i].x);
    }
  }
  return points;
}

//------------------------------------------------------------------------------
Triangles triangulate(vtkPolyData* input, const Points& points, TriangleReport& report)
{
  Triangles triangles;
  triangles.reserve(static_cast<std::size_t>(input->GetNumberOfPolys()));

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

//------------------------------------------------------------------------------
// Let g be the power of two that is not less than the box' diagonal, c the box' centre. Component k
// of the origin o is 0 where |c| < 2 g, else g * round(c / g). For float input x in the box, x - o
// is a float, so that nothing is rounded:
//   o = 0: x itself.
//   else: |x - c| <= g / 2 and |c - o| <= g / 2, hence d = x - o has |d| <= g, and |x| >= 1.5 g.
//   Let u be the spacing of floats at x. Floats have 24 bits, so |x| >= g gives u >= g * 2^-23.
//   Both x and o are multiples of s = min(u, g), a power of two, and so is d. If s = u, d is at
//   most g / u <= 2^23 steps of u; if s = g, d is -g, 0 or g. Both fit into 24 bits.
// The subtraction is done in double, where it is exact as x and o are within a factor of two
// (Sterbenz: |o| >= 2 g and |d| <= g). Double input is rounded once, relative to the box' size and
// not to its distance from zero.
glm::dvec3 originOfBox(const glm::dvec3& lower, const glm::dvec3& upper)
{
  const glm::dvec3 centre = 0.5 * (lower + upper);
  const double diagonal = glm::length(upper - lower);
  glm::dvec3 origin(0.0);
  if (diagonal > 0.0)
  {
    const double g = powerOfTwoAtLeast(diagonal);
    for (int k = 0; k < 3; ++k)
    {
      if (std::abs(centre[k]) >= 2.0 * g)
      {
        origin[k] = g * std::round(centre[k] / g);
      }
    }
  }
  return origin;
}

//------------------------------------------------------------------------------
void writePositions(
  Triangles& triangles, const Points& points, Geometry& geometry, TriangleReport& report)
{
  if (triangles.empty())
  {
    return;
  }
  glm::dvec3 lower, upper;
  boxOf(triangles, points, lower, upper);
  geometry.origin = originOfBox(lower, upper);
  geometry.positions.reserve(3 * triangles.size());
  geometry.cellIds.reserve(triangles.size());

  std::size_t kept = 0;
  for (const SourceTriangle& triangle : triangles)
  {
    std::array<glm::vec3, 3> p;
    for (int i = 0; i < 3; ++i)
    {
      p[i] = glm::vec3(points[triangle.points[i]] - geometry.origin);
    }
    if (isDegenerate(p))
    {
      ++report.degenerateTriangles;
      continue;
    }
    geometry.positions.insert(geometry.positions.end(), p.begin(), p.end());
    geometry.cellIds.push_back(triangle.cell);
    triangles[kept++] = triangle;
  }
  triangles.resize(kept);

  if (!geometry.positions.empty())
  {
    geometry.boundsMin = geometry.boundsMax = geometry.positions.front();
    for (const glm::vec3& p : geometry.positions)
    {
      geometry.boundsMin = glm::min(geometry.boundsMin, p);
      geometry.boundsMax = glm::max(geometry.boundsMax, p);
    }
    geometry.flat = isFlat(geometry.positions);
  }
}

//------------------------------------------------------------------------------
void writeNormals(vtkPolyData* input, bool flat, const Triangles& triangles, Geometry& geometry,
  TriangleReport& report)
{
  vtkDataArray* ofPoints =
    flat ? nullptr : withTuples(input->GetPointData()->GetNormals(), input->GetNumberOfPoints());
  vtkDataArray* ofCells =
    ofPoints ? nullptr : withTuples(input->GetCellData()->GetNormals(), input->GetNumberOfCells());
  if (!ofPoints && !ofCells)
  {
    return;
  }
  geometry.normals.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    std::array<glm::vec3, 3> n;
    for (int i = 0; i < 3; ++i)
    {
      n[i] = ofPoints ? readNormal(ofPoints, triangles[t].points[i])
                      : readNormal(ofCells, triangles[t].cell);
    }
    if (!areUsable(n))
    {
      n.fill(faceNormal(geometry, t));
      ++report.replacedNormals;
    }
    geometry.normals.insert(geometry.normals.end(), n.begin(), n.end());
  }
}

} // namespace scene
} // namespace hrt
