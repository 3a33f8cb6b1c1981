// Implements the ray structure over Embree: which hierarchies there are (by Grouping.h), the top
// level that holds them, and the way of single rays and packets through both.
#include "Rendering/Core/Structures/EmbreeStructure.h"

#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/EmbreeHierarchy.h"
#include "Rendering/Core/Structures/EmbreeSearch.h"
#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hrt
{
namespace embree
{

namespace
{

// With this many rays or fewer a packet is slower than single rays.
constexpr int kFewRays = 2;

void traverseOne(RTCScene scene, const Query& packet, unsigned int i, bool anyHit)
{
  Query query(packet.passages + i);
  query.members = packet.members;
  const Passage& passage = *query.passages;
  RTCRayHit rayHit{};
  RTCRay& ray = rayHit.ray;
  ray.org_x = passage.traversal.origin.x;
  ray.org_y = passage.traversal.origin.y;
  ray.org_z = passage.traversal.origin.z;
  ray.dir_x = passage.traversal.direction.x;
  ray.dir_y = passage.traversal.direction.y;
  ray.dir_z = passage.traversal.direction.z;
  ray.tfar = passage.end();
  ray.mask = ~0u;
  if (anyHit)
  {
    occluded(scene, query, ray);
    return;
  }
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(scene, query, rayHit);
}

// Embree 3 and 4 lay out the rays of a packet alike, as the first member of a packet of hits.
void traversePacket(RTCScene scene, Query& query, unsigned int mask, bool anyHit)
{
  alignas(64) int valid[kPacket];
  alignas(64) RTCRayHit16 rayHit{};
  RTCRay16& ray = rayHit.ray;
  for (unsigned int i = 0; i < kPacket; ++i)
  {
    valid[i] = (mask >> i & 1u) != 0 ? -1 : 0;
    if (!valid[i])
    {
      continue;
    }
    const Passage& passage = query.passages[i];
    ray.org_x[i] = passage.traversal.origin.x;
    ray.org_y[i] = passage.traversal.origin.y;
    ray.org_z[i] = passage.traversal.origin.z;
    ray.dir_x[i] = passage.traversal.direction.x;
    ray.dir_y[i] = passage.traversal.direction.y;
    ray.dir_z[i] = passage.traversal.direction.z;
    ray.tfar[i] = passage.end();
    ray.mask[i] = ~0u;
    ray.id[i] = i;
    rayHit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  if (anyHit)
  {
    occluded(scene, query, valid, ray);
  }
  else
  {
    intersect(scene, query, valid, rayHit);
  }
}

// Traces the passages that the mask names through the scene.
void traverse(RTCScene scene, Query& query, unsigned int mask, bool anyHit)
{
  if (__builtin_popcount(mask) > kFewRays)
  {
    traversePacket(scene, query, mask, anyHit);
    return;
  }
  for (; mask != 0; mask &= mask - 1)
  {
    traverseOne(scene, query, static_cast<unsigned int>(__builtin_ctz(mask)), anyHit);
  }
}

// A hierarchy with its place in the scene.
struct Placed
{
  std::shared_ptr<const Hierarchy> hierarchy;
  glm::dmat4 fromScene{ 1.0 };
  bool onlyShifted = false; // fromScene is a translation
  TraversalBox box;         // in scene coordinates
  std::size_t firstMember = 0;
  bool visibleToRays = false; // some member is
  bool castsShadow = false;

  bool operator==(const Placed& o) const
  {
    return hierarchy == o.hierarchy && fromScene == o.fromScene && box.lower == o.box.lower &&
      box.upper == o.box.upper;
  }

  // Makes the passage through the hierarchy; false when the ray misses it.
  bool enter(Search& search, Passage& passage) const
  {
    passage.search = &search;
    const Ray& ray = search.ray;
    const glm::dvec3 shift(this->fromScene[3]);
    const glm::dmat3 linear(this->fromScene);
    if (this->onlyShifted)
    {
      return enterBox(this->hierarchy->entry(), ray.origin + shift, ray.direction, search.end(),
        passage.traversal);
    }
    const glm::dvec3 origin = linear * ray.origin + shift, direction = linear * ray.direction;
    return isUsable(origin, direction) &&
      enterBox(this->hierarchy->entry(), origin, direction, search.end(), passage.traversal);
  }
};

} // namespace

// All placed hierarchies and, when there are several, one hierarchy over their boxes.
class TopLevel
{
public:
  // Members lie in the order of the placed hierarchies. Returns whether anything has moved.
  bool update(Device& device, std::vector<Placed> placed, std::vector<Member> members)
  {
    this->Members = std::move(members);
    const bool same = this->Parts == placed;
    // Assigned in any case: who is seen and who casts may differ.
    this->Parts = std::move(placed);
    if (!same)
    {
      this->rebuild(device);
    }
    return !same;
  }

  template <unsigned int N>
  void trace(Search* const* searches, unsigned int count, bool anyHit) const
  {
    Passage passages[N];
    unsigned int mask = 0;
    for (unsigned int i = 0; i < count; ++i)
    {
      const Ray& ray = searches[i]->ray;
      if (isUsable(ray.origin, ray.direction) && this->enter(*searches[i], passages[i]))
      {
        mask |= 1u << i;
      }
    }
    if (mask == 0)
    {
      return;
    }
    Query query(passages);
    if (this->Parts.size() == 1)
    {
      query.members = this->Members.data();
      traverse(this->Parts.front().hierarchy->scene(), query, mask, anyHit);
    }
    else
    {
      traverse(this->Tree->handle(), query, mask, anyHit);
    }
  }

private:
  bool enter(Search& search, Passage& passage) const
  {
    if (this->Parts.size() == 1)
    {
      return this->Parts.front().enter(search, passage);
    }
    passage.search = &search;
    return !this->Parts.empty() &&
      enterBox(
        this->Entry, search.ray.origin, search.ray.direction, search.end(), passage.traversal);
  }

  void rebuild(Device& device)
  {
    this->Box = TraversalBox();
    for (const Placed& part : this->Parts)
    {
      this->Box.include(part.box.lower);
      this->Box.include(part.box.upper);
    }
    this->Entry = EntryBox(this->Box);
    constexpr const char* doing = "building the hierarchy of the parts";
    if (this->Parts.size() < 2)
    {
      this->Tree.reset();
    }
    else if (this->Tree)
    {
      this->Tree->rebuild(device, this->Parts.size(), doing);
    }
    else
    {
      this->Tree = std::make_unique<Scene>(device,
        UserGeometry{ this, this->Parts.size(), &TopLevel::boundsOf, &TopLevel::intersectPart,
          &TopLevel::occludePart },
        Scene::Kind::Static, doing);
    }
  }

  static void boundsOf(const RTCBoundsFunctionArguments* arguments)
  {
    const TopLevel& self = *static_cast<const TopLevel*>(arguments->geometryUserPtr);
    setBounds(*arguments->bounds_o, self.Parts[arguments->primID].box, self.Box.padding());
  }

  // Enters a part with those of the rays that meet it, each as a passage of its own.
  template <class Arguments>
  static unsigned int enterPart(
    const Arguments* arguments, const Placed& part, Query& lower, unsigned int& entered)
  {
    const TopLevel& self = *static_cast<const TopLevel*>(arguments->geometryUserPtr);
    lower.members = self.Members.data() + part.firstMember;
    entered = 0;
    for (unsigned int i = 0; i < arguments->N; ++i)
    {
      if (arguments->valid[i] && part.enter(*passageOf(arguments, i).search, lower.passages[i]))
      {
        entered |= 1u << i;
      }
    }
    return entered;
  }

  static const Placed& partOf(void* self, unsigned int i)
  {
    return static_cast<const TopLevel*>(self)->Parts[i];
  }

  static void intersectPart(const RTCIntersectFunctionNArguments* arguments)
  {
    arguments->N == 1 ? intersectPartN<1>(arguments) : intersectPartN<kPacket>(arguments);
  }

  template <unsigned int N>
  static void intersectPartN(const RTCIntersectFunctionNArguments* arguments)
  {
    const Placed& part = partOf(arguments->geometryUserPtr, arguments->primID);
    Passage passages[N];
    Query lower(passages);
    unsigned int entered = 0;
    if (!part.visibleToRays || enterPart(arguments, part, lower, entered) == 0)
    {
      return;
    }
    traverse(part.hierarchy->scene(), lower, entered, false);
    for (; entered != 0; entered &= entered - 1)
    {
      const unsigned int i = static_cast<unsigned int>(__builtin_ctz(entered));
      const float end = passageOf(arguments, i).end();
      if (end < RTCRayN_tfar(raysOf(arguments), arguments->N, i))
      {
        shorten(arguments, i, end);
      }
    }
  }

  static void occludePart(const RTCOccludedFunctionNArguments* arguments)
  {
    arguments->N == 1 ? occludePartN<1>(arguments) : occludePartN<kPacket>(arguments);
  }

  template <unsigned int N>
  static void occludePartN(const RTCOccludedFunctionNArguments* arguments)
  {
    const Placed& part = partOf(arguments->geometryUserPtr, arguments->primID);
    Passage passages[N];
    Query lower(passages);
    unsigned int entered = 0;
    if (!part.castsShadow || enterPart(arguments, part, lower, entered) == 0)
    {
      return;
    }
    traverse(part.hierarchy->scene(), lower, entered, true);
    for (; entered != 0; entered &= entered - 1)
    {
      const unsigned int i = static_cast<unsigned int>(__builtin_ctz(entered));
      if (passages[i].search->found)
      {
        finish(arguments, i);
      }
    }
  }

  std::vector<Placed> Parts;
  std::vector<Member> Members;
  TraversalBox Box;
  EntryBox Entry;
  std::unique_ptr<Scene> Tree; // of several parts
};

namespace
{

TraversalBox boxInScene(const TraversalBox& local, const glm::dmat4& toScene)
{
  TraversalBox box;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 point((corner & 1) ? local.upper.x : local.lower.x,
      (corner & 2) ? local.upper.y : local.lower.y, (corner & 4) ? local.upper.z : local.lower.z,
      1.0);
    box.include(glm::dvec3(toScene * point));
  }
  return box;
}

// The triangles of one geometry in its own coordinates.
std::vector<SourceTriangle> localTriangles(const Geometry& geometry)
{
  std::vector<SourceTriangle> triangles(geometry.triangleCount());
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const glm::vec3* const corner = geometry.positions.data() + 3 * i;
    triangles[i] = { { corner[0], corner[1], corner[2] }, { 0, static_cast<std::uint32_t>(i) } };
  }
  return triangles;
}

// Many parts in one hierarchy, in world coordinates relative to `anchor`: the scene's origin when
// it was built, which later snapshots are free to leave.
struct MergedHierarchy
{
  std::shared_ptr<const Hierarchy> hierarchy; // null: nothing merged
  glm::dvec3 anchor{ 0.0 };
  std::vector<std::size_t> parts; // of the last snapshot, in the order of the members; or kNewPart

  void build(Device& device, const Snapshot& snapshot, const Grouping& grouping, Place place)
  {
    this->anchor = snapshot.origin;
    this->parts.clear();
    std::vector<SourceTriangle> triangles;
    std::vector<std::array<glm::vec3, 3>> positions;
    for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
    {
      if (grouping.parts[i].place == place)
      {
        this->add(snapshot.parts[i], triangles, positions);
        this->parts.push_back(i);
      }
    }
    this->hierarchy = triangles.empty()
      ? nullptr
      : std::make_shared<const Hierarchy>(device, triangles, positions, Scene::Kind::Static);
  }

  // The members' numbers in a later snapshot; those that have left get none.
  void follow(const Grouping& grouping, Place place, std::size_t earlierCount)
  {
    std::vector<std::size_t> now(earlierCount, kNewPart);
    for (std::size_t i = 0; i < grouping.parts.size(); ++i)
    {
      const GroupedPart& part = grouping.parts[i];
      if (part.before != kNewPart && part.place == place)
      {
        now[part.before] = i;
      }
    }
    for (std::size_t& part : this->parts)
    {
      part = part == kNewPart ? kNewPart : now[part];
    }
  }

private:
  void add(const Part& part, std::vector<SourceTriangle>& triangles,
    std::vector<std::array<glm::vec3, 3>>& positions) const
  {
    const glm::dmat4 toAnchor = positionsToScene(part, this->anchor);
    const std::uint32_t member = static_cast<std::uint32_t>(this->parts.size());
    for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
    {
      const Corners c = sceneCorners(*part.geometry, toAnchor, i);
      const glm::vec3* const corner = part.geometry->positions.data() + 3 * i;
      triangles.push_back({ { glm::vec3(c.a), glm::vec3(c.b), glm::vec3(c.c) },
        { member, static_cast<std::uint32_t>(i) } });
      positions.push_back({ corner[0], corner[1], corner[2] });
    }
  }
};

Member memberOf(const Part& part, const glm::dvec3& sceneOrigin)
{
  return { positionsToScene(part, sceneOrigin), part.firstTriangle, part.visibleToRays,
    part.castsShadow };
}

} // namespace
} // namespace embree

struct EmbreeStructure::Implementation
{
  struct Own // a geometry's hierarchy
  {
    std::shared_ptr<embree::Hierarchy> hierarchy;
    bool refittable = false;
  };
  using Owns = std::unordered_map<std::uint64_t, Own>; // by Geometry::version

  // The device outlives the scenes: members are destroyed from the last to the first.
  embree::Device device;
  Grouping grouping; // of the last update
  embree::MergedHierarchy merged, flat;
  Owns owns;
  std::unique_ptr<embree::TopLevel> top = std::make_unique<embree::TopLevel>();

  explicit Implementation(const std::string& configuration)
    : device(configuration)
  {
  }

  void clear()
  {
    this->top = std::make_unique<embree::TopLevel>();
    this->grouping = Grouping();
    this->merged = this->flat = embree::MergedHierarchy();
    this->owns.clear();
  }

  void updateMerged(embree::MergedHierarchy& hierarchy, bool anew, Place place,
    const Snapshot& snapshot, const Grouping& now, StructureReport& report)
  {
    if (anew)
    {
      hierarchy.build(this->device, snapshot, now, place);
      report.built += hierarchy.hierarchy != nullptr;
      return;
    }
    hierarchy.follow(now, place, this->grouping.parts.size());
    report.reused += hierarchy.hierarchy != nullptr;
  }

  // Refits the hierarchy that the part had in the last update, if nobody else wants it as it is.
  bool refitOwn(const Part& part, const GroupedPart& grouped, Owns& current)
  {
    const std::uint64_t earlier =
      grouped.before == kNewPart ? 0 : this->grouping.parts[grouped.before].version;
    const auto old = this->owns.find(earlier);
    if (!grouped.deformed || old == this->owns.end() || !old->second.refittable ||
      current.count(earlier) != 0)
    {
      return false;
    }
    const Own own = old->second;
    this->owns.erase(old);
    if (!own.hierarchy->refit(this->device, part.geometry->positions))
    {
      return false;
    }
    current[part.geometry->version] = own;
    return true;
  }

  // The hierarchies of the parts that stand alone: taken over, refitted, or built.
  void updateOwns(const Snapshot& snapshot, const Grouping& now, StructureReport& report)
  {
    Owns current;
    const auto forEachMissing = [&](auto action)
    {
      for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
      {
        const std::uint64_t version = snapshot.parts[i].geometry->version;
        if (now.parts[i].place == Place::Alone && current.count(version) == 0)
        {
          action(snapshot.parts[i], now.parts[i], version);
        }
      }
    };
    forEachMissing(
      [&](const Part&, const GroupedPart&, std::uint64_t version)
      {
        const auto known = this->owns.find(version);
        if (known != this->owns.end())
        {
          current.insert(*known);
          ++report.reused;
        }
      });
    forEachMissing(
      [&](const Part& part, const GroupedPart& grouped, std::uint64_t version)
      {
        if (this->refitOwn(part, grouped, current))
        {
          ++report.refitted;
          return;
        }
        // What has deformed once will do so again.
        current[version] = {
          std::make_shared<embree::Hierarchy>(this->device, embree::localTriangles(*part.geometry),
            std::vector<std::array<glm::vec3, 3>>(),
            grouped.deformed ? embree::Scene::Kind::Refittable : embree::Scene::Kind::Static),
          grouped.deformed
        };
        ++report.built;
      });
    this->owns.swap(current);
  }

  bool updateTop(const Snapshot& snapshot, const Grouping& now)
  {
    std::vector<embree::Placed> placed;
    std::vector<embree::Member> members;
    this->placeMerged(this->merged, snapshot, placed, members);
    this->placeMerged(this->flat, snapshot, placed, members);
    for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
    {
      if (now.parts[i].place == Place::Alone)
      {
        this->placeOwn(snapshot.parts[i], snapshot.origin, placed, members);
      }
    }
    return this->top->update(this->device, std::move(placed), std::move(members));
  }

  void addMember(embree::Placed& placed, const Part& part, const glm::dvec3& origin,
    std::vector<embree::Member>& members)
  {
    members.push_back(embree::memberOf(part, origin));
    placed.visibleToRays = placed.visibleToRays || part.visibleToRays;
    placed.castsShadow = placed.castsShadow || part.castsShadow;
  }

  void placeMerged(const embree::MergedHierarchy& hierarchy, const Snapshot& snapshot,
    std::vector<embree::Placed>& placed, std::vector<embree::Member>& members)
  {
    embree::Placed result;
    result.firstMember = members.size();
    for (const std::size_t part : hierarchy.parts)
    {
      if (part == kNewPart)
      {
        members.emplace_back();
      }
      else
      {
        this->addMember(result, snapshot.parts[part], snapshot.origin, members);
      }
    }
    if (!result.visibleToRays && !result.castsShadow)
    {
      members.resize(result.firstMember);
      return;
    }
    const glm::dvec3 shift = snapshot.origin - hierarchy.anchor;
    result.hierarchy = hierarchy.hierarchy;
    result.fromScene[3] = glm::dvec4(shift, 1.0);
    result.onlyShifted = true;
    result.box.include(hierarchy.hierarchy->box().lower - shift);
    result.box.include(hierarchy.hierarchy->box().upper - shift);
    placed.push_back(std::move(result));
  }

  void placeOwn(const Part& part, const glm::dvec3& origin, std::vector<embree::Placed>& placed,
    std::vector<embree::Member>& members)
  {
    embree::Placed result;
    result.firstMember = members.size();
    this->addMember(result, part, origin, members);
    const glm::dmat4& toScene = members.back().toScene;
    result.hierarchy = this->owns.at(part.geometry->version).hierarchy;
    result.fromScene = glm::inverse(toScene);
    result.onlyShifted = glm::dmat3(result.fromScene) == glm::dmat3(1.0);
    result.box = embree::boxInScene(result.hierarchy->box(), toScene);
    placed.push_back(std::move(result));
  }
};

EmbreeStructure::EmbreeStructure(const std::string& configuration)
  : Impl(std::make_unique<Implementation>(configuration))
{
}

EmbreeStructure::~EmbreeStructure() = default;

StructureReport EmbreeStructure::update(const Snapshot& snapshot)
{
  const auto started = std::chrono::steady_clock::now();
  StructureReport report;
  try
  {
    Grouping now = groupParts(snapshot, this->Impl->grouping);
    Implementation& impl = *this->Impl;
    impl.updateMerged(impl.merged, now.mergedAnew, Place::Merged, snapshot, now, report);
    impl.updateMerged(impl.flat, now.flatAnew, Place::Flat, snapshot, now, report);
    impl.updateOwns(snapshot, now, report);
    report.partsRebuilt = impl.updateTop(snapshot, now);
    impl.grouping = std::move(now);
  }
  catch (...)
  {
    this->Impl->clear();
    throw;
  }
  report.milliseconds =
    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
  return report;
}

Hit EmbreeStructure::intersect(const Ray& ray) const
{
  embree::Search search(ray);
  embree::Search* const only = &search;
  this->Impl->top->trace<1>(&only, 1, false);
  return search.best;
}

bool EmbreeStructure::occluded(const Ray& ray) const
{
  embree::Search search(ray);
  embree::Search* const only = &search;
  this->Impl->top->trace<1>(&only, 1, true);
  return search.found;
}

namespace
{

// The rays of a stream in packets: `take(search, i)` gets every ray's result.
template <class Take>
void tracePackets(
  const embree::TopLevel& top, const Ray* rays, std::size_t count, bool anyHit, Take take)
{
  for (std::size_t first = 0; first < count; first += embree::kPacket)
  {
    const unsigned int n =
      static_cast<unsigned int>(std::min<std::size_t>(embree::kPacket, count - first));
    std::optional<embree::Search> searches[embree::kPacket];
    embree::Search* pointers[embree::kPacket];
    for (unsigned int i = 0; i < n; ++i)
    {
      pointers[i] = &searches[i].emplace(rays[first + i]);
    }
    top.trace<embree::kPacket>(pointers, n, anyHit);
    for (unsigned int i = 0; i < n; ++i)
    {
      take(*pointers[i], first + i);
    }
  }
}

} // namespace

void EmbreeStructure::intersect(const Ray* rays, Hit* hits, std::size_t count, RayOrder order) const
{
  if (order == RayOrder::Incoherent)
  {
    Structure::intersect(rays, hits, count, order);
    return;
  }
  tracePackets(*this->Impl->top, rays, count, false,
    [hits](const embree::Search& search, std::size_t i) { hits[i] = search.best; });
}

void EmbreeStructure::occluded(
  const Ray* rays, std::uint8_t* occluded, std::size_t count, RayOrder order) const
{
  if (order == RayOrder::Incoherent)
  {
    Structure::occluded(rays, occluded, count, order);
    return;
  }
  tracePackets(*this->Impl->top, rays, count, true,
    [occluded](const embree::Search& search, std::size_t i) { occluded[i] = search.found; });
}

} // namespace hrt
