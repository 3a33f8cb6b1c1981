// Implements the hierarchy: clustering by Embree's generic builder, bounds, refitting, and the
// callbacks that meet a block. The callbacks exist twice, for the compiler's target and for AVX2;
// which one runs changes the time and nothing else.
#include "Rendering/Core/Structures/EmbreeHierarchy.h"

#include "Rendering/Core/Geometry/Coordinates.h"

#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hrt
{
namespace embree
{

namespace
{

constexpr int kLanes = TriangleBlock::kLanes;

// Far beyond what the builder's own cost allows; it splits evenly in the last levels before it, and
// fails when they do not suffice.
constexpr unsigned int kDeepest = 512;

bool testLane(const glm::vec3* positions, const Member& member, Search& search, Hit& hit)
{
  if (hit.triangle == search.ray.originTriangle)
  {
    return false;
  }
  if (!search.exact)
  {
    search.exact.emplace(search.ray.origin, search.ray.direction);
  }
  TriangleHit exact;
  const Corners corners = sceneCorners(positions, member.toScene);
  if (!search.exact->hitsTriangle(corners, search.ray.tMaximum, exact))
  {
    return false;
  }
  hit.t = exact.t;
  hit.u = exact.u;
  hit.v = exact.v;
  return true;
}

int takeLowest(unsigned int& mask)
{
  const int lowest = __builtin_ctz(mask);
  mask &= mask - 1;
  return lowest;
}

} // namespace

// What is asked of the lanes that have passed the sieve. Never inlined, to leave the registers to
// the sieve's loop and the exact arithmetic to the compiler's own target.
struct Hierarchy::Lanes
{
  const Hierarchy& self;
  std::size_t block;
  const Member* members;

  // The exact test of a lane whose triangle's number stands in the hit.
  bool test(int lane, const Member& member, Search& search, Hit& hit) const
  {
    if (!this->self.Positions.empty())
    {
      return testLane(
        this->self.Positions[this->block * kLanes + lane].data(), member, search, hit);
    }
    const TriangleBlock& triangles = this->self.Blocks[this->block];
    glm::vec3 positions[3];
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        positions[corner][axis] = triangles.corner[corner][axis][lane];
      }
    }
    return testLane(positions, member, search, hit);
  }

  // True when one of the lanes is the nearest hit now. The order of traversal must not show: of
  // equal hits the smallest number wins.
  HRT_NEVER_INLINE bool intersect(unsigned int possible, Search& search) const
  {
    const Source* const sources = this->self.Sources[this->block].data();
    bool nearer = false;
    while (possible != 0)
    {
      const int lane = takeLowest(possible);
      const Source source = sources[lane];
      if (source.member == kNoMember || !this->members[source.member].visibleToRays)
      {
        continue;
      }
      const Member& member = this->members[source.member];
      Hit hit, &best = search.best;
      hit.triangle = member.firstTriangle + source.triangle;
      if (this->test(lane, member, search, hit) &&
        (hit.t < best.t || (hit.t == best.t && hit.triangle < best.triangle)))
      {
        best = hit;
        nearer = true;
      }
    }
    return nearer;
  }

  HRT_NEVER_INLINE bool occlude(SieveResult lanes, Search& search) const
  {
    const Source* const sources = this->self.Sources[this->block].data();
    while (lanes.possible != 0)
    {
      const int lane = takeLowest(lanes.possible);
      const Source source = sources[lane];
      if (source.member == kNoMember || !this->members[source.member].castsShadow)
      {
        continue;
      }
      const Member& member = this->members[source.member];
      Hit hit;
      hit.triangle = member.firstTriangle + source.triangle;
      const bool sure = (lanes.sure >> lane & 1u) != 0 && hit.triangle != search.ray.originTriangle;
      if (sure || this->test(lane, member, search, hit))
      {
        return true;
      }
    }
    return false;
  }
};

namespace
{

float surfaceArea(const glm::vec3& lower, const glm::vec3& upper)
{
  const glm::vec3 d = upper - lower;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

struct Bounds
{
  glm::vec3 lower{ std::numeric_limits<float>::infinity() };
  glm::vec3 upper{ -std::numeric_limits<float>::infinity() };

  void include(const Bounds& o)
  {
    this->lower = glm::min(this->lower, o.lower);
    this->upper = glm::max(this->upper, o.upper);
  }
};

// Of the block's triangles; unused lanes repeat a used one.
Bounds boundsOfBlock(const TriangleBlock& block)
{
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int lane = 0; lane < kLanes; ++lane)
      {
        const float x = block.corner[corner][axis][lane];
        bounds.lower[axis] = std::min(bounds.lower[axis], x);
        bounds.upper[axis] = std::max(bounds.upper[axis], x);
      }
    }
  }
  return bounds;
}

} // namespace

struct BlockCallbacks
{
  // What is wanted of a block only when the sieve lets something pass comes on its way here.
  HRT_ALWAYS_INLINE static void fetchSources(const Hierarchy& self, unsigned int block)
  {
#if defined(__GNUC__)
    __builtin_prefetch(&self.Sources[block]);
#endif
  }

  HRT_ALWAYS_INLINE static void intersect(const RTCIntersectFunctionNArguments* arguments)
  {
    const Hierarchy& self = *static_cast<const Hierarchy*>(arguments->geometryUserPtr);
    const TriangleBlock& block = self.Blocks[arguments->primID];
    const Hierarchy::Lanes tests{ self, arguments->primID, queryOf(arguments).members };
    const unsigned int count = arguments->N;
    fetchSources(self, arguments->primID);
    for (unsigned int i = 0; i < count; ++i)
    {
      if (!arguments->valid[i])
      {
        continue;
      }
      const SieveRay ray = sieveRay(raysOf(arguments), count, i);
      const unsigned int lanes = sieve(block, ray, self.Slack).possible;
      if (lanes == 0)
      {
        continue;
      }
      const Passage& passage = passageOf(arguments, i);
      if (tests.intersect(lanes, *passage.search))
      {
        shorten(arguments, i, passage.end());
      }
    }
  }

  HRT_ALWAYS_INLINE static void occlude(const RTCOccludedFunctionNArguments* arguments)
  {
    const Hierarchy& self = *static_cast<const Hierarchy*>(arguments->geometryUserPtr);
    const TriangleBlock& block = self.Blocks[arguments->primID];
    const Hierarchy::Lanes tests{ self, arguments->primID, queryOf(arguments).members };
    const unsigned int count = arguments->N;
    fetchSources(self, arguments->primID);
    for (unsigned int i = 0; i < count; ++i)
    {
      if (!arguments->valid[i])
      {
        continue;
      }
      const SieveRay ray = sieveRay(raysOf(arguments), count, i);
      const SieveResult lanes = sieve(block, ray, self.Slack);
      if (lanes.possible == 0)
      {
        continue;
      }
      Search& search = *passageOf(arguments, i).search;
      if (tests.occlude(lanes, search))
      {
        search.found = true;
        finish(arguments, i);
      }
    }
  }
};

namespace
{

void intersectBlock(const RTCIntersectFunctionNArguments* arguments)
{
  BlockCallbacks::intersect(arguments);
}

void occludeBlock(const RTCOccludedFunctionNArguments* arguments)
{
  BlockCallbacks::occlude(arguments);
}

#if defined(__GNUC__) && defined(__x86_64__)
__attribute__((target("avx2,fma"))) void intersectBlockWide(
  const RTCIntersectFunctionNArguments* arguments)
{
  BlockCallbacks::intersect(arguments);
}

__attribute__((target("avx2,fma"))) void occludeBlockWide(
  const RTCOccludedFunctionNArguments* arguments)
{
  BlockCallbacks::occlude(arguments);
}
#else
constexpr RTCIntersectFunctionN intersectBlockWide = &intersectBlock;
constexpr RTCOccludedFunctionN occludeBlockWide = &occludeBlock;
#endif

} // namespace

// Clusters triangles by Embree's surface area heuristic, in a tree of which every leaf is a block.
struct Hierarchy::Builder
{
  struct Cluster
  {
    Cluster* child[2] = { nullptr, nullptr };
    std::uint32_t count = 0; // of a leaf's triangles
    std::uint32_t triangle[kLanes];
  };

  Hierarchy& Self;
  const std::vector<SourceTriangle>& Triangles;
  const std::vector<std::array<glm::vec3, 3>>& Positions;

  static void* createNode(RTCThreadLocalAllocator allocator, unsigned int, void*)
  {
    return new (rtcThreadLocalAlloc(allocator, sizeof(Cluster), alignof(Cluster))) Cluster;
  }
  static void setChildren(void* node, void** children, unsigned int count, void*)
  {
    for (unsigned int i = 0; i < count; ++i)
    {
      static_cast<Cluster*>(node)->child[i] = static_cast<Cluster*>(children[i]);
    }
  }
  static void setBounds(void*, const RTCBounds**, unsigned int, void*) {}
  static void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
    std::size_t count, void*)
  {
    Cluster* const leaf =
      new (rtcThreadLocalAlloc(allocator, sizeof(Cluster), alignof(Cluster))) Cluster;
    leaf->count = static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      leaf->triangle[i] = primitives[i].primID;
    }
    return leaf;
  }

  // Triangles that Embree cannot bin, not finite or beyond its largest coordinate, are left out. The
  // scene's door refuses them; a snapshot made otherwise must do no harm either.
  std::vector<RTCBuildPrimitive> primitives() const
  {
    std::vector<RTCBuildPrimitive> result;
    result.reserve(this->Triangles.size());
    for (std::size_t i = 0; i < this->Triangles.size(); ++i)
    {
      const std::array<glm::vec3, 3>& c = this->Triangles[i].corner;
      if (isAdmissible(c[0]) && isAdmissible(c[1]) && isAdmissible(c[2]))
      {
        const glm::vec3 lower = glm::min(c[0], glm::min(c[1], c[2]));
        const glm::vec3 upper = glm::max(c[0], glm::max(c[1], c[2]));
        result.push_back({ lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z,
          static_cast<unsigned int>(i) });
      }
    }
    return result;
  }

  void run(Device& device)
  {
    std::vector<RTCBuildPrimitive> boxes = this->primitives();
    if (boxes.empty())
    {
      return; // Embree would make a leaf of nothing
    }
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxDepth = kDeepest;
    arguments.sahBlockSize = kLanes;
    arguments.maxLeafSize = kLanes;
    const RTCBVH tree = rtcNewBVH(device.handle());
    arguments.bvh = tree;
    arguments.primitives = boxes.data();
    arguments.primitiveCount = boxes.size();
    arguments.primitiveArrayCapacity = boxes.size();
    arguments.createNode = &Builder::createNode;
    arguments.setNodeChildren = &Builder::setChildren;
    arguments.setNodeBounds = &Builder::setBounds;
    arguments.createLeaf = &Builder::createLeaf;
    const Cluster* const root = static_cast<const Cluster*>(rtcBuildBVH(&arguments));
    if (root)
    {
      this->take(*root);
    }
    rtcReleaseBVH(tree);
    device.check("clustering triangles");
  }

  std::uint32_t take(const Cluster& cluster)
  {
    if (cluster.count > 0)
    {
      return ~this->takeLeaf(cluster);
    }
    const std::uint32_t first = this->take(*cluster.child[0]);
    const std::uint32_t second = this->take(*cluster.child[1]);
    this->Self.Nodes.push_back({ { first, second } });
    return static_cast<std::uint32_t>(this->Self.Nodes.size() - 1);
  }

  std::uint32_t takeLeaf(const Cluster& leaf)
  {
    const std::size_t block = this->Self.Blocks.size();
    this->Self.Blocks.emplace_back();
    this->Self.Sources.emplace_back();
    for (int lane = 0; lane < kLanes; ++lane)
    {
      const bool used = std::uint32_t(lane) < leaf.count;
      const SourceTriangle& triangle = this->Triangles[leaf.triangle[used ? lane : 0]];
      this->Self.setLane(block, lane, triangle.corner);
      this->Self.Sources[block][lane] =
        used ? triangle.source : Source{ kNoMember, triangle.source.triangle };
      if (!this->Positions.empty())
      {
        this->Self.Positions.push_back(this->Positions[leaf.triangle[used ? lane : 0]]);
      }
    }
    return static_cast<std::uint32_t>(block);
  }
};

Hierarchy::Hierarchy(Device& device, const std::vector<SourceTriangle>& triangles,
  const std::vector<std::array<glm::vec3, 3>>& positions, Scene::Kind kind)
{
  for (const SourceTriangle& triangle : triangles)
  {
    for (const glm::vec3& corner : triangle.corner)
    {
      this->Box.include(corner);
    }
  }
  this->Entry = EntryBox(this->Box);
  this->Slack = SieveSlack(this->Box.reach());
  Builder{ *this, triangles, positions }.run(device);
  this->CostWhenBuilt = this->cost();
  UserGeometry primitives;
  primitives.data = this;
  primitives.count = this->Blocks.size();
  primitives.bounds = &Hierarchy::boundsOf;
  primitives.intersect = device.wide() ? &*intersectBlockWide : &intersectBlock;
  primitives.occluded = device.wide() ? &*occludeBlockWide : &occludeBlock;
  this->Tree = std::make_unique<Scene>(device, primitives, kind, "building a geometry's hierarchy");
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

bool Hierarchy::refit(Device& device, const std::vector<glm::vec3>& positions)
{
  this->Box = TraversalBox();
  for (const glm::vec3& position : positions)
  {
    this->Box.include(position);
  }
  this->Entry = EntryBox(this->Box);
  this->Slack = SieveSlack(this->Box.reach());
  for (std::size_t block = 0; block < this->Blocks.size(); ++block)
  {
    for (int lane = 0; lane < kLanes; ++lane)
    {
      const glm::vec3* const corner =
        &positions[3 * std::size_t(this->Sources[block][lane].triangle)];
      this->setLane(block, lane, { corner[0], corner[1], corner[2] });
    }
  }
  if (this->cost() > kWorstDecay * this->CostWhenBuilt)
  {
    return false;
  }
  this->Tree->refit(device);
  return true;
}

// How many nodes and blocks a ray that meets the root is expected to meet: the surface area
// heuristic's measure, on the tree of the clusters, which Embree's own resembles.
double Hierarchy::cost() const
{
  std::vector<Bounds> bounds(this->Nodes.size());
  const auto boundsOfChild = [&](std::uint32_t child)
  { return child < bounds.size() ? bounds[child] : boundsOfBlock(this->Blocks[~child]); };
  double areas = 0.0;
  for (std::size_t i = 0; i < this->Nodes.size(); ++i)
  {
    for (const std::uint32_t child : this->Nodes[i].child)
    {
      const Bounds box = boundsOfChild(child);
      areas += surfaceArea(box.lower, box.upper);
      bounds[i].include(box);
    }
  }
  const double root = bounds.empty() ? 0.0 : surfaceArea(bounds.back().lower, bounds.back().upper);
  return root > 0.0 ? areas / root : 1.0;
}

void Hierarchy::boundsOf(const RTCBoundsFunctionArguments* arguments)
{
  const Hierarchy& self = *static_cast<const Hierarchy*>(arguments->geometryUserPtr);
  const Bounds box = boundsOfBlock(self.Blocks[arguments->primID]);
  setBounds(*arguments->bounds_o, { box.lower, box.upper }, self.Box.padding());
}

} // namespace embree
} // namespace hrt
