// All triangles of a snapshot in one list, each tried with every ray: the reference renderer's only
// way to find a hit. No acceleration structure, none of the product's intersection code; signed
// volumes in double, and where rounding could decide, exact arithmetic (ExactPredicates.h) instead.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <functional>
#include <limits>
#include <vector>

namespace hrt
{
namespace reference
{

// A decision is called safe when every relative quantity that it hangs on is farther than this from
// the place where it turns. Plain doubles err by some 1e-14 in the scenes of the tests (corners and
// rays a few hundred times as far apart as a triangle is high): five digits are to spare.
constexpr double kSafeMargin = 1e-9;

struct SoupTriangle
{
  TriangleId id;
  std::size_t part;
  glm::dvec3 a, b, c; // relative to the snapshot's origin
};

struct SoupRay
{
  glm::dvec3 origin{ 0.0 };
  glm::dvec3 direction{ 0.0 };
  double tMaximum = std::numeric_limits<double>::infinity();
  TriangleId leaves = kNoTriangle; // the triangle the ray starts on
};

struct SoupHit
{
  const SoupTriangle* triangle = nullptr; // null: no hit
  double t = 0.0, u = 0.0, v = 0.0;
  bool safe = true; // no hit and no miss on the way was a matter of rounding
};

// What a primary ray sees, and what it may be said to see.
struct Sighting
{
  SoupHit hit;
  // Every answer that differs from the exact one only by the rounding of corners, ray and test;
  // sorted. kNoTriangle stands for "nothing". One entry: there is nothing to argue about.
  std::vector<TriangleId> admissible;
};

class TriangleSoup
{
public:
  explicit TriangleSoup(const Snapshot& snapshot);

  const std::vector<SoupTriangle>& triangles() const { return this->Triangles; }

  // Whether triangles of a part, seen from the front (by winding in the world) or the back, count.
  using Filter = std::function<bool(std::size_t part, bool front)>;

  // Nearest hit with 0 < t < tMaximum.
  SoupHit nearest(const SoupRay& ray, const Filter& counts) const;

  // All hits on the way in no order; the returned flag is SoupHit::safe.
  bool forEachHit(const SoupRay& ray, const Filter& counts,
    const std::function<void(const SoupHit&)>& found) const;

  // The nearest hit by exact arithmetic, whatever the cost, and the answers beside it. Hits for
  // which `between` is negative do not count; near zero it is a matter of rounding.
  Sighting look(const SoupRay& ray, const Filter& counts,
    const std::function<double(double t)>& between) const;

private:
  std::vector<SoupTriangle> Triangles;
  double Reach = 0.0; // largest coordinate
};

} // namespace reference
} // namespace hrt
