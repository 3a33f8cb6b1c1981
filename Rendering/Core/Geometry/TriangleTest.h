// The exact kernel: the one test that decides whether a ray meets a triangle and where. Every
// engine asks it - structures for their candidates, the raster path for the ids it read, the
// brute-force references of the tests - so that they agree to the last bit.
//
// Sven Woop, Carsten Benthin, Ingo Wald: "Watertight Ray/Triangle Intersection", Journal of
// Computer Graphics Techniques 2(1), 2013. The ray is made the z axis by a shear; what is left are
// three two-dimensional edge functions, each the difference of two products.
//
// Why no ray slips through an edge or a vertex of a closed mesh. Rounding is monotonic: when the
// rounded products differ, the exact products differ in the same order. An edge function therefore
// has the exact sign for the sheared corners, or is zero; and a zero counts as inside on both sides
// of the edge. The sheared corners depend on ray and corner only, so neighbours see the same planar
// mesh, and every point that it covers lies in some closed triangle for which all signs agree. This
// needs the subtraction of two rounded products (no fused multiply-add: this unit is compiled with
// -ffp-contract=off) and a difference of unequal numbers that is never flushed to zero (no FTZ).
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <glm/glm.hpp>

#include <cstddef>

namespace hrt
{

// A triangle's corners in world coordinates relative to Snapshot::origin.
struct Corners
{
  glm::dvec3 a, b, c;
};

struct TriangleHit
{
  double t = 0.0;
  double u = 0.0; // of the second corner
  double v = 0.0; // of the third corner
};

// Part::positionsToWorld followed by the step to the snapshot's origin.
glm::dmat4 positionsToScene(const Part& part, const glm::dvec3& sceneOrigin);

// Corners of a geometry's triangle. Equal positions give equal corners, bit by bit: what holds
// together in the mesh holds together here.
Corners sceneCorners(
  const Geometry& geometry, const glm::dmat4& positionsToScene, std::size_t triangle);

// The same from copies of the triangle's three positions.
Corners sceneCorners(const glm::vec3* positions, const glm::dmat4& positionsToScene);

// A ray with the shear that makes it the z axis, to be tested against many triangles.
class ShearedRay
{
public:
  ShearedRay(const glm::dvec3& origin, const glm::dvec3& direction);

  // False for a NaN, infinite or zero direction (zero: no component is a normal number) and for a
  // non-finite origin: such a ray hits nothing.
  bool valid() const { return this->Valid; }

  // Both sides count. A hit has 0 < t < tMaximum and finite t, u, v.
  bool hitsTriangle(const Corners& corners, double tMaximum, TriangleHit& hit) const;

  // Where the ray meets the triangle's plane, inside the triangle or not, t of any sign: for a
  // triangle that the rasteriser has found. False when the plane is seen edge-on. Where
  // hitsTriangle finds a hit, this finds the same bits.
  bool hitsPlane(const Corners& corners, TriangleHit& hit) const;

private:
  struct EdgeFunctions;
  EdgeFunctions edgeFunctions(const Corners& corners) const;

  glm::dvec3 Origin;
  int Kx = 0, Ky = 1, Kz = 2; // Kz: the direction's longest component
  double ShearX = 0.0, ShearY = 0.0, ScaleZ = 0.0;
  bool Valid = false;
};

// The same for a single triangle.
bool triangleHit(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& corners,
  double tMaximum, TriangleHit& hit);
bool planeHit(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& corners,
  TriangleHit& hit);

} // namespace hrt
