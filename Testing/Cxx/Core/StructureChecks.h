// Rays that are hard to get right, and the comparison of a structure's answers with another's, bit
// by bit: for the tests of ray structures.
#pragma once

#include "Scenes.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace hrt
{
namespace checks
{

inline bool same(const Hit& a, const Hit& b)
{
  return a.triangle == b.triangle && a.t == b.t && a.u == b.u && a.v == b.v && a.shared == b.shared;
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
    ray.twinEnd = i % 2 ? 0.0f : static_cast<float>(random(0.0, 4.0));
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

// The kinds of rays that go through a structure together, each where a packet's bounds are tight.
enum class Together
{
  FromOnePoint,
  Parallel,
  AlongAnEdge,     // what decides is an edge function that is nearly zero
  FromATriangle,   // leaving it, as shadow and mirror rays do
  AtADiagonal,     // the longest components of the directions tie, or differ
  ToTheirTargets,  // ending there, as shadow rays do
  BeginningApart,  // far before one another
  Count
};

// Up to sixteen rays within `width` of each other; each leaves from some triangle now and then, or ends
// early.
inline std::vector<Ray> raysTogether(
  const Snapshot& s, scenes::Random& random, Together kind, int count, double width)
{
  const glm::dvec3 eye = random.below(4) ? random.inBox(3.0) : randomCorner(s, random);
  const glm::dvec3 target = randomCorner(s, random);
  const Corners c = cornersOf(s, static_cast<TriangleId>(random.below(s.triangleCount)));
  const TriangleId left = static_cast<TriangleId>(random.below(s.triangleCount));
  const Corners from = cornersOf(s, left);
  const double first = random(0.0, 1.0);
  glm::dvec3 diagonal(0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    diagonal[axis] = static_cast<double>(random.below(3)) - 1.0;
  }
  diagonal[random.below(3)] = 1.0;
  const double off = random.below(2) ? 1e-9 : 0.0; // of which single precision knows nothing
  std::vector<Ray> rays(count);
  for (Ray& ray : rays)
  {
    ray.origin = eye + random.inBox(width);
    ray.direction = target - eye;
    switch (kind)
    {
      case Together::FromOnePoint:
        ray.origin = eye;
        ray.direction += random.inBox(width);
        break;
      case Together::Parallel:
      case Together::Count:
        break;
      case Together::AlongAnEdge:
        ray.direction = glm::mix(c.a, c.b, first + random(0.0, width)) - ray.origin;
        break;
      case Together::FromATriangle:
        ray.origin = glm::mix(from.a, glm::mix(from.b, from.c, random(0.0, width)), first);
        ray.originTriangle = left;
        ray.twinEnd = random.below(2) ? 0.0f : std::numeric_limits<float>::max();
        break;
      case Together::AtADiagonal:
        ray.direction = diagonal + random.inBox(off);
        break;
      case Together::ToTheirTargets:
        ray.direction = target + random.inBox(width) - ray.origin;
        ray.tMaximum = 1.0;
        break;
      case Together::BeginningApart:
        ray.origin += random(-3.0, 3.0) * ray.direction;
        break;
    }
    if (random.below(5) == 0)
    {
      ray.tMaximum = random(0.0, 2.0);
    }
    if (random.below(6) == 0)
    {
      ray.originTriangle = static_cast<TriangleId>(random.below(s.triangleCount));
    }
  }
  return rays;
}

// The rays whose answers differ: single rays, streams of both orders, nearest hits, all hits, and
// occlusion.
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
    std::vector<Hit> all, expectedAll;
    structure.intersectAll(rays[i], all);
    reference.intersectAll(rays[i], expectedAll);
    const bool sameAll =
      std::equal(all.begin(), all.end(), expectedAll.begin(), expectedAll.end(), same);
    wrong += !sameAll || !same(structure.intersect(rays[i]), expected) ||
      !same(hits[0][i], expected) ||
      !same(hits[1][i], expected) || structure.occluded(rays[i]) != shadow ||
      (occluded[0][i] != 0) != shadow || (occluded[1][i] != 0) != shadow;
  }
  return wrong;
}

} // namespace checks
} // namespace hrt
