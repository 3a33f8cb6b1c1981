// Implements surface points. Geometry in double; colours in float, as the shared shading has it.
#include "Rendering/Core/Tracing/Surface.h"

#include <algorithm>
#include <cmath>

namespace hrt
{

namespace
{

// A point computed from corners of size R is off its triangle by a few roundings, at most 8 R e
// with e = 2^-53, and the depth at which the kernel then meets a neighbour in the same plane is
// uncertain by about as much times the neighbour's length over its height. 2^-43 = 1024 e covers
// slivers a hundred times longer than high, and still is only a tenth of a picometre in a metre.
constexpr double kPositionError = 0x1p-43;

double largestCoordinate(const Corners& corners)
{
  const glm::dvec3 most =
    glm::max(glm::abs(corners.a), glm::max(glm::abs(corners.b), glm::abs(corners.c)));
  return std::max({ most.x, most.y, most.z });
}

bool hitPrimary(const Corners& corners, TriangleId id, const Ray& ray, Hit& hit)
{
  TriangleHit plane;
  if (!planeHit(ray.origin, ray.direction, corners, plane) || !(plane.t > 0.0))
  {
    return false;
  }
  const glm::dvec2 inside = shading64::hrtClampBarycentrics(plane.u, plane.v);
  hit = { id, plane.t, inside.x, inside.y };
  return true;
}

std::size_t indexInPart(const Part& part, TriangleId id)
{
  return id - part.firstTriangle;
}

// The interpolated corner normal, or zero when the geometry has none.
glm::dvec3 cornerNormal(const Geometry& geometry, std::size_t triangle, const Hit& hit)
{
  if (geometry.normals.empty())
  {
    return glm::dvec3(0.0);
  }
  const std::array<glm::vec3, 3> n = geometry.cornersOf(geometry.normals, triangle);
  return shading64::hrtInterpolate3(n[0], n[1], n[2], hit.u, hit.v);
}

// RGBA in [0, 1] where scalars colour the geometry.
glm::vec4 scalarColor(const Geometry& geometry, std::size_t triangle, const Hit& hit)
{
  const float u = static_cast<float>(hit.u), v = static_cast<float>(hit.v);
  if (geometry.colorSource == ColorSource::Corner)
  {
    const std::array<glm::u8vec4, 3> c = geometry.cornersOf(geometry.colors, triangle);
    return shading::hrtInterpolate4(glm::vec4(c[0]), glm::vec4(c[1]), glm::vec4(c[2]), u, v) /
      255.0f;
  }
  const std::array<glm::vec2, 3> c = geometry.cornersOf(geometry.coordinates, triangle);
  const int texel = shading::hrtLookupTexel(shading::hrtInterpolate2(c[0], c[1], c[2], u, v),
    geometry.lookupWidth, geometry.lookupHeight);
  return glm::vec4(geometry.lookup[static_cast<std::size_t>(texel)]) / 255.0f;
}

// VTK's rule: scalar colours replace the front's ambient and diffuse colour, keep its coefficients
// and switch the backface property off.
PhongTerms termsAt(const Part& part, std::size_t triangle, const Hit& hit, bool frontSide)
{
  const Geometry& geometry = *part.geometry;
  if (geometry.colorSource == ColorSource::Property)
  {
    return frontSide ? part.material.front : part.material.back;
  }
  PhongTerms terms = part.material.front;
  const glm::vec4 color = scalarColor(geometry, triangle, hit);
  terms.ambientColor = terms.diffuseColor = glm::vec3(color);
  terms.opacity *= color.a;
  return terms;
}

shading::HrtSurface colorsOf(const PhongTerms& terms)
{
  return { terms.ambientColor * terms.ambient, terms.diffuseColor * terms.diffuse,
    terms.specularColor * terms.specular, terms.specularPower };
}

} // namespace

Surfaces::Surfaces(const Snapshot& snapshot)
  : Scene(snapshot)
{
  this->Placements.reserve(snapshot.parts.size());
  for (const Part& part : snapshot.parts)
  {
    const glm::dmat4 toScene = positionsToScene(part, snapshot.origin);
    const glm::dmat3 linear(toScene);
    this->Placements.push_back(
      { toScene, glm::transpose(glm::inverse(linear)), glm::determinant(linear) < 0.0 });
  }
}

bool Surfaces::primaryHit(TriangleId id, const Ray& ray, Hit& hit) const
{
  const std::size_t index = this->Scene.partOf(id);
  const Part& part = this->Scene.parts[index];
  return hitPrimary(
    sceneCorners(*part.geometry, this->Placements[index].toScene, indexInPart(part, id)), id, ray,
    hit);
}

bool Surfaces::exactHit(
  TriangleId id, const ShearedRay& ray, double tMaximum, Hit& hit) const
{
  const std::size_t index = this->Scene.partOf(id);
  const Part& part = this->Scene.parts[index];
  TriangleHit found;
  if (!ray.hitsTriangle(
        sceneCorners(*part.geometry, this->Placements[index].toScene, indexInPart(part, id)),
        tMaximum, found))
  {
    return false;
  }
  hit = { id, found.t, found.u, found.v };
  return true;
}

SurfacePoint Surfaces::at(const Hit& hit, const glm::dvec3& direction) const
{
  SurfacePoint point;
  point.triangle = hit.triangle;
  point.part = this->Scene.partOf(hit.triangle);
  const Part& part = this->Scene.parts[point.part];
  const Placement& placement = this->Placements[point.part];
  const std::size_t triangle = indexInPart(part, hit.triangle);
  const Corners corners = sceneCorners(*part.geometry, placement.toScene, triangle);

  const glm::dvec3 e1 = corners.b - corners.a, e2 = corners.c - corners.a;
  point.material = &part.material;
  point.position = corners.a + hit.u * e1 + hit.v * e2;
  point.positionError = kPositionError * largestCoordinate(corners);

  const glm::dvec3 wound = glm::cross(e1, e2);
  point.frontSide = !(glm::dot(wound, direction) > 0.0);
  point.outside = point.frontSide != placement.mirrored;
  point.geometricNormal = glm::normalize(point.frontSide ? wound : -wound);

  point.normal = point.opticalNormal = point.geometricNormal;
  const glm::dvec3 smooth =
    placement.normalsToScene * cornerNormal(*part.geometry, triangle, hit);
  const double length = glm::length(smooth);
  if (length > 0.0)
  {
    point.normal = (point.frontSide ? smooth : -smooth) / length;
    point.opticalNormal = (point.outside ? smooth : -smooth) / length;
  }

  const PhongTerms terms = termsAt(part, triangle, hit, point.frontSide);
  point.colors = colorsOf(terms);
  point.opacity = terms.opacity;
  point.diffuseColor = terms.diffuseColor;
  return point;
}

bool primaryHit(const Snapshot& snapshot, TriangleId id, const Ray& ray, Hit& hit)
{
  const Part& part = snapshot.parts[snapshot.partOf(id)];
  return hitPrimary(sceneCorners(*part.geometry, positionsToScene(part, snapshot.origin),
                      indexInPart(part, id)),
    id, ray, hit);
}

Ray leave(const SurfacePoint& point, const glm::dvec3& direction)
{
  const double side = glm::dot(point.geometricNormal, direction) < 0.0 ? -1.0 : 1.0;
  Ray ray;
  ray.origin = point.position + side * point.positionError * point.geometricNormal;
  ray.direction = direction;
  ray.originTriangle = point.triangle;
  return ray;
}

} // namespace hrt
