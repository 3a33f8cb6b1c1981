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
//
// Why a hit is where it says. Let u be half an ulp, M the sum of the six products' magnitudes, d that
// of the three edge functions' sum. Rounded products leave an edge function off by as much as u M. Of
// a triangle smaller than the rounding of its distance from the ray, or of a needle, that may be all
// there is: three functions such as 0, 0 and 1 ulp agree beside it, and within the needle they name a
// corner, and its depth, that is nowhere near the ray. So where d < M / 4 the edge functions are taken
// once more without cancellation, by Kahan's difference of products: its relative error is at most
// 2 u, hence signs and zeros are exact. (Jeannerod, Louvet, Muller: "Further analysis of Kahan's
// algorithm for the accurate computation of 2x2 determinants", Mathematics of Computation 82, 2013.)
// Then, whatever the triangle's shape, u and v miss the ray by at most 4 u of the triangle's own size
// and some roundings of the sheared corners: the hit lies as close to the triangle as these do, and so
// in its box grown by them, in which a ray structure looks for it. This takes no true hit away: where
// products round to different numbers their order was right before, and where they do not, the exact
// sign is one of those that zero stood for.
#pragma once

#include "Rendering/Core/Geometry/Rounding.h"
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
glm::dmat4 positionsToScene(
  const Part& part, const glm::dvec3& sceneOrigin, std::size_t copy = 0);

// Corners of a geometry's triangle. Equal positions give equal corners, bit by bit: what holds
// together in the mesh holds together here.
Corners sceneCorners(
  const Geometry& geometry, const glm::dmat4& positionsToScene, std::size_t triangle);

// The same from copies of the triangle's three positions.
Corners sceneCorners(const glm::vec3* positions, const glm::dmat4& positionsToScene);

// a b - c d without cancellation (Kahan), off by at most 2 u of itself.
double differenceOfProducts(double a, double b, double c, double d);

// A ray with the shear that makes it the z axis, to be tested against many triangles.
class ShearedRay
{
public:
  ShearedRay(const glm::dvec3& origin, const glm::dvec3& direction);

  // False for a NaN, infinite or zero direction (zero: no component is a normal number) and for a
  // non-finite origin: such a ray hits nothing.
  bool valid() const { return this->Valid; }

  // Both sides count. A hit has 0 < t < tMaximum and finite t, u, v; with a tMaximum that is not a
  // number there is none.
  bool hitsTriangle(const Corners& corners, double tMaximum, TriangleHit& hit) const;

  // Where the ray meets the triangle's plane, inside the triangle or not, t of any sign: for a
  // triangle that the rasteriser has found. False when the plane is seen edge-on. Where
  // hitsTriangle finds a hit, this finds the same bits.
  bool hitsPlane(const Corners& corners, TriangleHit& hit) const;

private:
  struct ShearedCorners;
  struct EdgeFunctions;
  ShearedCorners shear(const Corners& corners) const;

  glm::dvec3 Origin;
  int Kx = 0, Ky = 1, Kz = 2; // Kz: the direction's longest component
  double ShearX = 0.0, ShearY = 0.0, ScaleZ = 0.0;
  bool Valid = false;
};

// ShearedRay::hitsPlane for a single triangle.
bool planeHit(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& corners,
  TriangleHit& hit);

} // namespace hrt
