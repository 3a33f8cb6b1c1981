// Implements surface points. Geometry in double; colours in float, as the shared shading has it.
#include "Rendering/Core/Tracing/Surface.h"

#include "Rendering/Core/Structures/InstructionSet.h"
#include "Rendering/Core/Surface/EdgeLookup.h"
#include "Rendering/Core/Surface/SurfaceColors.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hrt
{

namespace
{

// Where rays leave a triangle from a point on its edge, they begin so many position errors inside of it.
// Rounding then no longer decides on which side of the neighbour they begin that shares the edge: it is
// that of the triangle's inside, also where the two meet at an angle of only 10 degrees.
constexpr double kInside = 8.0;

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

// A point of the triangle at least `distance` from its edges, or as far as the middle is: its least
// barycentric coordinates are raised. Rays that leave a closed body's edge inwards stay within.
glm::dvec3 insideOf(const Corners& corners, const Hit& hit, double distance)
{
  const glm::dvec3 ab = corners.b - corners.a, ac = corners.c - corners.a;
  const double area = glm::length(glm::cross(ab, ac)); // twice it
  const glm::dvec3 weights(1.0 - hit.u - hit.v, hit.u, hit.v);
  const glm::dvec3 edges(glm::length(ac - ab), glm::length(ac), glm::length(ab));
  const glm::dvec3 raised =
    glm::max(weights, glm::min(distance * edges / area, glm::dvec3(1.0 / 3.0)));
  const double sum = raised.x + raised.y + raised.z;
  return corners.a + raised.y / sum * ab + raised.z / sum * ac;
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

// Interpolating between opaque texels may round to less than 1: such textures are not asked.
float opacityOf(const Part& part, float opacity, float texture)
{
  if (part.perforated)
  {
    return texture > 0.0f ? 1.0f : 0.0f;
  }
  return part.material.textures.alpha == Texture::Alpha::Opaque ? opacity : opacity * texture;
}

// `terms`: what the colours are made from.
HRT_ALWAYS_INLINE SurfaceColoring coloringOf(const Part& part, std::size_t triangle, std::size_t copy,
  float u, float v, bool front, shading::HrtTerms& terms)
{
  shading::SurfaceColors colors(part, triangle, copy);
  terms = colors.hrtTermsAt(u, v, front);
  const glm::vec4 texture = colors.textureColor(u, v, front);
  SurfaceColoring coloring;
  coloring.colors = shading::hrtSurface(terms);
  coloring.textureColor = glm::vec3(texture);
  coloring.diffuseColor = terms.diffuseColor * coloring.textureColor;
  coloring.opacity = opacityOf(part, terms.opacity, texture.a);
  return coloring;
}

// VTK mixes edges into the colours before it lights them. `axes`: of the window, x, y and towards the
// viewer, unit.
void addEdges(shading64::EdgeLookup& edges, const EdgeStyle& style, const glm::dvec3& nearest,
  const glm::dmat3& axes, const shading::HrtTerms& terms, SurfacePoint& point)
{
  const double mix = edges.hrtEdgeMix(nearest.z, style.width);
  const float share = style.opacity * static_cast<float>(mix);
  point.colors =
    shading::hrtWithEdges(terms, point.colors, style.color, share, style.tubes);
  point.diffuseColor *= 1.0f - share;
  point.edgeShare = share;
  if (style.tubes)
  {
    point.normal = axes *
      edges.hrtTubeNormal(glm::transpose(axes) * point.normal, nearest, style.width, mix);
  }
}

glm::dmat4 translation(const glm::dvec3& by)
{
  return glm::translate(glm::dmat4(1.0), by);
}

} // namespace

Surfaces::Surfaces(const Snapshot& snapshot)
  : Scene(snapshot)
  , Twins(snapshot)
  , ToWindow(snapshot.camera.clipToWindow() * snapshot.camera.viewToClip *
      (snapshot.camera.worldToView * translation(snapshot.origin)))
{
  const glm::dmat3 toWorld = glm::inverse(glm::dmat3(snapshot.camera.worldToView));
  this->ViewAxes = glm::dmat3(
    glm::normalize(toWorld[0]), glm::normalize(toWorld[1]), glm::normalize(toWorld[2]));
  const CameraRays rays = snapshot.camera.worldRays(snapshot.origin);
  const auto perPixel = [&snapshot](const glm::dvec3& acrossX, const glm::dvec3& acrossY)
  {
    // The mean of the two; the coordinates run from -1 to 1, which is twice as far as from 0.
    return glm::length(acrossX) / snapshot.camera.width +
      glm::length(acrossY) / snapshot.camera.height;
  };
  this->PixelSize = perPixel(rays.originX, rays.originY);
  const glm::dvec3 axis = glm::cross(rays.directionX, rays.directionY);
  if (axis != glm::dvec3(0.0))
  {
    this->Axis = glm::normalize(axis);
    this->PixelGrowth = perPixel(rays.directionX, rays.directionY) /
      std::abs(glm::dot(this->Axis, rays.direction0));
  }

  this->Placements.reserve(snapshot.parts.size());
  this->Plain.resize(snapshot.parts.size());
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    const Part& part = snapshot.parts[i];
    this->Placements.push_back(placement(part, snapshot.origin, 0));
    if (part.geometry->colorSource == ColorSource::Property && !part.copies &&
      part.material.textures.layers.empty() && part.triangleCount() > 0)
    {
      PlainColors& plain = this->Plain[i];
      for (const bool front : { false, true })
      {
        shading::HrtTerms terms;
        plain.side[front] = coloringOf(part, 0, 0, 0.0f, 0.0f, front, terms);
      }
      plain.plain = true;
    }
  }
}

Surfaces::Placement Surfaces::placement(
  const Part& part, const glm::dvec3& origin, std::size_t copy)
{
  const glm::dmat4 toScene = positionsToScene(part, origin, copy);
  const glm::dmat3 linear(toScene);
  return { toScene, glm::transpose(glm::inverse(linear)), glm::determinant(linear) < 0.0 };
}

void Surfaces::findPart(TriangleId id, Site& site) const
{
  if (!site.part || id < site.part->firstTriangle ||
    id - site.part->firstTriangle >= site.part->triangleCount())
  {
    site.index = this->Scene.partOf(id);
    site.part = &this->Scene.parts[site.index];
  }
}

void Surfaces::find(TriangleId id, Site& site) const
{
  if (id == site.id)
  {
    return;
  }
  site.id = id;
  this->findPart(id, site);
  site.placement = &this->Placements[site.index];
  if (site.part->copies)
  {
    site.ofCopy = placement(*site.part, this->Scene.origin, site.part->copyOf(id));
    site.placement = &site.ofCopy;
  }
  site.triangle = site.part->indexOf(id);
}

void Surfaces::Located::locate(const Surfaces& surfaces, TriangleId id)
{
  if (id != this->Where.id)
  {
    surfaces.find(id, this->Where);
    this->At = sceneCorners(
      *this->Where.part->geometry, this->Where.placement->toScene, this->Where.triangle);
  }
}

bool Surfaces::primaryHit(TriangleId id, const Ray& ray, Hit& hit) const
{
  Located where;
  return this->primaryHit(id, ray, hit, where);
}

bool Surfaces::primaryHit(TriangleId id, const Ray& ray, Hit& hit, Located& where) const
{
  where.locate(*this, id);
  return hitPrimary(where.corners(), id, ray, hit);
}

bool Surfaces::exactHit(
  TriangleId id, const ShearedRay& ray, double tMaximum, Hit& hit) const
{
  TriangleHit found;
  if (!ray.hitsTriangle(Located(*this, id).corners(), tMaximum, found))
  {
    return false;
  }
  hit = { id, found.t, found.u, found.v };
  return true;
}

glm::dvec3 Surfaces::positionOf(const Hit& hit) const
{
  const Located where(*this, hit.triangle);
  const Corners& corners = where.corners();
  return corners.a + hit.u * (corners.b - corners.a) + hit.v * (corners.c - corners.a);
}

// In the callers themselves: those that want no terms need not have them in memory.
HRT_ALWAYS_INLINE SurfacePoint Surfaces::evaluate(
  const Hit& hit, const glm::dvec3& direction, const Located& where,
  shading::HrtTerms& terms) const
{
  SurfacePoint point;
  point.triangle = hit.triangle;
  point.part = where.part();
  const Part& part = this->Scene.parts[point.part];
  const Placement& placement = where.placement();
  const std::size_t triangle = where.triangle();
  const Corners& corners = where.corners();

  const glm::dvec3 e1 = corners.b - corners.a, e2 = corners.c - corners.a;
  point.material = &part.material;
  point.position = corners.a + hit.u * e1 + hit.v * e2;
  point.positionError = kComputedRounding * largestCoordinate(corners);
  point.twinReach = this->Twins.twinReach(point.part);
  point.arrival = direction;

  point.start = std::min({ hit.u, hit.v, 1.0 - hit.u - hit.v }) > kSurelyInside
    ? point.position
    : insideOf(corners, hit, kInside * point.positionError);

  const shading64::HrtSides sides =
    shading64::hrtSides(corners.a, corners.b, corners.c, direction);
  point.frontSide = sides.front;
  point.outside = sides.front != placement.mirrored;
  point.geometricNormal = sides.geometricNormal;
  const glm::dvec3 smooth =
    placement.normalsToScene * cornerNormal(*part.geometry, triangle, hit);
  point.normal = shading64::hrtSmoothNormal(smooth, sides.geometricNormal, point.frontSide);
  point.opticalNormal = point.outside == point.frontSide
    ? point.normal
    : shading64::hrtSmoothNormal(smooth, sides.geometricNormal, point.outside);

  const SurfaceColoring coloring = coloringOf(part, triangle, part.copyOf(hit.triangle),
    static_cast<float>(hit.u), static_cast<float>(hit.v), point.frontSide, terms);
  point.colors = coloring.colors;
  point.edgeShare = 0.0f;
  point.textureColor = coloring.textureColor;
  point.diffuseColor = coloring.diffuseColor;
  point.opacity = coloring.opacity;
  return point;
}

void Surfaces::color(
  const Site& site, float u, float v, bool front, SurfaceColoring& coloring) const
{
  const PlainColors& plain = this->Plain[site.index];
  if (plain.plain)
  {
    coloring = plain.side[front];
    return;
  }
  shading::HrtTerms terms;
  coloring =
    coloringOf(*site.part, site.triangle, site.part->copyOf(site.id), u, v, front, terms);
}

glm::dvec3 Surfaces::startOnBorder(const Site& site, const Hit& hit, double positionError)
{
  return insideOf(sceneCorners(*site.part->geometry, site.placement->toScene, site.triangle), hit,
    kInside * positionError);
}

SurfacePoint Surfaces::plainAt(
  const Hit& hit, const glm::dvec3& direction, const Located& where) const
{
  shading::HrtTerms terms;
  return this->evaluate(hit, direction, where, terms);
}

SurfacePoint Surfaces::at(const Hit& hit, const glm::dvec3& direction) const
{
  return this->plainAt(hit, direction, Located(*this, hit.triangle));
}

SurfacePoint Surfaces::seenAtPixel(
  const Hit& hit, const glm::dvec3& direction, std::uint32_t pixel, Located& where) const
{
  where.locate(*this, hit.triangle);
  const Part& part = this->Scene.parts[where.part()];
  if (!part.showsEdges())
  {
    return this->plainAt(hit, direction, where);
  }
  const auto width = static_cast<std::uint32_t>(this->Scene.camera.width);
  const glm::dvec2 centre(pixel % width + 0.5, pixel / width + 0.5);
  const glm::dmat4 toWindow =
    translation({ -centre, 0.0 }) * this->ToWindow * where.placement().toScene;
  const Material& material = part.material;
  shading64::EdgeLookup edges(*part.geometry, toWindow);
  const auto local = static_cast<TriangleId>(where.triangle());
  const auto seen = edges.hrtEdgeHit(static_cast<int>(local), { hit.u, hit.v },
    material.edges.width, material.cullFront || material.cullBack);
  Hit shown = hit;
  shown.triangle = hit.triangle - local + static_cast<TriangleId>(seen.triangle);
  shown.u = seen.uv.x;
  shown.v = seen.uv.y;
  where.locate(*this, shown.triangle);
  shading::HrtTerms terms;
  SurfacePoint point = this->evaluate(shown, direction, where, terms);
  addEdges(edges, material.edges, seen.nearest, this->ViewAxes, terms, point);
  return point;
}

Way Surfaces::beginning(const glm::dvec3& direction, double length) const
{
  Way way;
  way.cosine = this->Axis == glm::dvec3(0.0) ? 1.0 : std::abs(glm::dot(this->Axis, direction));
  way.add(length);
  return way;
}

SurfacePoint Surfaces::seenFrom(
  const Hit& hit, const glm::dvec3& direction, const Way& way) const
{
  const Located where(*this, hit.triangle);
  const Part& part = this->Scene.parts[where.part()];
  if (!part.showsEdges())
  {
    return this->plainAt(hit, direction, where);
  }
  shading::HrtTerms terms;
  SurfacePoint point = this->evaluate(hit, direction, where, terms);
  // A window across the ray, about the point where it meets the surface.
  const glm::dvec3 d = glm::normalize(direction);
  const glm::dvec3 size = glm::abs(d);
  const glm::dvec3 other = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
    : size.y <= size.z                                          ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  const glm::dvec3 x = glm::normalize(glm::cross(d, other)), y = glm::cross(d, x);
  const double growth = this->PixelGrowth * way.cosine;
  const double pixel = this->PixelSize + this->PixelGrowth * way.depth;
  const glm::dmat4 across = glm::transpose(glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(y, 0.0),
    glm::dvec4(0.0), glm::dvec4(growth * d, pixel)));
  const glm::dmat4 toWindow =
    across * translation(-point.position) * where.placement().toScene;
  shading64::EdgeLookup edges(*part.geometry, toWindow);
  const EdgeStyle& style = part.material.edges;
  addEdges(edges, style,
    edges.nearestOf(static_cast<int>(where.triangle()), style.width),
    glm::dmat3(x, y, -d), terms, point);
  return point;
}

bool Surfaces::isHole(const Hit& hit, const glm::dvec3& direction) const
{
  return this->Scene.parts[this->Scene.partOf(hit.triangle)].perforated &&
    this->at(hit, direction).opacity == 0.0f;
}

bool primaryHit(const Snapshot& snapshot, TriangleId id, const Ray& ray, Hit& hit)
{
  const Part& part = snapshot.parts[snapshot.partOf(id)];
  return hitPrimary(sceneCorners(*part.geometry,
                      positionsToScene(part, snapshot.origin, part.copyOf(id)),
                      part.indexOf(id)),
    id, ray, hit);
}

Ray leave(const SurfacePoint& point, const glm::dvec3& direction)
{
  const double along = glm::dot(point.geometricNormal, direction);
  Ray ray;
  ray.origin = point.start;
  if (along < 0.0)
  {
    ray.origin -= point.positionError * point.geometricNormal;
  }
  else
  {
    // Also a step back to where the point is seen from: where another surface stands on this one, with
    // its edge through the point, the way back is on the side of it that is seen too.
    ray.origin += point.positionError * (point.geometricNormal - point.arrival);
  }
  ray.direction = direction;
  ray.originTriangle = point.triangle;
  // A twin that rounding has turned is met a little later than the distance alone says. The floor is
  // for rays along the surface.
  constexpr double kTurned = 4.0, kLeast = 1e-200;
  ray.twinEnd = static_cast<float>(
    std::min<double>(kTurned * point.twinReach / std::max(std::abs(along), kLeast),
      std::numeric_limits<float>::max()));
  return ray;
}

} // namespace hrt
