// Implements the hierarchy: building, refitting, and the exact test of what its blocks propose.
#include "Rendering/Core/Structures/BvhHierarchy.h"

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace bvh
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

// By the exact kernel's own arithmetic, then rounded.
std::array<glm::vec3, 3> placedCorners(
  const Geometry& geometry, const glm::dmat4& placement, std::size_t triangle)
{
  const Corners c = sceneCorners(geometry, placement, triangle);
  return { glm::vec3(c.a), glm::vec3(c.b), glm::vec3(c.c) };
}

// The triangles of all members, numbered one after the other.
class AllTriangles
{
public:
  explicit AllTriangles(const std::vector<MemberMesh>& members)
    : Members(members)
  {
    std::size_t first = 0;
    for (const MemberMesh& member : members)
    {
      this->First.push_back(first);
      first += member.geometry->triangleCount();
    }
    this->Count = first;
  }

  std::size_t size() const { return this->Count; }

  struct Place
  {
    std::uint32_t member, triangle;
  };
  Place placeOf(std::size_t number) const
  {
    const auto next = std::upper_bound(this->First.begin(), this->First.end(), number);
    const auto member = static_cast<std::size_t>(next - this->First.begin()) - 1;
    return { static_cast<std::uint32_t>(member),
      static_cast<std::uint32_t>(number - this->First[member]) };
  }
  std::array<glm::vec3, 3> cornersOf(const Place& place) const
  {
    return this->Members[place.member].cornersOf(place.triangle);
  }

  // Triangles that cannot be binned, not finite or beyond the largest coordinate, are left out. The
  // scene's door refuses them; a snapshot made otherwise must do no harm either.
  std::vector<RTCBuildPrimitive> boxes() const
  {
    std::vector<RTCBuildPrimitive> boxes;
    boxes.reserve(this->Count);
    for (std::size_t i = 0; i < this->Members.size(); ++i)
    {
      for (std::size_t k = 0; k < this->Members[i].geometry->triangleCount(); ++k)
      {
        const std::array<glm::vec3, 3> c = this->Members[i].cornersOf(k);
        if (isAdmissible(c))
        {
          const glm::vec3 lower = glm::min(c[0], glm::min(c[1], c[2]));
          const glm::vec3 upper = glm::max(c[0], glm::max(c[1], c[2]));
          boxes.push_back({ lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z,
            static_cast<unsigned int>(this->First[i] + k) });
        }
      }
    }
    return boxes;
  }

private:
  const std::vector<MemberMesh>& Members;
  std::vector<std::size_t> First; // of each member
  std::size_t Count = 0;
};

} // namespace

std::array<glm::vec3, 3> MemberMesh::cornersOf(std::size_t triangle) const
{
  return this->placement ? placedCorners(*this->geometry, *this->placement, triangle)
                         : this->geometry->cornerPositions(triangle);
}

Hierarchy::Hierarchy(Device& device, const std::vector<MemberMesh>& members)
{
  const AllTriangles triangles(members);
  std::vector<WideTree::Leaf> leaves;
  {
    std::vector<RTCBuildPrimitive> boxes = triangles.boxes();
    this->Complete = boxes.size() == triangles.size();
    leaves = this->Tree.build(device, boxes, kLanes, "building a geometry's hierarchy");
  }
  this->Blocks.resize(leaves.size());
  if (members.size() > 1)
  {
    this->Members.resize(leaves.size() * kLanes);
  }
  const bool placed = !members.empty() && members.front().placement;
  if (placed)
  {
    this->Corners.resize(leaves.size() * kLanes);
  }
  for (std::size_t block = 0; block < leaves.size(); ++block)
  {
    const WideTree::Leaf& leaf = leaves[block];
    for (std::uint32_t lane = 0; lane < kLanes; ++lane)
    {
      const bool used = lane < leaf.count;
      const AllTriangles::Place place = triangles.placeOf(leaf.box[used ? lane : 0]);
      this->setLane(block, static_cast<int>(lane), triangles.cornersOf(place));
      this->Blocks[block].triangle[lane] = used ? place.triangle : kNoTriangle;
      if (placed)
      {
        this->Corners[block * kLanes + lane] =
          members[place.member].geometry->triangles[place.triangle];
      }
      if (!this->Members.empty())
      {
        this->Members[block * kLanes + lane] = place.member;
      }
    }
  }
  for (const MemberMesh& member : members)
  {
    if (placed)
    {
      this->Placed.push_back(member.geometry);
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

// Calls visit(block, lane, triangle) for every lane; an unused one repeats the first of its block.
template <class Visit>
void Hierarchy::forEachLane(Visit visit) const
{
  for (std::size_t block = 0; block < this->Blocks.size(); ++block)
  {
    const auto& triangle = this->Blocks[block].triangle;
    for (int lane = 0; lane < kLanes; ++lane)
    {
      visit(block, lane, triangle[triangle[lane] != kNoTriangle ? lane : 0]);
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
  this->forEachLane([&](std::size_t block, int lane, std::uint32_t triangle)
    { this->setLane(block, lane, geometry.cornerPositions(triangle)); });
  this->fit();
  return this->isGoodEnough();
}

bool Hierarchy::refit(const std::vector<glm::dmat4>& placements)
{
  if (!this->Complete || this->Placed.empty())
  {
    return false;
  }
  bool admissible = true;
  this->forEachLane(
    [&](std::size_t block, int lane, std::uint32_t triangle)
    {
      const std::uint32_t member = this->memberNumber(block, lane);
      const std::array<glm::vec3, 3> corner =
        placedCorners(*this->Placed[member], placements[member], triangle);
      admissible = admissible && isAdmissible(corner);
      this->setLane(block, lane, corner);
    });
  if (!admissible)
  {
    return false;
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

} // namespace bvh
} // namespace hrt
