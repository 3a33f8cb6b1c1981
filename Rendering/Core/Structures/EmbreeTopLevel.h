// All hierarchies at their places in the scene and, when there are several, one tree over their
// boxes: the upper of the two levels that a ray goes through.
#pragma once

#include "Rendering/Core/Structures/EmbreeHierarchy.h"

#include <memory>
#include <vector>

namespace hrt
{
namespace embree
{

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

  // The ray as the hierarchy's tree sees it; false when it misses it.
  HRT_ALWAYS_INLINE bool enter(const Search& search, TraversalRay& local) const
  {
    const Ray& ray = *search.ray;
    const glm::dvec3 shift(this->fromScene[3]);
    if (this->onlyShifted)
    {
      return enterBox(
        this->hierarchy->entry(), ray.origin + shift, ray.direction, search.end(), local);
    }
    const glm::dmat3 linear(this->fromScene);
    const glm::dvec3 origin = linear * ray.origin + shift, direction = linear * ray.direction;
    return isUsable(origin, direction) &&
      enterBox(this->hierarchy->entry(), origin, direction, search.end(), local);
  }
};

class TopLevel
{
public:
  // Members lie in the order of the placed hierarchies. Returns whether anything has moved.
  bool update(Device& device, std::vector<Placed> placed, std::vector<Member> members);

  std::size_t size() const { return this->Parts.size(); }
  const Placed& part(std::size_t i) const { return this->Parts[i]; }
  const Member* membersOf(const Placed& part) const
  {
    return this->Members.data() + part.firstMember;
  }
  // Of several parts; its leaves are parts.
  const WideTree& tree() const { return this->Tree; }
  const TraversalBox& box() const { return this->Box; }
  const EntryBox& entry() const { return this->Entry; }
  const Placed& leaf(std::uint32_t i) const { return this->Parts[this->PartOfLeaf[i]]; }

private:
  void rebuild(Device& device);
  void fit();

  std::vector<Placed> Parts;
  std::vector<Member> Members;
  TraversalBox Box;
  EntryBox Entry;
  WideTree Tree;
  std::vector<std::uint32_t> PartOfLeaf;
  double CostWhenBuilt = 0.0;
};

} // namespace embree
} // namespace hrt
