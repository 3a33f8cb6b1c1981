// The exact kernel of Geometry/TriangleIntersection.h once more, for the hottest place: on triangles as
// hierarchies keep them, alone or for eight pairs of a ray and a triangle at once. The same
// operations in the same order, hence the same bits and the same proof; the tests compare the two
// bit by bit. Like the kernel it is compiled with -ffp-contract=off: AVX-512 has fused operations.
#pragma once

#include "Rendering/Core/Geometry/TriangleIntersection.h"
#include "Rendering/Core/Structures/InstructionSet.h"

namespace hrt
{

// A usable ray's direction as ShearedRay keeps it.
struct ExactShear
{
  int longest = -1; // axis; -1: not known yet
  double x = 0.0, y = 0.0, scale = 0.0;

  ExactShear() = default;
  explicit ExactShear(const glm::dvec3& direction);

  static int longestAxis(const glm::dvec3& direction);
};

// A triangle's positions in its geometry, where they lie: the corners anywhere, their axes at one
// distance from each other.
struct ExactPositions
{
  const float* corner[3];
  int axisStep;

  float operator()(int k, int axis) const { return this->corner[k][axis * this->axisStep]; }
};

// ShearedRay::hitsTriangle of the triangle as `toScene` places it.
bool exactHit(const ExactShear& shear, const glm::dvec3& origin, double last,
  const ExactPositions& positions, const glm::dmat4& toScene, TriangleHit& hit);

struct ExactLanes
{
  static constexpr unsigned int kLanes = 8;

  // In: usable rays, in scene coordinates, and the triangles' positions.
  alignas(64) double origin[3][kLanes];
  alignas(64) double direction[3][kLanes];
  alignas(64) double last[kLanes];          // the ray's tMaximum
  alignas(64) float position[3][3][kLanes]; // corner, axis

  // Out.
  alignas(64) double t[kLanes], u[kLanes], v[kLanes];

  // The lanes that hit, as bits. All triangles are placed by the one matrix; `longest` is the
  // longest axis of all directions.
  unsigned int hit(const glm::dmat4& toScene, int longest, InstructionSet set);
};

} // namespace hrt
