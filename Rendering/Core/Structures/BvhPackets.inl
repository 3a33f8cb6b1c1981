// Sixteen neighbouring rays together. Their hull, a frustum, goes down the tree in place of them,
// at the cost of one ray; in the leaves it picks the triangles, each of which the sieve then tests
// against all rays at once. Rays that do not lie together, by direction or by width, go singly.
// Included by BvhKernels.inl.

#include "Rendering/Core/Structures/BvhPacketRays.inl"

#include "Rendering/Core/Structures/BvhFrustum.inl"

// What the rays of a packet look for, shared by all levels of their traversal.
struct Packet
{
  const Ray* given = nullptr;
  Hit* hits = nullptr;              // their best, where they look for the nearest
  std::uint8_t* occluded = nullptr; // where any will do
  const Coincidence* surfaces = nullptr;
  HitWindow widest; // of all of them
  // Active are those that are still searching, and `end` is where each of them now ends.
  SceneRays rays;
};

#include "Rendering/Core/Structures/BvhCandidates.inl"

// --- Triangles ----------------------------------------------------------------------------------

template <bool kAny>
struct PacketTriangles
{
  const Hierarchy& hierarchy;
  const Member* const members;
  Packet& packet;
  PacketEntry& entry;
  Frustum& frustum;
  Candidates candidates;
  static constexpr unsigned int kGroups = kPacket / RayFloats::kLanes;
  SieveRay<RayFloats> sieveRays[kGroups];
  RayFloats begins[kGroups]; // Sieved::sure's
  const std::size_t along[3]; // from one axis of the shear to the next, in a block's corner

  HRT_LANES PacketTriangles(
    const Hierarchy& h, const Member* m, Packet& p, PacketEntry& e, Frustum& f)
    : hierarchy(h)
    , members(m)
    , packet(p)
    , entry(e)
    , frustum(f)
    , candidates(h, m, p)
    , along{ std::size_t(f.x) * kLanes, std::size_t(f.y) * kLanes, std::size_t(f.z) * kLanes }
  {
    const RayFloats forward = broadcastRays(f.forward);
    for (unsigned int first = 0; first < kPacket; first += RayFloats::kLanes)
    {
      this->sieveRays[first / RayFloats::kLanes] = { loadRays(e.origin[f.x].of + first),
        loadRays(e.origin[f.y].of + first), loadRays(e.origin[f.z].of + first) * forward,
        loadRays(e.direction[f.x].of + first), loadRays(e.direction[f.y].of + first), forward };
      this->begins[first / RayFloats::kLanes] =
        loadRays(e.begin.of + first) + broadcastRays(h.slack().depth);
    }
  }

  HRT_LANES void fetch(std::uint32_t child) const { fetchFrom(this->hierarchy, child); }

  HRT_LANES float operator()(std::uint32_t number, float end)
  {
    const TriangleBlock& block = this->hierarchy.block(number);
    const Frustum::Met met = this->frustum.meet(
      [&block](int side, int axis) HRT_TARGET
      {
        const Floats a = load(block.corner[0][axis]), b = load(block.corner[1][axis]),
                     c = load(block.corner[2][axis]);
        return side == 0 ? min(a, min(b, c)) : max(a, max(b, c));
      },
      broadcast(end));
    unsigned int lanes = met.boxes & ~equal(block.triangle, kNoTriangle);
    if (lanes == 0)
    {
      return end;
    }
    alignas(sizeof(Floats)) float spread[kLanes];
    store(spread, met.spread);
    RayFloats farthest[kGroups];
    std::fill(farthest, farthest + kGroups, broadcastRays(std::numeric_limits<float>::infinity()));
    bool shorter = false;
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = lowest(lanes);
      shorter = this->test(number, block, lane, spread[lane], farthest) || shorter;
    }
    if (!kAny)
    {
      shorter = this->shorten(farthest) || shorter;
    }
    return !shorter ? end : (this->frustum.rays == 0 ? -1.0f : this->frustum.end(this->entry));
  }

  // Decides what has been gathered. Whether some ray's search ends earlier now.
  HRT_LANES bool decide(unsigned int least)
  {
    const unsigned int nearer = this->candidates.decide(least);
    for (unsigned int rest = nearer; rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      const double end = this->packet.widest.end(this->packet.hits[i].t);
      this->packet.rays.end.of[i] = end;
      this->entry.end.of[i] = std::min(this->entry.end.of[i], this->entry.endOf(i, end));
    }
    return nearer != 0;
  }

private:
  HRT_LANES SieveCorner<RayFloats> corner(const TriangleBlock& block, int i, int lane) const
  {
    const float* const axes = block.corner[i][0] + lane;
    return { broadcastRays(axes[this->along[0]]), broadcastRays(axes[this->along[1]]),
      broadcastRays(axes[this->along[2]]) };
  }

  // A triangle that is surely hit ends the search at its farthest corner, and the window behind it,
  // even before the exact kernel has said where the hit is. Whether it does for some ray.
  HRT_LANES bool shorten(const RayFloats (&farthest)[kGroups])
  {
    const RayFloats depth = broadcastRays(2.0f * this->hierarchy.slack().depth);
    unsigned int shorter = 0;
    for (unsigned int group = 0; group < kGroups; ++group)
    {
      const RayFloats behind = loadRays(this->entry.behind.of + group * RayFloats::kLanes) + depth;
      const RayFloats after = (farthest[group] + behind) * broadcastRays(1.0f + 0x1p-22f);
      float* const at = this->entry.end.of + group * RayFloats::kLanes;
      const RayFloats end = loadRays(at);
      shorter |= less(after, end);
      store(at, min(after, end));
    }
    return shorter != 0;
  }

  // Whether some ray's search ends earlier now. `farthest` becomes, for each ray, the least that is
  // the most of a triangle surely hit. It ends no search before the block is done: were each of its
  // triangles to wait for the one before, the time would be that of the waiting.
  HRT_LANES bool test(std::uint32_t number, const TriangleBlock& block, int lane, float spread,
    RayFloats (&farthest)[kGroups])
  {
    const Member& member = this->hierarchy.memberOf(number, lane, this->members);
    if (!(kAny ? member.castsShadow : member.visibleToRays))
    {
      return false;
    }
    unsigned int others = this->frustum.rays;
    if (this->packet.rays.leave)
    {
      others &= ~this->packet.rays.leaving(member.firstTriangle + block.triangle[lane]);
    }
    const SieveCorner<RayFloats> a = this->corner(block, 0, lane), b = this->corner(block, 1, lane),
                                 c = this->corner(block, 2, lane);
    const SieveSlack& slack = this->hierarchy.slack();
    SieveResult met;
    for (unsigned int group = 0; group < kGroups; ++group)
    {
      const unsigned int first = group * RayFloats::kLanes;
      const Sieved<RayFloats> sieved(a, b, c, this->sieveRays[group], slack,
        [spread](auto...) HRT_TARGET { return broadcastRays(spread); });
      const SieveEnd<RayFloats> end(loadRays(this->entry.end.of + first), slack);
      met.possible |= sieved.possible(end, slack) << first & others;
      const unsigned int sure = sieved.sure(end, this->begins[group]) & others >> first;
      met.sure |= sure << first;
      farthest[group] = where(sure, min(farthest[group], sieved.farthest), farthest[group]);
    }
    if (met.possible == 0)
    {
      return false;
    }
    return kAny ? this->occlude(number, lane, met) : this->propose(number, lane, met.possible);
  }

  HRT_LANES bool occlude(std::uint32_t number, int lane, const SieveResult& met)
  {
    unsigned int found = met.sure;
    for (unsigned int rest = met.possible & ~met.sure; rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      Search search(this->packet.given[i], *this->packet.surfaces);
      found |= this->hierarchy.any(number, { 1u << lane, 0 }, this->members, search) ? 1u << i : 0u;
    }
    if (found == 0)
    {
      return false;
    }
    for (unsigned int rest = found; rest != 0; rest &= rest - 1)
    {
      this->packet.occluded[lowest(rest)] = 1;
    }
    this->packet.rays.active &= ~found;
    this->frustum.keep(this->frustum.rays & ~found);
    return true;
  }

  HRT_LANES bool propose(std::uint32_t number, int lane, unsigned int possible)
  {
    this->candidates.add(number, lane, possible);
    return this->candidates.enough() && this->decide(kLanes);
  }
};

// With this many rays or fewer a packet is slower than single rays.
constexpr int kFewRays = 2;
// So is one whose hull is wider than this share of the tree's reach: it meets too much that none of
// its rays meets. Measured; between a half and double of it nothing changes much.
constexpr float kWidest = 1.0f / 16.0f;

// Traces the rays that enter a tree: `tracer(frustum)` all of them, if they lie together, else
// `tracer(i)` one after the other.
template <class Tracer>
HRT_TARGET void traceTogether(const PacketEntry& entry, const TraversalBox& box, Tracer& tracer)
{
  Frustum frustum;
  if (__builtin_popcount(entry.active) > kFewRays && frustum.enclose(entry, box) &&
    frustum.width <= kWidest * static_cast<float>(box.reach()))
  {
    tracer(frustum);
    return;
  }
  for (unsigned int rest = entry.active; rest != 0; rest &= rest - 1)
  {
    tracer(lowest(rest));
  }
}

// One ray of the packet by itself: `search` does it.
template <bool kAny, class Searcher>
HRT_LANES void searchSingly(Packet& packet, int i, Searcher searcher)
{
  Search search(packet.given[i], *packet.surfaces);
  if (kAny)
  {
    searcher(search);
    packet.occluded[i] = search.found;
    packet.rays.active &= search.found ? ~(1u << i) : ~0u;
    return;
  }
  search.best = packet.hits[i];
  searcher(search);
  packet.hits[i] = search.best;
  packet.rays.end.of[i] = search.end();
}

template <bool kAny>
struct PartTracer
{
  const Placed& part;
  const PacketRays& local;
  Packet& packet;
  PacketEntry& entry;

  HRT_TARGET void operator()(Frustum& frustum)
  {
    const Hierarchy& hierarchy = *this->part.hierarchy;
    PacketTriangles<kAny> triangles(
      hierarchy, this->part.members, this->packet, this->entry, frustum);
    traverse<!kAny>(hierarchy.tree(), frustum, frustum.end(this->entry), triangles);
    triangles.decide(1);
  }
  HRT_TARGET void operator()(int i)
  {
    const TraversalRay ray = this->entry.ray(this->local, static_cast<unsigned int>(i));
    searchSingly<kAny>(this->packet, i,
      [&](Search& search) HRT_TARGET
      { searchEntered<kAny>(this->part, ray, search); });
  }
};

// --- Parts --------------------------------------------------------------------------------------

// The packet's rays in the part's coordinates; `which` of them.
HRT_TARGET void place(
  const Placed& part, const PacketRays& inScene, unsigned int which, PacketRays& rays)
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
  rays.end = inScene.end;
  rays.active = which;
}

// Some of the packet's rays in the part, as far as they go.
template <bool kAny>
HRT_TARGET void searchPart(const Placed& part, Packet& packet, unsigned int which)
{
  const unsigned int far = which & packet.rays.beyond(part.near);
  for (unsigned int rest = far; rest != 0; rest &= rest - 1)
  {
    searchSingly<kAny>(packet, lowest(rest),
      [&](Search& search) HRT_TARGET { searchFar<kAny>(part, search); });
  }
  if (which == far)
  {
    return;
  }
  PacketRays local;
  place(part, packet.rays, which & ~far, local);
  PacketEntry entry(part.hierarchy->entry(), local, packet.rays, packet.widest);
  PartTracer<kAny> tracer{ part, local, packet, entry };
  traceTogether(entry, part.hierarchy->box(), tracer);
}

template <bool kAny>
struct SceneTracer
{
  const TopLevel& scene;
  Packet& packet;
  PacketEntry& entry;
  Frustum* frustum = nullptr;

  HRT_TARGET void operator()(Frustum& hull)
  {
    this->frustum = &hull;
    traverse<!kAny>(this->scene.tree(), hull, hull.end(this->entry), *this);
  }
  HRT_TARGET void operator()(int i)
  {
    searchSingly<kAny>(this->packet, i,
      [this](Search& search) HRT_TARGET { searchScene<kAny>(this->scene, search); });
  }

  HRT_LANES void fetch(std::uint32_t) const {}

  HRT_LANES float operator()(std::uint32_t leaf, float end)
  {
    PlacedScratch scratch;
    const Placed& part = this->scene.leaf(leaf, scratch);
    if (!takesPart<kAny>(part))
    {
      return end;
    }
    searchPart<kAny>(part, this->packet, this->frustum->rays);
    const unsigned int left = this->frustum->rays & this->packet.rays.active;
    if (kAny)
    {
      if (left == this->frustum->rays)
      {
        return end;
      }
      this->frustum->keep(left);
      return left == 0 ? -1.0f : this->frustum->end(this->entry);
    }
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      this->entry.end.of[i] = this->entry.endOf(i, this->packet.rays.end.of[i]);
    }
    return this->frustum->end(this->entry);
  }
};

template <bool kAny>
HRT_TARGET void searchScene(const TopLevel& scene, Packet& packet, unsigned int count)
{
  const bool together = packet.rays.take(packet.given, count);
  const unsigned int far =
    together && scene.size() > 1 ? packet.rays.active & packet.rays.beyond(scene.near()) : 0u;
  for (unsigned int rest = packet.rays.alone | far; rest != 0; rest &= rest - 1)
  {
    searchSingly<kAny>(packet, lowest(rest),
      [&scene](Search& search) HRT_TARGET { searchScene<kAny>(scene, search); });
  }
  packet.rays.active &= ~far;
  if (!together || packet.rays.active == 0 || scene.size() == 0)
  {
    return;
  }
  if (!kAny)
  {
    packet.widest.fixed = packet.surfaces->reach() / packet.rays.shortest();
  }
  if (scene.size() == 1)
  {
    PlacedScratch scratch;
    searchPart<kAny>(scene.part(0, scratch), packet, packet.rays.active);
    return;
  }
  packet.rays.repeatActive();
  PacketEntry entry(scene.entry(), packet.rays, packet.rays, packet.widest);
  SceneTracer<kAny> tracer{ scene, packet, entry };
  traceTogether(entry, scene.box(), tracer);
}

HRT_TARGET void nearestOfPacket(
  const TopLevel& scene, const Ray* rays, Hit* hits, unsigned int count)
{
  std::fill(hits, hits + count, Hit());
  Packet packet;
  packet.given = rays;
  packet.surfaces = &scene.coincidence();
  packet.hits = hits;
  searchScene<false>(scene, packet, count);
}

HRT_TARGET void anyOfPacket(
  const TopLevel& scene, const Ray* rays, std::uint8_t* occluded, unsigned int count)
{
  std::fill(occluded, occluded + count, std::uint8_t(0));
  Packet packet;
  packet.given = rays;
  packet.surfaces = &scene.coincidence();
  packet.occluded = occluded;
  searchScene<true>(scene, packet, count);
}
