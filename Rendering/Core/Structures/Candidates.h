// Pairs of a ray and a triangle that the sieve has let pass for the rays of a packet, gathered
// until there are enough of them for the exact kernel to decide eight at once.
#pragma once

#include "Rendering/Core/Structures/EmbreeHierarchy.h"
#include "Rendering/Core/Structures/ExactLanes.h"

namespace hrt
{
namespace embree
{

class Candidates
{
public:
  // `wide`: as for the kernels. `rays`: bits of the searches that take part.
  Candidates(const Hierarchy& hierarchy, const Member* members, Search* searches, unsigned int rays,
    bool wide)
    : OfHierarchy(hierarchy)
    , Members(members)
    , Searches(searches)
    , Rays(rays)
    , Wide(wide)
  {
  }

  // False for a triangle that the ray is not to meet.
  bool add(std::uint32_t block, int lane, unsigned int ray)
  {
    const Member& member = this->OfHierarchy.memberOf(block, lane, this->Members);
    const TriangleId triangle =
      member.firstTriangle + this->OfHierarchy.block(block).triangle[lane];
    if (!member.visibleToRays || triangle == this->Searches[ray].ray->originTriangle)
    {
      return false;
    }
    this->Pairs[this->Count++] = { &member, triangle, block, lane, ray };
    return true;
  }

  bool enough() const { return this->Count >= ExactLanes::kLanes; }
  // As many more can be added when `enough` is false.
  static constexpr unsigned int kMostAtOnce = 16;

  // Decides the pairs eight by eight as long as there are at least so many. Bits of the searches
  // that have a new best hit.
  unsigned int decide(unsigned int least);

private:
  struct Pair
  {
    const Member* member;
    TriangleId triangle;
    std::uint32_t block;
    int lane;
    unsigned int ray;
  };

  bool alike(const Pair* pairs, unsigned int count);
  unsigned int decideSingly(const Pair& pair);
  unsigned int decideTogether(const Pair* pairs, unsigned int count);

  const Hierarchy& OfHierarchy;
  const Member* Members;
  Search* Searches;
  unsigned int Rays;
  bool Wide;
  int Longest = -1; // longest axis of all directions; -1: not known yet, 3: they differ
  unsigned int Count = 0;
  Pair Pairs[ExactLanes::kLanes + kMostAtOnce];
};

} // namespace embree
} // namespace hrt
