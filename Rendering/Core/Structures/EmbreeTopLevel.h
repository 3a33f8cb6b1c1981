// All hierarchies at their places in the scene and, when there are several, one tree over their
// boxes: the upper of the two levels that a ray goes through.
#pragma once

#include "Rendering/Core/Structures/EmbreeHierarchy.h"
#include "Rendering/Core/Structures/Placement.h"

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
  Placement placement;
  double near = 0.0; // rays from within so much of the scene's coordinates are near ones
  TraversalBox box;  // in scene coordinates
  std::size_t firstMember = 0;
  bool visibleToRays = false; // some member is
  bool castsShadow = false;

  bool operator==(const Placed& o) const
  {
    return hierarchy == o.hierarchy && fromScene == o.fromScene && box.lower == o.box.lower &&
      box.upper == o.box.upper;
  }

  // For a near ray all roundings in double are covered by TraversalBox::padding.
  void setNear() { this->near = nearFor(this->placement, this->hierarchy->box()); }
  static double nearFor(const Placement& placement, const TraversalBox& box)
  {
    return box.reach() * 0x1p-24 / placement.perUnit - placement.sceneReach;
  }

  // The ray as the hierarchy's tree sees it; false when it misses it. `margin` beyond the padding
  // is zero for a near ray, whose `box` is the hierarchy's entry.
  HRT_ALWAYS_INLINE bool enter(
    const Search& search, const EntryBox& box, double margin, TraversalRay& local) const
  {
    const Ray& ray = *search.ray;
    const glm::dvec3 shift(this->fromScene[3]);
    if (this->onlyShifted)
    {
      return enterBox(box, ray.origin + shift, ray.direction, search.end(), margin, local);
    }
    const glm::dmat3 linear(this->fromScene);
    return enterBox(
      box, linear * ray.origin + shift, linear * ray.direction, search.end(), margin, local);
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
  // Of a placed part: for the upper tree.
  const Placement& placement() const { return this->Place; }
  double near() const { return this->Near; }
  const Placed& leaf(std::uint32_t i) const { return this->Parts[this->PartOfLeaf[i]]; }

private:
  void rebuild(Device& device);
  void fit();

  std::vector<Placed> Parts;
  std::vector<Member> Members;
  TraversalBox Box;
  EntryBox Entry;
  Placement Place;
  double Near = 0.0;
  WideTree Tree;
  std::vector<std::uint32_t> PartOfLeaf;
  double CostWhenBuilt = 0.0;
};

} // namespace embree
} // namespace hrt
