// Sixteen neighbouring rays together. Their hull, a frustum, goes down the tree in place of them,
// at the cost of one ray; in the leaves it picks the triangles, each of which the sieve then tests
// against eight rays at once. Rays that do not lie together, by direction or by width, are divided
// and in the end go singly. Included by EmbreeKernels.inl.

#include "Rendering/Core/Structures/EmbreeFrustum.inl"

// --- Triangles
// --------------------------------------------------------------------------------------

template <bool kAny>
struct PacketTriangles
{
  const Hierarchy& hierarchy;
  const Member* const members;
  Search* const searches;
  PacketEntry& entry;
  Frustum& frustum;
  Candidates candidates;
  SieveRay sieveRays[kPacket / kLanes];

  HRT_LANES PacketTriangles(
    const Hierarchy& h, const Member* m, Search* s, PacketEntry& e, Frustum& f)
    : hierarchy(h)
    , members(m)
    , searches(s)
    , entry(e)
    , frustum(f)
    , candidates(h, m, s, f.rays, HRT_AVX2)
  {
    const Floats forward = all(f.forward);
    for (unsigned int half = 0; half < kPacket; half += kLanes)
    {
      this->sieveRays[half / kLanes] = { load(e.origin[f.x].of + half),
        load(e.origin[f.y].of + half), load(e.origin[f.z].of + half) * forward,
        load(e.direction[f.x].of + half), load(e.direction[f.y].of + half), forward };
    }
  }

  HRT_LANES void fetch(std::uint32_t child) const { fetchFrom(this->hierarchy, child); }

  HRT_LANES float operator()(std::uint32_t number, float end)
  {
    const TriangleBlock& block = this->hierarchy.block(number);
    Floats lower[3], upper[3], start;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Floats a = load(block.corner[0][axis]), b = load(block.corner[1][axis]),
                   c = load(block.corner[2][axis]);
      lower[axis] = least(a, least(b, c));
      upper[axis] = most(a, most(b, c));
    }
    bool shorter = false;
    unsigned int met = this->frustum.meet(lower, upper, all(end), start);
    for (; met != 0; met &= met - 1)
    {
      const int lane = lowest(met);
      if (block.triangle[lane] != kNoTriangle)
      {
        shorter = this->test(number, block, lane) || shorter;
      }
    }
    return !shorter ? end : (this->frustum.rays == 0 ? -1.0f : this->frustum.end(this->entry));
  }

  HRT_LANES bool decide(unsigned int least)
  {
    const unsigned int nearer = this->candidates.decide(least);
    for (unsigned int rest = nearer; rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      this->entry.end.of[i] =
        std::min(this->entry.end.of[i], this->entry.endOf(i, this->searches[i].best.t));
    }
    return nearer != 0;
  }

private:
  HRT_LANES SieveCorner corner(const TriangleBlock& block, int i, int lane) const
  {
    return { all(block.corner[i][this->frustum.x][lane]),
      all(block.corner[i][this->frustum.y][lane]), all(block.corner[i][this->frustum.z][lane]) };
  }

  // Whether some ray's search ends earlier now.
  HRT_LANES bool test(std::uint32_t number, const TriangleBlock& block, int lane)
  {
    const SieveCorner a = this->corner(block, 0, lane), b = this->corner(block, 1, lane),
                      c = this->corner(block, 2, lane);
    SieveResult met;
    PerRay<float> farthest;
    for (unsigned int half = 0; half < kPacket; half += kLanes)
    {
      const Sieved sieved(a, b, c, this->sieveRays[half / kLanes], this->hierarchy.slack());
      const Floats end = load(this->entry.end.of + half);
      if (const unsigned int possible = sieved.possible(end))
      {
        met.possible |= possible << half;
        met.sure |= sieved.sure(end) << half;
        store(farthest.of + half, sieved.farthest);
      }
    }
    met.possible &= this->frustum.rays;
    return met.possible != 0 &&
      (kAny ? this->occlude(number, lane, met) : this->intersect(number, lane, met, farthest));
  }

  HRT_LANES bool occlude(std::uint32_t number, int lane, const SieveResult& met)
  {
    unsigned int found = 0;
    for (unsigned int rest = met.possible; rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      const SieveResult one = { 1u << lane, (met.sure >> i & 1u) << lane };
      this->searches[i].found = this->hierarchy.any(number, one, this->members, this->searches[i]);
      found |= this->searches[i].found ? 1u << i : 0u;
    }
    if (found != 0)
    {
      this->frustum.keep(this->frustum.rays & ~found);
    }
    return found != 0;
  }

  // A triangle that is surely hit ends the search at its farthest corner, even before the exact
  // kernel has said where the hit is.
  HRT_LANES bool intersect(
    std::uint32_t number, int lane, const SieveResult& met, const PerRay<float>& farthest)
  {
    bool shorter = false;
    for (unsigned int rest = met.possible; rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      if (this->candidates.add(number, lane, static_cast<unsigned int>(i)) &&
        (met.sure >> i & 1u) != 0)
      {
        const float end =
          (farthest.of[i] + 2.0f * this->hierarchy.slack().depth) * (1.0f + 0x1p-22f);
        shorter = shorter || end < this->entry.end.of[i];
        this->entry.end.of[i] = std::min(this->entry.end.of[i], end);
      }
    }
    if (this->candidates.enough())
    {
      shorter = this->decide(ExactLanes::kLanes) || shorter;
    }
    return shorter;
  }
};

// With this many rays or fewer a packet is slower than single rays.
constexpr int kFewRays = 2;
// So is one whose hull is wider than this share of the tree's reach: it meets too much that none of
// its rays meets. Measured; between a half and double of it nothing changes much.
constexpr float kWidest = 1.0f / 16.0f;

// Traces the rays that enter a tree: `packet(frustum)` all of them, if they lie together, else
// `packet(i)` one after the other.
template <class Packet>
HRT_TARGET void traceTogether(const PacketEntry& entry, const TraversalBox& box, Packet& packet)
{
  Frustum frustum;
  if (__builtin_popcount(entry.active) > kFewRays && frustum.enclose(entry, box) &&
    frustum.width <= kWidest * static_cast<float>(box.reach()))
  {
    packet(frustum);
    return;
  }
  for (unsigned int rest = entry.active; rest != 0; rest &= rest - 1)
  {
    packet(lowest(rest));
  }
}

template <bool kAny>
struct PartPacket
{
  const TopLevel& scene;
  const Placed& part;
  Search* searches;
  PacketEntry& entry;

  HRT_TARGET void operator()(Frustum& frustum)
  {
    const Hierarchy& hierarchy = *this->part.hierarchy;
    PacketTriangles<kAny> triangles(
      hierarchy, this->scene.membersOf(this->part), this->searches, this->entry, frustum);
    traverse<!kAny>(hierarchy.tree(), frustum, frustum.end(this->entry), triangles);
    triangles.decide(1);
  }
  HRT_TARGET void operator()(int i)
  {
    searchPart<kAny>(this->scene, this->part, this->searches[i]);
  }
};

// --- Parts
// ------------------------------------------------------------------------------------------

template <bool kAny>
HRT_TARGET void searchPart(
  const TopLevel& scene, const Placed& part, Search* searches, const PacketRays& rays)
{
  PacketEntry entry(part.hierarchy->entry(), rays);
  PartPacket<kAny> packet{ scene, part, searches, entry };
  traceTogether(entry, part.hierarchy->box(), packet);
}

// The rays in the part's coordinates, from those in the scene's; `which` of them.
HRT_TARGET void place(const Placed& part, const PacketRays& inScene, const Search* searches,
  unsigned int which, PacketRays& rays)
{
  const glm::dmat4& m = part.fromScene;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double x = m[0][axis], y = m[1][axis], z = m[2][axis], shift = m[3][axis];
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      rays.direction[axis].of[i] = x * inScene.direction[0].of[i] + y * inScene.direction[1].of[i] +
        z * inScene.direction[2].of[i];
      rays.origin[axis].of[i] = x * inScene.origin[0].of[i] + y * inScene.origin[1].of[i] +
        z * inScene.origin[2].of[i] + shift;
    }
  }
  rays.active = which;
  for (unsigned int i = 0; i < kPacket; ++i)
  {
    rays.end.of[i] = inScene.end.of[i];
  }
  for (unsigned int rest = which; rest != 0; rest &= rest - 1)
  {
    const int i = lowest(rest);
    rays.end.of[i] = searches[i].end();
    const glm::dvec3 origin(rays.origin[0].of[i], rays.origin[1].of[i], rays.origin[2].of[i]);
    const glm::dvec3 direction(
      rays.direction[0].of[i], rays.direction[1].of[i], rays.direction[2].of[i]);
    if (!part.onlyShifted && !isUsable(origin, direction))
    {
      rays.active &= ~(1u << i);
    }
  }
}

template <bool kAny>
struct PacketParts;

template <bool kAny>
struct PacketLeaves
{
  PacketParts<kAny>& parts;

  HRT_LANES void fetch(std::uint32_t) const {}

  HRT_LANES float operator()(std::uint32_t leaf, float end) { return this->parts.visit(leaf, end); }
};

template <bool kAny>
struct PacketParts
{
  const TopLevel& scene;
  Search* searches;
  const PacketRays& rays;
  PacketEntry& entry;
  Frustum* frustum = nullptr;

  HRT_TARGET void operator()(Frustum& hull)
  {
    this->frustum = &hull;
    PacketLeaves<kAny> leaves{ *this };
    traverse<!kAny>(this->scene.tree(), hull, hull.end(this->entry), leaves);
  }
  HRT_TARGET void operator()(int i) { searchScene<kAny>(this->scene, this->searches[i]); }

  HRT_LANES float visit(std::uint32_t leaf, float end)
  {
    const Placed& part = this->scene.leaf(leaf);
    if (!(kAny ? part.castsShadow : part.visibleToRays))
    {
      return end;
    }
    PacketRays local;
    place(part, this->rays, this->searches, this->frustum->rays, local);
    searchPart<kAny>(this->scene, part, this->searches, local);
    unsigned int left = this->frustum->rays;
    for (unsigned int rest = left; rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      left &= this->searches[i].found ? ~(1u << i) : ~0u;
      this->entry.end.of[i] = this->entry.endOf(i, this->searches[i].end());
    }
    if (kAny)
    {
      this->frustum->keep(left);
    }
    return left == 0 ? -1.0f : this->frustum->end(this->entry);
  }
};

template <bool kAny>
HRT_TARGET void searchScene(const TopLevel& scene, Search* searches, unsigned int count)
{
  PacketRays rays;
  for (unsigned int i = 0; i < count; ++i)
  {
    rays.active |= searches[i].usable() ? 1u << i : 0u;
  }
  if (rays.active == 0 || scene.size() == 0)
  {
    return;
  }
  const int first = lowest(rays.active);
  for (unsigned int i = 0; i < kPacket; ++i)
  {
    const Ray& ray = *searches[(rays.active >> i & 1u) != 0 ? i : first].ray;
    for (int axis = 0; axis < 3; ++axis)
    {
      rays.origin[axis].of[i] = ray.origin[axis];
      rays.direction[axis].of[i] = ray.direction[axis];
    }
    rays.end.of[i] = ray.tMaximum;
  }
  if (scene.size() == 1)
  {
    PacketRays local;
    place(scene.part(0), rays, searches, rays.active, local);
    if (local.active != 0)
    {
      searchPart<kAny>(scene, scene.part(0), searches, local);
    }
    return;
  }
  PacketEntry entry(scene.entry(), rays);
  PacketParts<kAny> parts{ scene, searches, rays, entry };
  traceTogether(entry, scene.box(), parts);
}

HRT_TARGET void nearestOfPacket(const TopLevel& scene, Search* searches, unsigned int count)
{
  searchScene<false>(scene, searches, count);
}

HRT_TARGET void anyOfPacket(const TopLevel& scene, Search* searches, unsigned int count)
{
  searchScene<true>(scene, searches, count);
}
