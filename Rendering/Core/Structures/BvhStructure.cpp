// Implements the ray structure over Embree: which hierarchies there are, by Grouping.h, and where
// they stand. How rays go through them is in BvhKernels.h.
#include "Rendering/Core/Structures/BvhStructure.h"

#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/BvhKernels.h"
#include "Rendering/Core/Structures/BvhMerged.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <chrono>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hrt
{

struct BvhStructure::Implementation
{
  // The geometries' own hierarchies, by Geometry::version.
  using Owns = std::unordered_map<std::uint64_t, std::shared_ptr<bvh::Hierarchy>>;

  bvh::Device device;
  const bvh::Kernels& kernels;
  Grouping grouping; // of the last update
  bvh::MergedHierarchy merged, flat;
  Owns owns;
  std::unique_ptr<bvh::TopLevel> top = std::make_unique<bvh::TopLevel>();

  explicit Implementation(const std::string& configuration)
    : device(configuration)
    , kernels(bvh::kernelsFor(this->device.instructionSet()))
  {
  }

  void clear()
  {
    this->top = std::make_unique<bvh::TopLevel>();
    this->grouping = Grouping();
    this->merged = this->flat = bvh::MergedHierarchy();
    this->owns.clear();
  }

  void updateMerged(bvh::MergedHierarchy& hierarchy, bool anew, Place place,
    const Snapshot& snapshot, const Grouping& now, StructureReport& report)
  {
    if (anew && place == Place::Flat && hierarchy.refit(snapshot, now, place))
    {
      ++report.refitted;
      return;
    }
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
    if (!grouped.deformed || old == this->owns.end() || current.count(earlier) != 0)
    {
      return false;
    }
    const std::shared_ptr<bvh::Hierarchy> own = old->second;
    this->owns.erase(old);
    if (!own->refit(*part.geometry))
    {
      return false;
    }
    current[part.geometry->version] = own;
    return true;
  }

  // Whether the parts that stand alone are those of the last update, with the same triangles.
  bool ownsAreThoseOf(const Grouping& now) const
  {
    const auto alone = [](const GroupedPart& part) { return part.place == Place::Alone; };
    return std::count_if(now.parts.begin(), now.parts.end(), alone) ==
      std::count_if(this->grouping.parts.begin(), this->grouping.parts.end(), alone) &&
      std::all_of(now.parts.begin(), now.parts.end(),
        [&](const GroupedPart& part)
        {
          return !alone(part) ||
            (part.before != kNewPart && alone(this->grouping.parts[part.before]) &&
              this->grouping.parts[part.before].version == part.version);
        });
  }

  // The hierarchies of the parts that stand alone: taken over, refitted, or built.
  void updateOwns(const Snapshot& snapshot, const Grouping& now, StructureReport& report)
  {
    if (this->ownsAreThoseOf(now))
    {
      report.reused += this->owns.size();
      return;
    }
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
        current[version] = std::make_shared<bvh::Hierarchy>(
          this->device, std::vector<bvh::MemberMesh>{ { part.geometry, std::nullopt } });
        ++report.built;
      });
    this->owns.swap(current);
  }

  bool updateTop(const Snapshot& snapshot, const Grouping& now)
  {
    bvh::TopLevelParts parts;
    parts.placed.reserve(snapshot.parts.size() + 2);
    parts.members.reserve(snapshot.parts.size() + this->merged.parts.size());
    this->placeMerged(this->merged, snapshot, parts);
    this->placeMerged(this->flat, snapshot, parts);
    for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
    {
      if (now.parts[i].place == Place::Alone)
      {
        this->placeOwn(snapshot.parts[i], snapshot.origin, parts);
      }
    }
    return this->top->update(this->device, std::move(parts), Coincidence(snapshot));
  }

  void placeMerged(const bvh::MergedHierarchy& hierarchy, const Snapshot& snapshot,
    bvh::TopLevelParts& parts)
  {
    bvh::Placed result;
    result.firstMember = parts.members.size();
    for (const std::size_t part : hierarchy.parts)
    {
      if (part == kNewPart)
      {
        parts.members.emplace_back();
        continue;
      }
      parts.members.push_back(bvh::memberOf(snapshot.parts[part], snapshot.origin));
      result.visibleToRays = result.visibleToRays || parts.members.back().visibleToRays;
      result.castsShadow = result.castsShadow || parts.members.back().castsShadow;
    }
    if (!result.visibleToRays && !result.castsShadow)
    {
      parts.members.resize(result.firstMember);
      return;
    }
    const glm::dvec3 shift = snapshot.origin - hierarchy.anchor;
    result.hierarchy = hierarchy.hierarchy.get();
    result.fromScene[3] = glm::dvec4(shift, 1.0);
    result.onlyShifted = true;
    result.placement = Placement(glm::translate(glm::dmat4(1.0), -shift), glm::dmat3(1.0),
      hierarchy.hierarchy->box().reach());
    result.setNear();
    result.box.include(hierarchy.hierarchy->box().lower - shift);
    result.box.include(hierarchy.hierarchy->box().upper - shift);
    parts.placed.push_back(result);
    parts.hierarchies.push_back(hierarchy.hierarchy);
  }

  void placeOwn(const Part& part, const glm::dvec3& origin, bvh::TopLevelParts& parts)
  {
    const std::shared_ptr<bvh::Hierarchy>& own = this->owns.at(part.geometry->version);
    parts.hierarchies.push_back(own);
    if (part.copies)
    {
      parts.copies.push_back({ own.get(), part, origin });
      return;
    }
    bvh::Placed result;
    result.firstMember = parts.members.size();
    parts.members.push_back(bvh::memberOf(part, origin));
    result.place(*own, parts.members.back());
    result.setBox(*own, parts.members.back());
    parts.placed.push_back(result);
  }
};

BvhStructure::BvhStructure(const std::string& configuration)
  : Impl(std::make_unique<Implementation>(configuration))
{
}

BvhStructure::~BvhStructure() = default;

StructureReport BvhStructure::update(const Snapshot& snapshot)
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

Hit BvhStructure::intersect(const Ray& ray) const
{
  bvh::Search search(ray, this->Impl->top->coincidence());
  this->Impl->kernels.nearest(*this->Impl->top, search);
  return search.best;
}

void BvhStructure::intersectAll(const Ray& ray, std::vector<Hit>& hits) const
{
  hits.clear();
  bvh::Search search(ray, this->Impl->top->coincidence());
  search.all = &hits;
  this->Impl->kernels.nearest(*this->Impl->top, search);
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.before(b); });
}

bool BvhStructure::occluded(const Ray& ray) const
{
  bvh::Search search(ray, this->Impl->top->coincidence());
  this->Impl->kernels.any(*this->Impl->top, search);
  return search.found;
}

namespace
{

// The rays of a stream in packets.
template <class Trace, class Result>
void tracePackets(
  const bvh::TopLevel& top, Trace trace, const Ray* rays, Result* results, std::size_t count)
{
  for (std::size_t first = 0; first < count; first += bvh::kPacket)
  {
    const std::size_t end = std::min(first + bvh::kPacket, count);
    for (std::size_t next = end; next < std::min(end + bvh::kPacket, count); ++next)
    {
      __builtin_prefetch(rays + next);
    }
    trace(top, rays + first, results + first, static_cast<unsigned int>(end - first));
  }
}

} // namespace

void BvhStructure::intersect(const Ray* rays, Hit* hits, std::size_t count, RayOrder order) const
{
  if (order == RayOrder::Incoherent)
  {
    Structure::intersect(rays, hits, count, order);
    return;
  }
  tracePackets(*this->Impl->top, this->Impl->kernels.nearestOfPacket, rays, hits, count);
}

void BvhStructure::occluded(
  const Ray* rays, std::uint8_t* occluded, std::size_t count, RayOrder order) const
{
  if (order == RayOrder::Incoherent)
  {
    Structure::occluded(rays, occluded, count, order);
    return;
  }
  tracePackets(*this->Impl->top, this->Impl->kernels.anyOfPacket, rays, occluded, count);
}

} // namespace hrt
