// From a hit to the surface there: position, sides, normals and colours, as VTK's polydata mapper
// sees them. The tracer, the buffers handed to the user and the tests all ask here, so that a pixel
// means the same point to each.
#pragma once

#include "Rendering/Core/Geometry/Coincidence.h"
#include "Rendering/Core/Geometry/TriangleIntersection.h"
#include "Rendering/Core/Shading/Shading.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"

#include <array>
#include <vector>

namespace hrt
{

// Made by Surfaces, which fills in all of it: one is made for each hit of each ray, and zeros first would
// be a good part of the cost.
struct SurfacePoint
{
  TriangleId triangle;
  std::size_t part;
  const Material* material;

  glm::dvec3 position;        // relative to Snapshot::origin, on the triangle
  glm::dvec3 geometricNormal; // unit, towards the viewer
  glm::dvec3 normal;          // for shading: unit, of the viewer's side as VTK turns it
  // The same, but turned by the body's outside: no matrix turns the optics of a smooth mesh over.
  glm::dvec3 opticalNormal;
  // By the corners' winding in the world, as gl_FrontFacing; a mirroring matrix swaps the sides.
  bool frontSide;
  // By the corners' winding in the part's own coordinates: the side that a closed mesh calls its
  // outside, whatever the matrix. Decides whether a ray enters or leaves glass.
  bool outside;

  shading::HrtSurface colors;
  float edgeShare; // of the edges' colour, which is in `colors` already
  glm::vec3 textureColor; // multiplies what is shaded
  glm::vec3 diffuseColor; // without its coefficient, textured: the tint of glass
  float opacity;           // 0 in a hole

  // Where rays that leave it begin, but for `positionError`: the position, or next to it where that lies
  // on an edge of the triangle. See Surface.cpp.
  glm::dvec3 start;
  glm::dvec3 arrival; // the direction that it is seen along
  // How far rounding may have put `position` off the triangle, generously.
  double positionError;
  // No surface in one place with it is farther away: along the normal.
  double twinReach;
};

// The part of a SurfacePoint that its colours are.
struct SurfaceColoring
{
  shading::HrtSurface colors;
  glm::vec3 textureColor;
  glm::vec3 diffuseColor;
  float opacity;
};

// How far a ray has come from the camera. Lengths count along the camera's axis, as depths in the window:
// a pixel at the window's border is as wide as one in its middle.
struct Way
{
  double depth = 0.0;
  double cosine = 1.0; // of the primary ray to the axis

  void add(double length) { this->depth += this->cosine * length; }
};

// The parts of one snapshot, placed. The snapshot must outlive it and stay as it is.
class Surfaces
{
public:
  explicit Surfaces(const Snapshot& snapshot);

  struct Placement
  {
    glm::dmat4 toScene;
    glm::dmat3 normalsToScene; // inverse transpose
    bool mirrored;
  };
  // Where a triangle is. Kept, it need not be looked for again when its neighbour is asked for.
  struct Site
  {
    Site() = default;
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    TriangleId id = kNoTriangle;
    std::size_t index = 0;                // of its part
    const Part* part = nullptr;
    std::size_t triangle = 0;             // in its part
    const Placement* placement = nullptr;
    Placement ofCopy;                     // which has no place in a table
  };
  void find(TriangleId id, Site& site) const;
  // Of that only the part.
  void findPart(TriangleId id, Site& site) const;

  // A triangle with its corners in the scene. Kept, it need not be gathered again.
  class Located;

  // A point's colours. `u` and `v`: of the second and third corner.
  void color(const Site& site, float u, float v, bool front, SurfaceColoring& coloring) const;

  // SurfacePoint::start of a point next to an edge.
  static glm::dvec3 startOnBorder(const Site& site, const Hit& hit, double positionError);

  // The ray against the plane of a triangle that the rasteriser found, in double, the barycentrics
  // moved into the triangle. False when the plane is seen edge-on or lies behind the ray.
  bool primaryHit(TriangleId id, const Ray& ray, Hit& hit) const;
  bool primaryHit(TriangleId id, const Ray& ray, Hit& hit, Located& where) const;

  // The exact kernel's answer for one triangle: a hit within the triangle, 0 < t < tMaximum.
  bool exactHit(TriangleId id, const ShearedRay& ray, double tMaximum, Hit& hit) const;

  // The surface at a hit, as seen along the ray's direction.
  SurfacePoint at(const Hit& hit, const glm::dvec3& direction) const;

  // Its position alone.
  glm::dvec3 positionOf(const Hit& hit) const;

  // Which of them lie in one place.
  const Coincidence& coincidence() const { return this->Twins; }

  // The same with the edges that the surface shows: at the centre of a pixel of the camera's, which are
  // numbered row by row from the lower left, where another triangle of the surface may be seen ...
  // `where`: perhaps that of the hit's triangle.
  SurfacePoint seenAtPixel(
    const Hit& hit, const glm::dvec3& direction, std::uint32_t pixel, Located& where) const;
  // ... or by a ray that has come some way from the camera, over mirrors and through glass: edges are as
  // wide as they were in the window if that way were straight.
  SurfacePoint seenFrom(const Hit& hit, const glm::dvec3& direction, const Way& way) const;
  // The way of a primary ray of unit direction.
  Way beginning(const glm::dvec3& direction, double length) const;

  // Whether the surface has a hole there.
  bool isHole(const Hit& hit, const glm::dvec3& direction) const;

private:
  static Placement placement(const Part& part, const glm::dvec3& origin, std::size_t copy);
  // at(), where the triangle is located; and with the terms that the colours are made from.
  SurfacePoint plainAt(
    const Hit& hit, const glm::dvec3& direction, const Located& where) const;
  SurfacePoint evaluate(const Hit& hit, const glm::dvec3& direction, const Located& where,
    shading::HrtTerms& terms) const;

  const Snapshot& Scene;
  std::vector<Placement> Placements; // one a part, of its first copy
  // A part's colours, front and back, where they are the same everywhere.
  struct PlainColors
  {
    bool plain = false;
    std::array<SurfaceColoring, 2> side;
  };
  std::vector<PlainColors> Plain;
  Coincidence Twins;
  glm::dmat3 ViewAxes; // of the view coordinates, unit
  glm::dmat4 ToWindow; // from coordinates relative to the scene's origin; pixels and depth, times w
  // A pixel's size at the camera, and by how much it grows with depth.
  double PixelSize = 0.0;
  double PixelGrowth = 0.0;
  glm::dvec3 Axis{ 0.0 }; // unit; zero where all rays are parallel
};

class Surfaces::Located
{
public:
  Located() = default;
  Located(const Surfaces& surfaces, TriangleId id) { this->locate(surfaces, id); }
  Located(const Located&) = delete;
  Located& operator=(const Located&) = delete;

  // Does nothing where it is that triangle already.
  void locate(const Surfaces& surfaces, TriangleId id);

  std::size_t part() const { return this->Where.index; }
  std::size_t triangle() const { return this->Where.triangle; } // in its part
  const Corners& corners() const { return this->At; }
  const Placement& placement() const { return *this->Where.placement; }

private:
  Site Where;
  Corners At;
};

// primaryHit() for a single pixel, without a table.
bool primaryHit(const Snapshot& snapshot, TriangleId id, const Ray& ray, Hit& hit);

// A ray that leaves a surface point: it starts off the triangle by the point's rounding error, on
// the side that it leaves to, and never hits the triangle itself, nor what lies in one place with it.
Ray leave(const SurfacePoint& point, const glm::dvec3& direction);

} // namespace hrt
