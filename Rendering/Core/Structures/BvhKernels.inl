// Single rays through both levels; packets in BvhPackets.inl. Included once for each instruction
// set (BvhKernels.cpp), which defines HRT_KERNELS, the namespace, HRT_SET, the set's name,
// HRT_TARGET, the functions' attribute, and HRT_AVX2 and HRT_AVX512, what may be used.

namespace hrt
{
namespace bvh
{
namespace HRT_KERNELS
{

#include "Rendering/Core/Structures/BvhLanes.inl"

constexpr unsigned int kLanes = TriangleBlock::kLanes;
static_assert(WideNode::kWidth == kLanes, "a value's lanes are a node's children");

// --- Boxes --------------------------------------------------------------------------------------

// A ray as the nodes of a tree want it. `kFar`: it has a margin.
template <bool kFar>
struct NodeRay
{
  Floats inverse[3];
  Floats offset[kFar ? 2 : 1][3]; // the origin times the inverse; for what is met first, and last
  int nearer[3];                  // which of a box' bounds the ray meets first

  HRT_LANES explicit NodeRay(const TraversalRay& ray)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const float inverse = ray.inverse[axis], offset = ray.origin[axis] * inverse;
      this->inverse[axis] = broadcast(inverse);
      this->nearer[axis] = std::signbit(inverse) ? 1 : 0;
      const float margin = kFar ? static_cast<float>(ray.margin) * std::fabs(inverse) : 0.0f;
      this->offset[0][axis] = broadcast(offset + margin);
      this->offset[kFar ? 1 : 0][axis] = broadcast(offset - margin);
    }
  }

  // The node's children that the ray meets before `end`, as bits, and where. TraversalBox::padding
  // has made up for all roundings.
  HRT_LANES unsigned int meet(const WideNode& node, Floats end, Floats& start) const
  {
    const int x = this->nearer[0], y = this->nearer[1], z = this->nearer[2];
    start = max(max(this->plane(node, 0, x), this->plane(node, 1, y)),
      max(this->plane(node, 2, z), broadcast(0.0f)));
    const Floats stop = min(min(this->plane(node, 0, x ^ 1), this->plane(node, 1, y ^ 1)),
      min(this->plane(node, 2, z ^ 1), end));
    return lessEqual(start, stop);
  }

private:
  HRT_LANES Floats plane(const WideNode& node, int axis, int which) const
  {
    const bool last = kFar && which != this->nearer[axis];
    return mulSub(
      load(node.bound[which][axis]), this->inverse[axis], this->offset[last ? 1 : 0][axis]);
  }
};

// What is still to be visited: the bits of the start, which is not negative, above the number, so
// that whole numbers are in the order of the starts.
using Pending = std::uint64_t;
HRT_LANES Pending pending(float start, std::uint32_t number)
{
  std::uint32_t bits;
  std::memcpy(&bits, &start, sizeof(bits));
  return Pending(bits) << 32 | number;
}
HRT_LANES float startOf(Pending p)
{
  const std::uint32_t bits = static_cast<std::uint32_t>(p >> 32);
  float start;
  std::memcpy(&start, &bits, sizeof(start));
  return start;
}

// Visits the leaves that the ray (or what else has NodeRay::meet) meets, the nearest first if
// `kNearestFirst`, until there is none or one of them has said that it is enough. `leaves(i, end)`
// visits the i-th leaf and returns where the search now ends; a negative end: it is over.
// `leaves.fetch(child)` is told of what will be visited, for the caches.
template <bool kNearestFirst, class Met, class Leaves>
HRT_LANES void traverse(const WideTree& tree, const Met& ray, float end, Leaves& leaves)
{
  if (tree.empty())
  {
    return;
  }
  const WideNode* const nodes = tree.nodes();
  Pending stack[WideTree::kDeepest * (WideNode::kWidth - 1) + 1];
  Pending* top = stack;
  std::uint32_t at = tree.root();
  alignas(32) float starts[WideNode::kWidth];
  for (;;)
  {
    while ((at & WideTree::kLeaf) == 0)
    {
      const WideNode& node = nodes[at];
      Floats start;
      unsigned int met = ray.meet(node, broadcast(end), start);
      if (met == 0)
      {
        goto next;
      }
      const int first = __builtin_ctz(met);
      met &= met - 1;
      at = node.child[first];
      leaves.fetch(at);
      if (met == 0)
      {
        continue;
      }
      store(starts, start);
      Pending nearest = pending(starts[first], at);
      Pending* const base = top;
      do
      {
        const int other = __builtin_ctz(met);
        met &= met - 1;
        leaves.fetch(node.child[other]);
        Pending one = pending(starts[other], node.child[other]);
        if (!kNearestFirst)
        {
          *top++ = one;
          continue;
        }
        // The nearest in hand, the others in order, the next one on top.
        if (one < nearest)
        {
          std::swap(one, nearest);
        }
        Pending* place = top++;
        for (; place > base && place[-1] < one; --place)
        {
          *place = place[-1];
        }
        *place = one;
      } while (met != 0);
      at = static_cast<std::uint32_t>(nearest);
    }
    end = leaves(at & ~WideTree::kLeaf, end);
    if (end < 0.0f)
    {
      return;
    }
  next:
    do
    {
      if (top == stack)
      {
        return;
      }
      --top;
    } while (!(startOf(*top) <= end));
    at = static_cast<std::uint32_t>(*top);
  }
}

// --- Triangles ----------------------------------------------------------------------------------

// The axes of a ray's shear; z: one along which its direction is 1 or -1.
struct Axes
{
  int x, y, z;

  HRT_LANES explicit Axes(const glm::vec3& direction)
  {
    this->z = std::fabs(direction.x) >= 1.0f ? 0 : (std::fabs(direction.y) >= 1.0f ? 1 : 2);
    this->x = this->z == 2 ? 0 : this->z + 1;
    this->y = this->z == 0 ? 2 : this->z - 1;
  }
};

// What the sieve wants of a ray: one ray in all lanes, or a ray to a lane.
template <class V>
struct SieveRay
{
  V x, y; // of the origin, along the axes of the shear
  V z;    // the same, forward
  V shearX, shearY;
  V forward; // the sign of the direction's z
};

// A triangle to a lane, or one in all lanes; along the axes of the shear.
template <class V>
struct SieveCorner
{
  V x, y, z;
};

// Where the rays' searches end, as the sieve asks: after the first depth nothing is met any more,
// and before the second surely nothing else is.
template <class V>
struct SieveEnd
{
  V late, before;

  HRT_LANES SieveEnd(V end, const SieveSlack& slack)
    : late(end + V::broadcast(slack.depth))
    , before(mulSub(end, V::broadcast(1.0f - 0x1p-21f), V::broadcast(slack.depth)))
  {
  }
};

// The sieve of TriangleBlock.h.
template <class V>
struct Sieved
{
  // Of the edge functions: the least of them, or of the three turned about, whichever is more; its
  // bound.
  V inside, bound;
  V nearest, farthest; // of the corners, along the ray

  // `spread(corners)`: at least the larger |x| + |y| of them, relative to the ray.
  template <class Spread>
  HRT_LANES Sieved(const SieveCorner<V>& a, const SieveCorner<V>& b, const SieveCorner<V>& c,
    const SieveRay<V>& ray, const SieveSlack& slack, Spread spread)
  {
    const V az = mulSub(a.z, ray.forward, ray.z), bz = mulSub(b.z, ray.forward, ray.z),
            cz = mulSub(c.z, ray.forward, ray.z);
    const V ax = subMul(a.x - ray.x, ray.shearX, az), ay = subMul(a.y - ray.y, ray.shearY, az);
    const V bx = subMul(b.x - ray.x, ray.shearX, bz), by = subMul(b.y - ray.y, ray.shearY, bz);
    const V cx = subMul(c.x - ray.x, ray.shearX, cz), cy = subMul(c.y - ray.y, ray.shearY, cz);
    const V u = mulSub(cx, by, cy * bx), v = mulSub(ax, cy, ay * cx), w = mulSub(bx, ay, by * ax);
    const V most3 = max(u, max(v, w));
    this->inside = max(min(u, min(v, w)), V::broadcast(0.0f) - most3);
    this->bound = mulAdd(V::broadcast(slack.edge), spread(ax, ay, bx, by, cx, cy), V::broadcast(slack.floor));
    this->nearest = min(az, min(bz, cz));
    this->farthest = max(az, max(bz, cz));
  }

  // Lanes that may be hit before the end; a NaN may.
  HRT_LANES unsigned int possible(const SieveEnd<V>& end, const SieveSlack& slack) const
  {
    const unsigned int outside = less(this->inside, V::broadcast(0.0f) - this->bound) |
      less(end.late, this->nearest) | less(this->farthest, V::broadcast(-slack.depth));
    return outside ^ ((1u << V::kLanes) - 1u);
  }

  // Lanes that surely are, after `begin`, and not after the true end. `begin`: TraversalRay's and the
  // slack's depth.
  HRT_LANES unsigned int sure(const SieveEnd<V>& end, V begin) const
  {
    return less(this->bound, this->inside) & less(begin, this->nearest) &
      less(this->farthest, end.before);
  }
};

// A block's cache lines, or a node's first, on their way while others are still visited.
HRT_LANES void fetchFrom(const Hierarchy& hierarchy, std::uint32_t child)
{
  if ((child & WideTree::kLeaf) == 0)
  {
    __builtin_prefetch(hierarchy.tree().nodes() + child);
    return;
  }
  constexpr std::size_t kCacheLine = 64;
  const auto* const block =
    reinterpret_cast<const char*>(&hierarchy.block(child & ~WideTree::kLeaf));
  for (std::size_t byte = 0; byte < sizeof(TriangleBlock); byte += kCacheLine)
  {
    __builtin_prefetch(block + byte);
  }
}

template <bool kAny>
struct Triangles
{
  const Hierarchy& hierarchy;
  const Member* const members;
  Search& search;
  const TraversalRay& ray;
  const SieveSlack& slack;
  const float begin;
  const Axes axes;
  const SieveRay<Floats> sieveRay;

  HRT_LANES Triangles(const Hierarchy& h, const Member* m, Search& s, const TraversalRay& r,
    const SieveSlack& sieveSlack)
    : hierarchy(h)
    , members(m)
    , search(s)
    , ray(r)
    , slack(sieveSlack)
    , begin(r.begin(s.ray->twinEnd) + sieveSlack.depth)
    , axes(r.direction)
    , sieveRay{ broadcast(r.origin[axes.x]), broadcast(r.origin[axes.y]),
      broadcast(r.origin[axes.z] * r.direction[axes.z]), broadcast(r.direction[axes.x]),
      broadcast(r.direction[axes.y]), broadcast(r.direction[axes.z]) }
  {
  }

  HRT_LANES SieveCorner<Floats> corner(const TriangleBlock& block, int i) const
  {
    return { load(block.corner[i][this->axes.x]), load(block.corner[i][this->axes.y]),
      load(block.corner[i][this->axes.z]) };
  }

  HRT_LANES void fetch(std::uint32_t child) const { fetchFrom(this->hierarchy, child); }

  HRT_LANES float operator()(std::uint32_t number, float end)
  {
    const TriangleBlock& block = this->hierarchy.block(number);
    const Sieved<Floats> sieved(this->corner(block, 0), this->corner(block, 1),
      this->corner(block, 2), this->sieveRay, this->slack,
      [](Floats ax, Floats ay, Floats bx, Floats by, Floats cx, Floats cy) HRT_TARGET
      { return max(size(ax) + size(ay), max(size(bx) + size(by), size(cx) + size(cy))); });
    const SieveEnd<Floats> sieveEnd(broadcast(end), this->slack);
    const unsigned int possible = sieved.possible(sieveEnd, this->slack);
    if (possible == 0)
    {
      return end;
    }
    if (kAny)
    {
      const SieveResult lanes = { possible, sieved.sure(sieveEnd, broadcast(this->begin)) };
      this->search.found = this->hierarchy.any(number, lanes, this->members, this->search);
      return this->search.found ? -1.0f : end;
    }
    return this->hierarchy.nearest(number, possible, this->members, this->search)
      ? this->ray.end(this->search.end())
      : end;
  }
};

template <bool kAny>
HRT_LANES void searchEntered(const Placed& part, const TraversalRay& ray, Search& search)
{
  const Hierarchy& hierarchy = *part.hierarchy;
  Triangles<kAny> triangles(hierarchy, part.members, search, ray, hierarchy.slack());
  traverse<!kAny>(hierarchy.tree(), NodeRay<false>(ray), ray.end(search.end()), triangles);
}

// The exact kernel asked about every triangle of a part.
template <bool kAny>
HRT_TARGET void askAll(const Placed& part, Search& search)
{
  const Hierarchy& hierarchy = *part.hierarchy;
  constexpr unsigned int lanes = (1u << kLanes) - 1u;
  for (std::uint32_t i = 0; i < hierarchy.blockCount() && !search.found; ++i)
  {
    if (kAny)
    {
      search.found = hierarchy.any(i, { lanes, 0 }, part.members, search);
    }
    else
    {
      hierarchy.nearest(i, lanes, part.members, search);
    }
  }
}

// With a margin of so many reaches a tree leaves nothing out.
constexpr double kWidestMargin = 4.0;

// A ray from so far away, or a part placed so far off, that double precision cannot tell to within
// a float's rounding where the one meets the other.
template <bool kAny>
HRT_TARGET __attribute__((noinline)) void searchFar(const Placed& part, Search& search)
{
  const Hierarchy& hierarchy = *part.hierarchy;
  // A quarter more is for the rounding of the margin itself, and of what it is added to.
  const double margin = 1.25 * part.placement.slack(largest(search.ray->origin));
  const double reach = hierarchy.box().reach();
  if (!(margin <= kWidestMargin * reach))
  {
    askAll<kAny>(part, search);
    return;
  }
  TraversalRay ray;
  if (part.enter(search, EntryBox(hierarchy.box(), margin), margin, ray))
  {
    // The sieve takes its bounds for floats' roundings from a reach: this one's is the margin.
    const SieveSlack slack(reach + 0x1p24 * margin);
    Triangles<kAny> triangles(hierarchy, part.members, search, ray, slack);
    traverse<!kAny>(hierarchy.tree(), NodeRay<true>(ray), ray.end(search.end()), triangles);
  }
}

// For an ordinary ray.
template <bool kAny>
HRT_TARGET void searchPart(const Placed& part, Search& search)
{
  if (!(largest(search.ray->origin) <= part.near))
  {
    searchFar<kAny>(part, search);
    return;
  }
  TraversalRay ray;
  if (part.enter(search, part.hierarchy->entry(), 0.0, ray))
  {
    searchEntered<kAny>(part, ray, search);
  }
}

// --- Parts --------------------------------------------------------------------------------------

template <bool kAny>
HRT_LANES bool takesPart(const Placed& part)
{
  return kAny ? part.castsShadow : part.visibleToRays;
}

template <bool kAny>
struct Parts
{
  const TopLevel& scene;
  Search& search;
  const TraversalRay& ray;

  HRT_LANES void fetch(std::uint32_t) const {}

  HRT_LANES float operator()(std::uint32_t leaf, float end)
  {
    PlacedScratch scratch;
    const Placed& part = this->scene.leaf(leaf, scratch);
    if (!takesPart<kAny>(part))
    {
      return end;
    }
    searchPart<kAny>(part, this->search);
    return this->search.found ? -1.0f : this->ray.end(this->search.end());
  }
};

// Part by part: for what the upper tree cannot do.
template <bool kAny, class SearchPart>
HRT_TARGET __attribute__((noinline)) void searchEach(
  const TopLevel& scene, Search& search, SearchPart searchOne)
{
  for (std::size_t i = 0; i < scene.size() && !search.found; ++i)
  {
    PlacedScratch scratch;
    const Placed& part = scene.part(i, scratch);
    if (takesPart<kAny>(part))
    {
      searchOne(part, search);
    }
  }
}

template <bool kAny>
HRT_TARGET void searchScene(const TopLevel& scene, Search& search)
{
  const Ray& ray = *search.ray;
  if (scene.size() == 0 || !ray.hasLength())
  {
    return;
  }
  if (!isOrdinary(ray.direction) || !isFinite(ray.origin))
  {
    if (isUsable(ray.origin, ray.direction))
    {
      searchEach<kAny>(scene, search, &askAll<kAny>);
    }
    return;
  }
  if (scene.size() == 1)
  {
    PlacedScratch scratch;
    searchPart<kAny>(scene.part(0, scratch), search);
    return;
  }
  if (!(largest(ray.origin) <= scene.near()))
  {
    searchEach<kAny>(scene, search, &searchFar<kAny>);
    return;
  }
  TraversalRay upper;
  if (enterBox(scene.entry(), ray.origin, ray.direction, search.end(), 0.0, upper))
  {
    Parts<kAny> parts{ scene, search, upper };
    traverse<!kAny>(scene.tree(), NodeRay<false>(upper), upper.end(search.end()), parts);
  }
}

HRT_TARGET void nearest(const TopLevel& scene, Search& search)
{
  searchScene<false>(scene, search);
}

HRT_TARGET void any(const TopLevel& scene, Search& search)
{
  searchScene<true>(scene, search);
}

#include "Rendering/Core/Structures/BvhPackets.inl"

#undef HRT_LANES

} // namespace HRT_KERNELS
} // namespace bvh
} // namespace hrt
