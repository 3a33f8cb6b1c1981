// Implements the gathering of pairs for the exact kernel.
#include "Rendering/Core/Structures/Candidates.h"

#include <algorithm>

namespace hrt
{
namespace embree
{

unsigned int Candidates::decide(unsigned int least)
{
  unsigned int changed = 0, first = 0;
  for (; first < this->Count && this->Count - first >= least; first += ExactLanes::kLanes)
  {
    const unsigned int count = std::min(ExactLanes::kLanes, this->Count - first);
    const Pair* const pairs = this->Pairs + first;
    if (this->alike(pairs, count))
    {
      changed |= this->decideTogether(pairs, count);
      continue;
    }
    for (unsigned int i = 0; i < count; ++i)
    {
      changed |= this->decideSingly(pairs[i]);
    }
  }
  first = std::min(first, this->Count);
  std::copy(this->Pairs + first, this->Pairs + this->Count, this->Pairs);
  this->Count -= first;
  return changed;
}

// Whether one matrix and one axis serve them all, and there are enough to be worth it.
bool Candidates::alike(const Pair* pairs, unsigned int count)
{
  if (this->Longest < 0)
  {
    this->Longest =
      ExactShear::longestAxis(this->Searches[__builtin_ctz(this->Rays)].ray->direction);
    for (unsigned int rest = this->Rays; rest != 0; rest &= rest - 1)
    {
      const Ray& ray = *this->Searches[__builtin_ctz(rest)].ray;
      this->Longest = ExactShear::longestAxis(ray.direction) == this->Longest ? this->Longest : 3;
    }
  }
  return this->Longest < 3 && count > 2 &&
    std::all_of(
      pairs, pairs + count, [pairs](const Pair& pair) { return pair.member == pairs[0].member; });
}

unsigned int Candidates::decideSingly(const Pair& pair)
{
  return this->OfHierarchy.nearest(
           pair.block, 1u << pair.lane, this->Members, this->Searches[pair.ray])
    ? 1u << pair.ray
    : 0u;
}

unsigned int Candidates::decideTogether(const Pair* pairs, unsigned int count)
{
  ExactLanes lanes;
  for (unsigned int i = 0; i < ExactLanes::kLanes; ++i)
  {
    const Pair& pair = pairs[i < count ? i : 0];
    const Ray& ray = *this->Searches[pair.ray].ray;
    const ExactPositions position = this->OfHierarchy.positionsOf(pair.block, pair.lane);
    for (int axis = 0; axis < 3; ++axis)
    {
      lanes.origin[axis][i] = ray.origin[axis];
      lanes.direction[axis][i] = ray.direction[axis];
      for (int corner = 0; corner < 3; ++corner)
      {
        lanes.position[corner][axis][i] = position(corner, axis);
      }
    }
    lanes.last[i] = ray.tMaximum;
  }
  unsigned int changed = 0;
  unsigned int hits = lanes.hit(pairs[0].member->toScene, this->Longest, this->Wide);
  for (hits &= (1u << count) - 1u; hits != 0; hits &= hits - 1)
  {
    const int i = __builtin_ctz(hits);
    const Pair& pair = pairs[i];
    const Hit hit = { pair.triangle, lanes.t[i], lanes.u[i], lanes.v[i] };
    changed |= this->Searches[pair.ray].offer(hit) ? 1u << pair.ray : 0u;
  }
  return changed;
}

} // namespace embree
} // namespace hrt
