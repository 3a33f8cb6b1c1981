// Rays that are hard to get right, and the comparison of a structure's answers with another's, bit
// by bit: for the tests of ray structures.
#pragma once

#include "Scenes.h"

#include <algorithm>
#include <vector>

namespace hrt
{
namespace checks
{

inline bool same(const Hit& a, const Hit& b)
{
  return a.triangle == b.triangle && a.t == b.t && a.u == b.u && a.v == b.v;
}

inline Corners cornersOf(const Snapshot& s, TriangleId id)
{
  const Part& part = s.parts[s.partOf(id)];
  return sceneCorners(*part.geometry, positionsToScene(part, s.origin), id - part.firstTriangle);
}

// A vertex, or the middle of an edge.
inline glm::dvec3 randomCorner(const Snapshot& s, scenes::Random& random)
{
  const Corners c = cornersOf(s, static_cast<TriangleId>(random.below(s.triangleCount)));
  return random.below(2) ? c.a : 0.5 * (c.a + c.b);
}

// Half of the rays at random, half at vertices and edges, where single precision fails; some that
// end early and some that leave from a triangle.
inline Ray randomRay(const Snapshot& s, scenes::Random& random, int i, double half = 3.0)
{
  Ray ray;
  ray.origin = random.inBox(half);
  ray.direction =
    i % 2 && s.triangleCount > 0 ? randomCorner(s, random) - ray.origin : random.direction();
  if (i % 3 == 0)
  {
    ray.tMaximum = random(0.0, 4.0);
  }
  if (i % 5 == 0 && s.triangleCount > 0)
  {
    ray.originTriangle = static_cast<TriangleId>(random.below(s.triangleCount));
  }
  return ray;
}

inline std::vector<Ray> randomRays(
  const Snapshot& s, scenes::Random& random, int count, double half = 3.0)
{
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i)
  {
    rays.push_back(randomRay(s, random, i, half));
  }
  return rays;
}

// Neighbouring rays from one eye at random points of the scene, as a packet likes them.
inline std::vector<Ray> raysFromOnePoint(const Snapshot& s, scenes::Random& random, int count)
{
  std::vector<Ray> rays(count);
  const glm::dvec3 eye = random.inBox(4.0), target = randomCorner(s, random);
  for (Ray& ray : rays)
  {
    ray.origin = eye;
    ray.direction =
      random.below(3) ? target + random.inBox(0.05) - eye : randomCorner(s, random) - eye;
  }
  return rays;
}

// The rays whose answers differ: single rays, streams of both orders, hits and occlusion.
inline int wrongAnswers(
  const Structure& structure, const Structure& reference, const std::vector<Ray>& rays)
{
  int wrong = 0;
  std::vector<Hit> hits[2];
  std::vector<std::uint8_t> occluded[2];
  for (int order = 0; order < 2; ++order)
  {
    hits[order].resize(rays.size());
    occluded[order].resize(rays.size());
    structure.intersect(rays.data(), hits[order].data(), rays.size(), RayOrder(order));
    structure.occluded(rays.data(), occluded[order].data(), rays.size(), RayOrder(order));
  }
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    const Hit expected = reference.intersect(rays[i]);
    const bool shadow = reference.occluded(rays[i]);
    wrong += !same(structure.intersect(rays[i]), expected) || !same(hits[0][i], expected) ||
      !same(hits[1][i], expected) || structure.occluded(rays[i]) != shadow ||
      (occluded[0][i] != 0) != shadow || (occluded[1][i] != 0) != shadow;
  }
  return wrong;
}

} // namespace checks
} // namespace hrt
