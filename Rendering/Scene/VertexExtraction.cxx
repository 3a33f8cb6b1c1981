// See VertexExtraction.h.

#include "Rendering/Scene/VertexExtraction.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
double powerOfTwoAtLeast(double x)
{
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent); // x = mantissa * 2^exponent, in [0.5, 1)
  return std::ldexp(1.0, mantissa == 0.5 ? exponent - 1 : exponent);
}

//------------------------------------------------------------------------------
// Of the triangles, degenerate ones among them: which of them are depends on the origin.
glm::dvec3 originOf(const Triangles& triangles, const VectorReader& points)
{
  if (triangles.size() == 0)
  {
    return glm::dvec3(0.0);
  }
  glm::dvec3 lower = points[triangles.points.front()[0]], upper = lower;
  for (const auto& triangle : triangles.points)
  {
    for (const PointNumber number : triangle)
    {
      const glm::dvec3 point = points[number];
      lower = glm::min(lower, point);
      upper = glm::max(upper, point);
    }
  }
  return originOfBox(lower, upper);
}

//------------------------------------------------------------------------------
glm::vec3 positionOf(const glm::dvec3& point, const glm::dvec3& origin)
{
  return glm::vec3(point - origin);
}

//------------------------------------------------------------------------------
glm::dvec3 areaVector(const std::array<glm::vec3, 3>& p)
{
  const glm::dvec3 a(p[0]);
  return glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
}

//------------------------------------------------------------------------------
// No area in the corners as they are stored: two of them equal or three in a line. Taken in double,
// so that slivers whose area single precision would round to zero are kept.
bool isDegenerate(const std::array<glm::vec3, 3>& p)
{
  return areaVector(p) == glm::dvec3(0.0);
}

//------------------------------------------------------------------------------
// Keeps the triangles that have an area; returns how many have none.
std::size_t dropDegenerate(
  Triangles& triangles, const VectorReader& points, const glm::dvec3& origin)
{
  std::size_t kept = 0;
  CellIds cells;
  cells.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const std::array<PointNumber, 3> t = triangles.points[i];
    if (!isDegenerate({ positionOf(points[t[0]], origin), positionOf(points[t[1]], origin),
          positionOf(points[t[2]], origin) }))
    {
      triangles.points[kept++] = t;
      cells.push_back(triangles.cells[i]);
    }
  }
  const std::size_t dropped = triangles.size() - kept;
  triangles.points.resize(kept);
  triangles.cells = std::move(cells);
  return dropped;
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
// The normals that VTK's mapper takes, and what they belong to.
struct NormalSource
{
  vtkDataArray* array = nullptr;
  Attachment attachment = Attachment::Vertices;

  NormalSource(vtkPolyData* input, bool flat)
  {
    if (!flat)
    {
      this->array = withTuples(input->GetPointData()->GetNormals(), input->GetNumberOfPoints());
    }
    if (!this->array)
    {
      this->attachment = Attachment::Triangles;
      this->array = withTuples(input->GetCellData()->GetNormals(), input->GetNumberOfCells());
    }
  }

  bool ofVertices() const { return this->array && this->attachment == Attachment::Vertices; }
  bool ofTriangles() const { return this->array && this->attachment == Attachment::Triangles; }

private:
  static vtkDataArray* withTuples(vtkDataArray* candidate, vtkIdType tuples)
  {
    return candidate && candidate->GetNumberOfComponents() == 3 &&
        candidate->GetNumberOfTuples() >= tuples
      ? candidate
      : nullptr;
  }
};

//------------------------------------------------------------------------------
// The numbers, in order, of the triangles whose points' normals are of no use.
std::vector<std::size_t> unusable(const Triangles& triangles, const VectorReader& normals)
{
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const std::array<PointNumber, 3>& t = triangles.points[i];
    const glm::vec3 a(normals[t[0]]), b(normals[t[1]]), c(normals[t[2]]);
    if (!areUsable({ a, b, c }))
    {
      found.push_back(i);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
// Turns numbers of points into numbers of vertices, in place. The triangles that are `apart` share
// their vertices with nobody.
VertexPoints numberVertices(std::vector<std::array<PointNumber, 3>>& triangles,
  std::size_t pointCount, const std::vector<std::size_t>& apart)
{
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  if (pointCount + 3 * apart.size() > kNone)
  {
    throw std::length_error("a mesh has more than 2^32 - 1 vertices");
  }
  std::vector<std::uint32_t> vertexOf(pointCount, kNone);
  VertexPoints pointOf;
  pointOf.reserve(std::min(3 * triangles.size(), pointCount + 3 * apart.size()));
  auto nextApart = apart.begin();
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const bool alone = nextApart != apart.end() && *nextApart == i;
    nextApart += alone ? 1 : 0;
    for (std::uint32_t& number : triangles[i])
    {
      const PointNumber point = number;
      number = alone || vertexOf[point] == kNone ? static_cast<std::uint32_t>(pointOf.size())
                                                 : vertexOf[point];
      if (number == pointOf.size())
      {
        pointOf.push_back(point);
        vertexOf[point] = alone ? vertexOf[point] : number;
      }
    }
  }
  return pointOf;
}

//------------------------------------------------------------------------------
glm::vec3 faceNormal(const Geometry& geometry, std::size_t triangle)
{
  return glm::vec3(glm::normalize(areaVector(geometry.cornerPositions(triangle))));
}

//------------------------------------------------------------------------------
void writeVertexNormals(const VectorReader& normals, const VertexPoints& pointOf,
  const std::vector<std::size_t>& replaced, Geometry& geometry)
{
  std::vector<glm::vec3>& values = geometry.normals.values;
  values.reserve(pointOf.size());
  for (const PointNumber point : pointOf)
  {
    values.emplace_back(normals[point]);
  }
  for (const std::size_t triangle : replaced)
  {
    const glm::vec3 normal = faceNormal(geometry, triangle);
    for (const std::uint32_t vertex : geometry.triangles[triangle])
    {
      values[vertex] = normal;
    }
  }
}

//------------------------------------------------------------------------------
void writeTriangleNormals(const VectorReader& normals, Geometry& geometry)
{
  geometry.normals.attachment = Attachment::Triangles;
  geometry.normals.values.reserve(geometry.triangleCount());
  for (std::size_t i = 0; i < geometry.triangleCount(); ++i)
  {
    glm::vec3 normal(normals[static_cast<std::size_t>(geometry.cellIds[i])]);
    if (!areUsable({ normal, normal, normal }))
    {
      normal = faceNormal(geometry, i);
    }
    geometry.normals.values.push_back(normal);
  }
}

//------------------------------------------------------------------------------
void writePositions(
  const VectorReader& points, const VertexPoints& pointOf, Geometry& geometry)
{
  geometry.positions.reserve(pointOf.size());
  for (const PointNumber point : pointOf)
  {
    geometry.positions.push_back(positionOf(points[point], geometry.origin));
  }
  if (!geometry.positions.empty())
  {
    geometry.boundsMin = geometry.boundsMax = geometry.positions.front();
    for (const glm::vec3& p : geometry.positions)
    {
      geometry.boundsMin = glm::min(geometry.boundsMin, p);
      geometry.boundsMax = glm::max(geometry.boundsMax, p);
    }
    geometry.flat = isFlat(geometry);
  }
}

} // anonymous namespace

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
VertexPoints writeVertices(vtkPolyData* input, bool flat, Triangles triangles, Geometry& geometry,
  TriangleReport& report)
{
  const VectorReader points = readPoints(input);
  geometry.origin = originOf(triangles, points);
  geometry.givenFrom = points.isSinglePrecision() ? geometry.origin : glm::dvec3(0.0);
  report.degenerateTriangles += dropDegenerate(triangles, points, geometry.origin);

  const NormalSource source(input, flat);
  const VectorReader normals(source.array);
  std::vector<std::size_t> apart;
  if (source.ofVertices())
  {
    apart = unusable(triangles, normals);
  }
  VertexPoints pointOf = numberVertices(triangles.points, points.size(), apart);
  geometry.triangles = std::move(triangles.points);
  geometry.cellIds = std::move(triangles.cells);

  writePositions(points, pointOf, geometry);
  if (source.ofVertices())
  {
    writeVertexNormals(normals, pointOf, apart, geometry);
  }
  if (source.ofTriangles())
  {
    writeTriangleNormals(normals, geometry);
  }
  return pointOf;
}

} // namespace scene
} // namespace hrt
