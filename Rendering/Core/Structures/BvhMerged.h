// Many parts in one hierarchy: those at rest, and those too small or too crowded for one each
// (Grouping.h). It outlives the snapshot it was built from: parts may leave it, and the scene's
// origin may move.
#pragma once

#include "Rendering/Core/Structures/BvhHierarchy.h"
#include "Rendering/Core/Structures/Grouping.h"

#include <memory>
#include <vector>

namespace hrt
{
namespace bvh
{

struct MergedHierarchy
{
  std::shared_ptr<Hierarchy> hierarchy; // null: nothing merged
  // The scene's origin when it was built, to which its coordinates are relative.
  glm::dvec3 anchor{ 0.0 };
  std::vector<std::size_t> parts; // of the last snapshot, in the order of the members; or kNewPart
  std::vector<std::uint64_t> versions; // of their geometries

  // From the parts that are grouped in `place`.
  void build(Device& device, const Snapshot& snapshot, const Grouping& grouping, Place place);

  // Moves the hierarchy with its parts; false when other parts are grouped in `place` than were, or
  // when it is better built anew.
  bool refit(const Snapshot& snapshot, const Grouping& grouping, Place place);

  // The members' numbers in a later snapshot; those that have left get none.
  void follow(const Grouping& grouping, Place place, std::size_t earlierCount);
};

} // namespace bvh
} // namespace hrt
