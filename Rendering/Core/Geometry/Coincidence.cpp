// Implements the rule's question. Compiled with -ffp-contract=off, so that the answer is the same on
// every machine, whatever the caller is compiled for.
#include "Rendering/Core/Geometry/Coincidence.h"

#include <algorithm>
#include <cmath>

namespace hrt
{

namespace
{

double largest(const glm::dvec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

glm::dmat3 sizesOf(const glm::dmat4& m)
{
  return { glm::abs(glm::dvec3(m[0])), glm::abs(glm::dvec3(m[1])), glm::abs(glm::dvec3(m[2])) };
}

// What rounding does to corners on their way into the scene.
struct Rounding
{
  glm::dmat3 sizes;             // of the numbers of the matrix that the coordinates go through
  glm::dvec3 ofCopy{ 0.0 };     // what the rounding of a copy's translation does
  double perCoordinate = kCoordinateRounding;

  explicit Rounding(const glm::dmat4& localToWorld)
    : sizes(sizesOf(localToWorld))
  {
  }
  // `copy`: no number of the copy's matrix is larger than these; its translation relative to the copies'
  // origin.
  Rounding(const glm::dmat4& localToWorld, const glm::dmat4& copy)
    : sizes(sizesOf(localToWorld) * sizesOf(copy))
    , ofCopy(sizesOf(localToWorld) * (kCoordinateRounding * glm::abs(glm::dvec3(copy[3]))))
    , perCoordinate(2.0 * kCoordinateRounding)
  {
  }

  // Along the scene's axes, of a corner whose coordinates, as they were given, are of these sizes.
  glm::dvec3 of(const glm::dvec3& given) const
  {
    return this->sizes * (this->perCoordinate * given) + this->ofCopy;
  }
};

// A copy's matrix as it is stored.
glm::dmat4 storedMatrix(const Copies& copies, std::size_t copy)
{
  glm::dmat4 m = copies.matrix(copy);
  m[3] -= glm::dvec4(copies.origin, 0.0);
  return m;
}

glm::dvec3 givenSizes(const Geometry& geometry, const glm::vec3& position)
{
  return glm::abs(glm::dvec3(position) + geometry.givenFrom);
}

// Twice the area vector of the first triangle that has one, in the scene.
glm::dvec3 firstNormal(const Geometry& geometry, const glm::dmat4& toScene)
{
  for (std::size_t i = 0; i < geometry.triangleCount(); ++i)
  {
    const Corners c = sceneCorners(geometry, toScene, i);
    const glm::dvec3 wound = glm::cross(c.b - c.a, c.c - c.a);
    if (wound != glm::dvec3(0.0))
    {
      return wound;
    }
  }
  return glm::dvec3(0.0);
}

// The largest coordinate of the part, relative to the scene's origin.
double reachOf(const Part& part, const glm::dvec3& sceneOrigin)
{
  glm::dvec3 lower, upper;
  worldBounds(part, lower, upper);
  return largest(glm::max(glm::abs(lower - sceneOrigin), glm::abs(upper - sceneOrigin)));
}

} // namespace

// A triangle's plane and what rounding does to it.
struct Coincidence::Facet
{
  glm::dvec3 corner{ 0.0 };
  glm::dvec3 normal{ 0.0 }; // unit, outside by the corners' winding; zero where there is no plane
  double rounding = 0.0;
  double tilt = 0.0; // sine of the angle by which it turns the plane, at most

  bool hasPlane() const { return this->normal != glm::dvec3(0.0); }

  bool isNear(const Facet& other, const glm::dvec3& point, double margin) const
  {
    return std::abs(glm::dot(other.corner - point, other.normal)) <=
      margin * (this->rounding + other.rounding);
  }

  bool isParallel(const Facet& other, double margin) const
  {
    return glm::length(glm::cross(this->normal, other.normal)) <=
      margin * (this->tilt + other.tilt);
  }
};

double Coincidence::roundingOf(const Part& part, const glm::dvec3& sceneOrigin)
{
  const Geometry& geometry = *part.geometry;
  if (part.triangleCount() == 0)
  {
    return 0.0;
  }
  const Rounding rounding = part.copies ? Rounding(part.localToWorld, part.copies->largest)
                                        : Rounding(part.localToWorld);
  const glm::dvec3 corner = rounding.of(glm::max(
    givenSizes(geometry, geometry.boundsMin), givenSizes(geometry, geometry.boundsMax)));
  const double computed = kComputedRounding * reachOf(part, sceneOrigin);
  if (part.isFlat())
  {
    const glm::dvec3 wound = firstNormal(geometry, positionsToScene(part, sceneOrigin));
    const double length = glm::length(wound);
    if (length > 0.0)
    {
      return glm::dot(glm::abs(wound), corner) / length + computed;
    }
  }
  return glm::length(corner) + computed;
}

Coincidence::Coincidence(const Snapshot& snapshot)
  : Origin(snapshot.origin)
{
  this->Parts.reserve(snapshot.parts.size());
  for (const Part& part : snapshot.parts)
  {
    PlacedPart placed;
    placed.part.firstTriangle = part.firstTriangle;
    placed.part.geometry = part.geometry;
    placed.part.copies = part.copies;
    placed.part.localToWorld = part.localToWorld;
    placed.rounding = roundingOf(part, snapshot.origin);
    this->LargestRounding = std::max(this->LargestRounding, placed.rounding);
    this->Parts.push_back(placed);
  }
  this->Reach = kSetMargin * 2.0 * this->LargestRounding / kGrazing;
}

Coincidence::Place Coincidence::placeOf(TriangleId triangle) const
{
  // As Snapshot::partOf finds it, never an empty one.
  const auto next = std::upper_bound(this->Parts.begin(), this->Parts.end(), triangle,
    [](TriangleId id, const PlacedPart& placed) { return id < placed.part.firstTriangle; });
  const PlacedPart& placed = *(next - 1);
  return { &placed, placed.part.copyOf(triangle) };
}

Coincidence::Facet Coincidence::facetOf(
  TriangleId triangle, const Place& place, bool given) const
{
  const Part& part = place.part->part;
  const std::size_t index = part.indexOf(triangle);
  const glm::dmat4 toScene = positionsToScene(part, this->Origin, place.copy);
  const Corners corners = sceneCorners(*part.geometry, toScene, index);
  const glm::dvec3 ab = corners.b - corners.a, ac = corners.c - corners.a;
  const glm::dvec3 wound = glm::cross(ab, ac);
  const double area = glm::length(wound); // twice it
  Facet facet;
  facet.corner = corners.a;
  if (!(area > 0.0))
  {
    return facet;
  }
  const bool mirrored = glm::determinant(glm::dmat3(toScene)) < 0.0;
  facet.normal = (mirrored ? -wound : wound) / area;
  if (given)
  {
    const Rounding rounding = part.copies
      ? Rounding(part.localToWorld, storedMatrix(*part.copies, place.copy))
      : Rounding(part.localToWorld);
    for (const glm::vec3& position : part.geometry->cornerPositions(index))
    {
      facet.rounding = std::max(facet.rounding,
        glm::dot(glm::abs(facet.normal), rounding.of(givenSizes(*part.geometry, position))));
    }
  }
  facet.rounding += kComputedRounding *
    largest(glm::max(glm::abs(corners.a), glm::max(glm::abs(corners.b), glm::abs(corners.c))));
  // Of a part taken for flat a small triangle may be turned by more than the part is.
  facet.rounding = std::min(facet.rounding, place.part->rounding);
  const double longest =
    std::max({ glm::length(ab), glm::length(ac), glm::length(corners.c - corners.b) });
  facet.tilt = 2.0 * facet.rounding * longest / area;
  return facet;
}

std::pair<Coincidence::Facet, Coincidence::Facet> Coincidence::facetsOf(
  TriangleId a, TriangleId b) const
{
  const Place first = this->placeOf(a), second = this->placeOf(b);
  const bool given = !(first == second);
  return { this->facetOf(a, first, given), this->facetOf(b, second, given) };
}

bool Coincidence::inOnePlace(
  TriangleId a, TriangleId b, const glm::dvec3& point, double margin) const
{
  const auto [first, second] = this->facetsOf(a, b);
  return first.hasPlane() && second.hasPlane() && first.isNear(second, point, margin) &&
    first.isParallel(second, margin);
}

bool Coincidence::passesOver(TriangleId left, TriangleId met, const glm::dvec3& origin,
  const glm::dvec3& direction) const
{
  constexpr double kSameWay = 0.5; // cosine of 60 degrees
  const auto [first, second] = this->facetsOf(left, met);
  if (!first.hasPlane() || !second.hasPlane() || !first.isNear(second, origin, 1.0))
  {
    return false;
  }
  return first.isParallel(second, 1.0) ||
    (glm::dot(first.normal, second.normal) > kSameWay &&
      glm::dot(first.normal, direction) * glm::dot(second.normal, direction) > 0.0);
}

} // namespace hrt
