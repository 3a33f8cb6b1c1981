// Implements the hierarchy: building, refitting, and the exact test of what its blocks propose.
#include "Rendering/Core/Structures/EmbreeHierarchy.h"

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace embree
{

namespace
{

constexpr int kLanes = TriangleBlock::kLanes;
static_assert(WideTree::kMostInLeaf == kLanes, "a leaf is a block");

int takeLowest(unsigned int& mask)
{
  const int lowest = __builtin_ctz(mask);
  mask &= mask - 1;
  return lowest;
}

// Of the block's triangles; unused lanes repeat a used one.
TraversalBox boundsOfBlock(const TriangleBlock& block)
{
  TraversalBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    float lower = block.corner[0][axis][0], upper = lower;
    for (const auto& corner : block.corner)
    {
      lower = std::min(lower, *std::min_element(corner[axis], corner[axis] + kLanes));
      upper = std::max(upper, *std::max_element(corner[axis], corner[axis] + kLanes));
    }
    box.lower[axis] = lower;
    box.upper[axis] = upper;
  }
  return box;
}

bool isAdmissible(const std::array<glm::vec3, 3>& c)
{
  return hrt::isAdmissible(c[0]) && hrt::isAdmissible(c[1]) && hrt::isAdmissible(c[2]);
}

// Triangles that cannot be binned, not finite or beyond the largest coordinate, are left out. The
// scene's door refuses them; a snapshot made otherwise must do no harm either.
std::vector<RTCBuildPrimitive> boxesOf(const std::vector<SourceTriangle>& triangles)
{
  std::vector<RTCBuildPrimitive> boxes;
  boxes.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const std::array<glm::vec3, 3>& c = triangles[i].corner;
    if (isAdmissible(c))
    {
      const glm::vec3 lower = glm::min(c[0], glm::min(c[1], c[2]));
      const glm::vec3 upper = glm::max(c[0], glm::max(c[1], c[2]));
      boxes.push_back(
        { lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, static_cast<unsigned int>(i) });
    }
  }
  return boxes;
}

} // namespace

Hierarchy::Hierarchy(Device& device, const std::vector<SourceTriangle>& triangles,
  const std::vector<std::array<glm::vec3, 3>>& positions)
{
  std::vector<RTCBuildPrimitive> boxes = boxesOf(triangles);
  this->Complete = boxes.size() == triangles.size();
  const std::vector<WideTree::Leaf> leaves =
    this->Tree.build(device, boxes, kLanes, "building a geometry's hierarchy");
  this->Blocks.resize(leaves.size());
  const bool severalMembers = std::any_of(triangles.begin(), triangles.end(),
    [](const SourceTriangle& triangle) { return triangle.member != 0; });
  for (std::size_t block = 0; block < leaves.size(); ++block)
  {
    const WideTree::Leaf& leaf = leaves[block];
    for (std::uint32_t lane = 0; lane < kLanes; ++lane)
    {
      const bool used = lane < leaf.count;
      const std::uint32_t number = leaf.box[used ? lane : 0];
      const SourceTriangle& triangle = triangles[number];
      this->setLane(block, static_cast<int>(lane), triangle.corner);
      this->Blocks[block].triangle[lane] = used ? triangle.triangle : kNoTriangle;
      if (severalMembers)
      {
        this->Members.push_back(triangle.member);
      }
      if (!positions.empty())
      {
        this->OwnPositions.push_back(positions[number]);
      }
    }
  }
  this->fit();
  this->CostWhenBuilt = this->Tree.cost();
}

void Hierarchy::setLane(std::size_t block, int lane, const std::array<glm::vec3, 3>& corner)
{
  for (int i = 0; i < 3; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Blocks[block].corner[i][axis][lane] = corner[i][axis];
    }
  }
}

// Everything that follows from the corners.
void Hierarchy::fit()
{
  std::vector<TraversalBox> boxes(this->Blocks.size());
  this->Box = TraversalBox();
  for (std::size_t block = 0; block < boxes.size(); ++block)
  {
    boxes[block] = boundsOfBlock(this->Blocks[block]);
    this->Box.include(boxes[block].lower);
    this->Box.include(boxes[block].upper);
  }
  this->Entry = EntryBox(this->Box);
  this->Slack = SieveSlack(this->Box.reach());
  this->Tree.fit(this->Box.padding(), [&](std::uint32_t block) { return boxes[block]; });
}

bool Hierarchy::refit(const Geometry& geometry)
{
  if (!this->Complete ||
    !std::all_of(geometry.positions.begin(), geometry.positions.end(),
      [](const glm::vec3& position) { return hrt::isAdmissible(position); }))
  {
    return false;
  }
  for (std::size_t block = 0; block < this->Blocks.size(); ++block)
  {
    for (int lane = 0; lane < kLanes; ++lane)
    {
      const auto& triangle = this->Blocks[block].triangle;
      const bool used = triangle[lane] != kNoTriangle;
      this->setLane(block, lane, geometry.cornerPositions(triangle[used ? lane : 0]));
    }
  }
  this->fit();
  return this->isGoodEnough();
}

bool Hierarchy::refit(const std::vector<glm::dmat4>& placements)
{
  if (!this->Complete || this->OwnPositions.empty())
  {
    return false;
  }
  for (std::size_t i = 0; i < this->OwnPositions.size(); ++i)
  {
    const std::uint32_t member = this->Members.empty() ? 0 : this->Members[i];
    const Corners c = sceneCorners(this->OwnPositions[i].data(), placements[member]);
    const std::array<glm::vec3, 3> corner{ glm::vec3(c.a), glm::vec3(c.b), glm::vec3(c.c) };
    if (!isAdmissible(corner))
    {
      return false;
    }
    this->setLane(i / kLanes, static_cast<int>(i % kLanes), corner);
  }
  this->fit();
  return this->isGoodEnough();
}

bool Hierarchy::isGoodEnough() const
{
  return this->Tree.cost() <= kWorstDecay * this->CostWhenBuilt;
}

// For a lane whose triangle's number stands in the hit.
bool Hierarchy::test(
  std::size_t block, int lane, const Member& member, Search& search, Hit& hit) const
{
  if (hit.triangle == search.ray->originTriangle)
  {
    return false;
  }
  if (search.shear.longest < 0)
  {
    search.shear = ExactShear(search.ray->direction);
    search.window = search.surfaces->windowOf(search.ray->direction);
  }
  TriangleHit exact;
  if (!exactHit(search.shear, search.ray->origin, search.ray->tMaximum,
        this->positionsOf(block, lane), member.toScene, exact) ||
    search.ray->passesOver(hit.triangle, exact.t, *search.surfaces))
  {
    return false;
  }
  hit.t = exact.t;
  hit.u = exact.u;
  hit.v = exact.v;
  return true;
}

bool Hierarchy::nearest(
  std::uint32_t block, unsigned int lanes, const Member* members, Search& search) const
{
  bool nearer = false;
  while (lanes != 0)
  {
    const int lane = takeLowest(lanes);
    const std::uint32_t triangle = this->Blocks[block].triangle[lane];
    const Member& member = this->memberOf(block, lane, members);
    if (triangle == kNoTriangle || !member.visibleToRays)
    {
      continue;
    }
    Hit hit;
    hit.triangle = member.firstTriangle + triangle;
    if (!this->test(block, lane, member, search, hit))
    {
      continue;
    }
    if (search.all)
    {
      search.all->push_back(hit);
    }
    else
    {
      nearer = search.best.offer(hit.triangle, hit.t, hit.u, hit.v, search.window) || nearer;
    }
  }
  return nearer;
}

bool Hierarchy::any(
  std::uint32_t block, SieveResult lanes, const Member* members, Search& search) const
{
  while (lanes.possible != 0)
  {
    const int lane = takeLowest(lanes.possible);
    const std::uint32_t triangle = this->Blocks[block].triangle[lane];
    const Member& member = this->memberOf(block, lane, members);
    if (triangle == kNoTriangle || !member.castsShadow)
    {
      continue;
    }
    Hit hit;
    hit.triangle = member.firstTriangle + triangle;
    const bool sure = (lanes.sure >> lane & 1u) != 0 && hit.triangle != search.ray->originTriangle;
    if (sure || this->test(block, lane, member, search, hit))
    {
      return true;
    }
  }
  return false;
}

} // namespace embree
} // namespace hrt
