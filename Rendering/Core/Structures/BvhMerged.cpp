// Implements the merging of parts.
#include "Rendering/Core/Structures/BvhMerged.h"

#include "Rendering/Core/Geometry/TriangleIntersection.h"

#include <utility>

namespace hrt
{
namespace bvh
{

void MergedHierarchy::build(
  Device& device, const Snapshot& snapshot, const Grouping& grouping, Place place)
{
  this->anchor = snapshot.origin;
  this->parts.clear();
  this->versions.clear();
  std::vector<MemberMesh> members;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    if (grouping.parts[i].place == place)
    {
      members.push_back(
        { snapshot.parts[i].geometry, positionsToScene(snapshot.parts[i], this->anchor) });
      this->parts.push_back(i);
      this->versions.push_back(snapshot.parts[i].geometry->version);
    }
  }
  this->hierarchy = members.empty() ? nullptr : std::make_shared<Hierarchy>(device, members);
}

bool MergedHierarchy::refit(const Snapshot& snapshot, const Grouping& grouping, Place place)
{
  std::vector<std::size_t> now;
  std::vector<std::uint64_t> nowVersions;
  std::vector<glm::dmat4> placements;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    if (grouping.parts[i].place == place)
    {
      now.push_back(i);
      nowVersions.push_back(snapshot.parts[i].geometry->version);
      placements.push_back(positionsToScene(snapshot.parts[i], snapshot.origin));
    }
  }
  if (!this->hierarchy || nowVersions != this->versions || !this->hierarchy->refit(placements))
  {
    return false;
  }
  this->anchor = snapshot.origin;
  this->parts = std::move(now);
  return true;
}

void MergedHierarchy::follow(const Grouping& grouping, Place place, std::size_t earlierCount)
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

} // namespace bvh
} // namespace hrt
