// A hierarchy over triangles: the triangles of one geometry, or those of many parts merged into
// common coordinates. The leaves of its tree (WideTree.h) are blocks of up to eight neighbouring
// triangles (TriangleBlock.h), whose possible hits the exact kernel decides.
#pragma once

#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/BvhSearch.h"
#include "Rendering/Core/Structures/TriangleBlock.h"
#include "Rendering/Core/Structures/WideTree.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace hrt
{
namespace bvh
{

// What a hierarchy is made from: a geometry in its own coordinates, or in those to which the placement
// takes its positions.
struct MemberMesh
{
  std::shared_ptr<const Geometry> geometry;
  std::optional<glm::dmat4> placement;

  std::array<glm::vec3, 3> cornersOf(std::size_t triangle) const;
};

class Hierarchy
{
public:
  // Either of one geometry that is not placed, of which nothing is kept, or of placed ones, which are
  // kept: the exact test asks for their positions, which the placement has rounded.
  Hierarchy(Device& device, const std::vector<MemberMesh>& members);
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
    return members[this->memberNumber(block, lane)];
  }
  // Of a lane in use.
  ExactPositions positionsOf(std::size_t block, int lane) const
  {
    const TriangleBlock& of = this->Blocks[block];
    if (this->Placed.empty())
    {
      return { { &of.corner[0][0][lane], &of.corner[1][0][lane], &of.corner[2][0][lane] },
        TriangleBlock::kLanes };
    }
    const Geometry& mesh = *this->Placed[this->memberNumber(block, lane)];
    const std::array<std::uint32_t, 3>& v =
      this->Corners[block * TriangleBlock::kLanes + static_cast<std::size_t>(lane)];
    return { { &mesh.positions[v[0]].x, &mesh.positions[v[1]].x, &mesh.positions[v[2]].x }, 1 };
  }

private:
  std::uint32_t memberNumber(std::size_t block, int lane) const
  {
    return this->Members.empty() ? 0 : this->Members[block * TriangleBlock::kLanes + lane];
  }
  template <class Visit>
  void forEachLane(Visit visit) const;
  void setLane(std::size_t block, int lane, const std::array<glm::vec3, 3>& corner);
  void fit();
  bool isGoodEnough() const;
  bool test(std::size_t block, int lane, const Member& member, Search& search, Hit& hit) const;

  WideTree Tree;
  HugePageVector<TriangleBlock> Blocks;
  std::vector<std::uint32_t> Members; // kLanes a block, unless all triangles are of one member
  std::vector<std::shared_ptr<const Geometry>> Placed; // by member; none if it is not placed
  // Of a lane of a placed one its triangle's vertices: near each other here as they are in space, they
  // are fetched in half the time that the mesh' own list takes.
  std::vector<std::array<std::uint32_t, 3>> Corners;
  TraversalBox Box;
  EntryBox Entry;
  SieveSlack Slack;
  double CostWhenBuilt = 0.0;
  bool Complete = true; // no triangle was left out
};

} // namespace bvh
} // namespace hrt
