// A hierarchy over triangles: the triangles of one geometry, or those of many parts merged into
// common coordinates. The leaves of its tree (WideTree.h) are blocks of up to eight neighbouring
// triangles (TriangleBlock.h), whose possible hits the exact kernel decides.
#pragma once

#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/EmbreeSearch.h"
#include "Rendering/Core/Structures/TriangleBlock.h"
#include "Rendering/Core/Structures/WideTree.h"

#include <array>
#include <vector>

namespace hrt
{
namespace embree
{

// A triangle in the hierarchy's coordinates.
struct SourceTriangle
{
  std::array<glm::vec3, 3> corner;
  std::uint32_t member = 0;   // the part's number in the hierarchy
  std::uint32_t triangle = 0; // number in the part's geometry
};

class Hierarchy
{
public:
  // `positions`: the geometries' own, a triangle's corners each, where the hierarchy's coordinates
  // are others and their rounding has to be undone; else empty.
  Hierarchy(Device& device, const std::vector<SourceTriangle>& triangles,
    const std::vector<std::array<glm::vec3, 3>>& positions);
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;

  const WideTree& tree() const { return this->Tree; }
  const TriangleBlock& block(std::uint32_t i) const { return this->Blocks[i]; }
  std::uint32_t blockCount() const { return static_cast<std::uint32_t>(this->Blocks.size()); }
  const SieveSlack& slack() const { return this->Slack; }
  const TraversalBox& box() const { return this->Box; }
  const EntryBox& entry() const { return this->Entry; }

  // Moves the triangles of a hierarchy of one geometry to where another one of as many triangles has
  // them. False when it holds not all of them, or has become so much worse than it was when built,
  // that it is better built anew.
  bool refit(const Geometry& geometry);
  // The same for merged parts that have moved: `placements` map each member's own positions to the
  // hierarchy's coordinates.
  bool refit(const std::vector<glm::dmat4>& placements);

  // The exact test of the lanes of a block that the sieve has let pass. `nearest`: true when one of
  // them is the search's best hit now. `any`: true when one is hit by a shadow ray.
  bool nearest(
    std::uint32_t block, unsigned int lanes, const Member* members, Search& search) const;
  bool any(std::uint32_t block, SieveResult lanes, const Member* members, Search& search) const;

  const Member& memberOf(std::size_t block, int lane, const Member* members) const
  {
    return members[this->Members.empty() ? 0 : this->Members[block * TriangleBlock::kLanes + lane]];
  }
  ExactPositions positionsOf(std::size_t block, int lane) const
  {
    constexpr int n = TriangleBlock::kLanes;
    return this->OwnPositions.empty()
      ? ExactPositions{ &this->Blocks[block].corner[0][0][lane], 3 * n, n }
      : ExactPositions{ &this->OwnPositions[block * n + lane][0].x, 3, 1 };
  }

private:
  void setLane(std::size_t block, int lane, const std::array<glm::vec3, 3>& corner);
  void fit();
  bool isGoodEnough() const;
  bool test(std::size_t block, int lane, const Member& member, Search& search, Hit& hit) const;

  WideTree Tree;
  HugePageVector<TriangleBlock> Blocks;
  // kLanes a block, unless all triangles are of one member; and if they are not those of the
  // blocks.
  std::vector<std::uint32_t> Members;
  HugePageVector<std::array<glm::vec3, 3>> OwnPositions;
  TraversalBox Box;
  EntryBox Entry;
  SieveSlack Slack;
  double CostWhenBuilt = 0.0;
  bool Complete = true; // no triangle was left out
};

} // namespace embree
} // namespace hrt
