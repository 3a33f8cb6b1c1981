// Implements the merging of parts: their corners go through the exact kernel's own arithmetic.
#include "Rendering/Core/Structures/EmbreeMerged.h"

#include "Rendering/Core/Geometry/TriangleTest.h"

#include <utility>

namespace hrt
{
namespace embree
{

namespace
{

struct Triangles
{
  std::vector<SourceTriangle> placed;
  std::vector<std::array<glm::vec3, 3>> positions; // in their geometries

  void add(const Part& part, const glm::dvec3& anchor, std::uint32_t member)
  {
    const glm::dmat4 toAnchor = positionsToScene(part, anchor);
    for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
    {
      const Corners c = sceneCorners(*part.geometry, toAnchor, i);
      this->placed.push_back({ { glm::vec3(c.a), glm::vec3(c.b), glm::vec3(c.c) }, member,
        static_cast<std::uint32_t>(i) });
      this->positions.push_back(part.geometry->cornerPositions(i));
    }
  }
};

} // namespace

void MergedHierarchy::build(
  Device& device, const Snapshot& snapshot, const Grouping& grouping, Place place)
{
  this->anchor = snapshot.origin;
  this->parts.clear();
  this->versions.clear();
  Triangles triangles;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    if (grouping.parts[i].place == place)
    {
      triangles.add(
        snapshot.parts[i], this->anchor, static_cast<std::uint32_t>(this->parts.size()));
      this->parts.push_back(i);
      this->versions.push_back(snapshot.parts[i].geometry->version);
    }
  }
  this->hierarchy = triangles.placed.empty()
    ? nullptr
    : std::make_shared<Hierarchy>(device, triangles.placed, triangles.positions);
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

} // namespace embree
} // namespace hrt
