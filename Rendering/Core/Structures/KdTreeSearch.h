// A search through one placed kd-tree: the ray brought into the tree's coordinates, the tree's proposals,
// and what the nearest and any hit make of them.
#pragma once

#include "Rendering/Core/Structures/KdTreeInstance.h"
#include "Rendering/Core/Structures/KdTreeTraversal.h"

namespace hrt
{
namespace kdtree
{

// The true ray with its direction brought away from both ends of the numbers, so that no plane's time
// overflows. Powers of two change no digit.
struct ScaledRay
{
  glm::dvec3 origin, direction;
  double perT = 1.0; // of this ray's parameter

  explicit ScaledRay(const Ray& ray)
    : origin(ray.origin)
    , direction(ray.direction)
  {
    const double longest = largest(ray.direction);
    if (!(longest > 1e-100 && longest < 1e100))
    {
      const int exponent = std::ilogb(longest);
      for (int axis = 0; axis < 3; ++axis)
      {
        this->direction[axis] = std::scalbn(ray.direction[axis], -exponent);
      }
      this->perT = std::scalbn(1.0, std::min(exponent, 1023));
    }
  }
};

// Asks the exact kernel about a block's lane.
inline bool isHit(ExactSearch& search, const Instance& instance, const TriangleBlock& block, int lane)
{
  glm::vec3 positions[3];
  for (int corner = 0; corner < 3; ++corner)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      positions[corner][axis] = block.corner[corner][axis][lane];
    }
  }
  return search.test(instance.placed, block.triangle[lane], positions);
}

// Go through the lanes that may be hit and return the t up to which the search goes on; below zero ends it.
struct NearestTest
{
  ExactSearch& search;

  template <class Counters>
  double operator()(
    const Instance& instance, const TriangleBlock& block, const SieveResult& lanes, Counters& counters)
  {
    for (unsigned int left = lanes.possible; left != 0; left &= left - 1)
    {
      counters.candidate();
      isHit(this->search, instance, block, lowestBit(left));
    }
    return this->search.end();
  }
  bool done() const { return false; }
};

struct AnyTest
{
  ExactSearch& search;
  bool found = false;

  template <class Counters>
  double operator()(
    const Instance& instance, const TriangleBlock& block, const SieveResult& lanes, Counters& counters)
  {
    for (unsigned int left = lanes.possible; left != 0 && !this->found; left &= left - 1)
    {
      const int lane = lowestBit(left);
      if (lanes.sure >> lane & 1u)
      {
        this->found = !this->search.isOrigin(instance.placed, block.triangle[lane]);
        continue;
      }
      counters.candidate();
      this->found = isHit(this->search, instance, block, lane);
    }
    return this->found ? -1.0 : this->search.end();
  }
  bool done() const { return this->found; }
};

// For rays and placements whose numbers KdRay cannot bound: every triangle is asked.
template <class Candidates, class Counters>
void askAll(const KdTree& tree, Candidates&& candidates, Counters& counters)
{
  for (const TriangleBlock& block : tree.blocks())
  {
    SieveResult all;
    all.possible = (1u << TriangleBlock::kLanes) - 1;
    counters.blockTest();
    if (candidates(block, all) < 0.0)
    {
      return;
    }
  }
}

template <class Candidates, class Counters>
void traverse(const KdRay& ray, const KdTree& tree, double end, const Candidates& candidates,
  Counters& counters)
{
  ray.traverse(tree, end, candidates, counters);
}

// The same compiled for wider vectors. The exact kernel, a unit of its own, stays what it is.
#if defined(__GNUC__) && defined(__x86_64__)
template <class Candidates, class Counters>
__attribute__((target("avx2,fma"))) void traverseWide(const KdRay& ray, const KdTree& tree,
  double end, const Candidates& candidates, Counters& counters)
{
  ray.traverse(tree, end, candidates, counters);
}
inline bool hasWideVectors()
{
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}
#else
template <class Candidates, class Counters>
void traverseWide(const KdRay& ray, const KdTree& tree, double end, const Candidates& candidates,
  Counters& counters)
{
  traverse(ray, tree, end, candidates, counters);
}
inline bool hasWideVectors()
{
  return false;
}
#endif

// Hands every lane that the ray may hit to the test.
template <class Test, class Counters>
void searchInstance(const Instance& instance, const ScaledRay& ray, double originReach,
  const ExactSearch& search, Test& test, Counters& counters, bool wide = hasWideVectors())
{
  const KdTree& tree = *instance.triangles->tree;
  const double end = search.end() * ray.perT;
  const auto candidates = [&](const TriangleBlock& block, const SieveResult& lanes) {
    return test(instance, block, lanes, counters) * ray.perT;
  };
  const glm::dvec3 translation(instance.placed.toScene[3]);
  KdRay lower;
  switch (lower.enter(tree, instance.inverse * (ray.origin - translation),
    instance.inverse * ray.direction, end, instance.slack(originReach),
    static_cast<double>(search.ray().twinEnd) * ray.perT))
  {
    case KdRay::Entry::Missed:
      return;
    case KdRay::Entry::Unbounded:
      askAll(tree, candidates, counters);
      return;
    case KdRay::Entry::Entered:
      break;
  }
  if (wide)
  {
    traverseWide(lower, tree, end, candidates, counters);
    return;
  }
  traverse(lower, tree, end, candidates, counters);
}

} // namespace kdtree
} // namespace hrt
