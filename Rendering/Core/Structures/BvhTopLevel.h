// All hierarchies at their places in the scene and, when there are several, one tree over their
// boxes: the upper of the two levels that a ray goes through.
#pragma once

#include "Rendering/Core/Structures/BvhHierarchy.h"
#include "Rendering/Core/Structures/Placement.h"

#include <memory>
#include <vector>

namespace hrt
{
namespace bvh
{

// The part, or its copy of that number, as its hierarchy sees it.
Member memberOf(const Part& part, const glm::dvec3& sceneOrigin, std::size_t copy = 0);

// A hierarchy with its place in the scene.
struct Placed
{
  const Hierarchy* hierarchy = nullptr;
  glm::dmat4 fromScene{ 1.0 };
  bool onlyShifted = false; // fromScene is a translation
  Placement placement;
  double near = 0.0; // rays from within so much of the scene's coordinates are near ones
  TraversalBox box;  // in scene coordinates
  std::size_t firstMember = 0;
  const Member* members = nullptr;
  bool visibleToRays = false; // some member is
  bool castsShadow = false;

  // Of a hierarchy of one part in its own coordinates: everything that follows from the member's
  // matrix, but the box, and the box, which no ray asks for.
  void place(const Hierarchy& own, const Member& member);
  void setBox(const Hierarchy& own, const Member& member);

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

// The copies of a part (Copies.h), each of which is a leaf of the upper tree. Where a copy stands is
// derived from its matrix when a ray comes by: kept for a million of them it would fill the memory.
struct PlacedCopies
{
  const Hierarchy* hierarchy = nullptr;
  Part part;
  glm::dvec3 origin{ 0.0 }; // of the scene

  bool operator==(const PlacedCopies& o) const
  {
    return hierarchy == o.hierarchy && part.copies == o.part.copies &&
      part.localToWorld == o.part.localToWorld && origin == o.origin;
  }

  Member member(std::size_t copy) const;
  TraversalBox box(std::size_t copy) const; // in scene coordinates
};

// What the upper level is made of.
struct TopLevelParts
{
  std::vector<Placed> placed;
  std::vector<Member> members; // in the order of the placed hierarchies
  std::vector<PlacedCopies> copies;
  std::vector<std::shared_ptr<const Hierarchy>> hierarchies; // keeps those of the others alive
};

// Holds a copy that is placed while a ray goes through it.
struct PlacedScratch
{
  Placed placed;
  Member member;
};

class TopLevel
{
public:
  // Returns whether anything has moved.
  bool update(Device& device, TopLevelParts parts, Coincidence coincidence);

  // Placed hierarchies, each copy one.
  std::size_t size() const { return this->Count; }
  // Valid as long as the scratch is.
  const Placed& part(std::size_t i, PlacedScratch& scratch) const
  {
    return i < this->Of.placed.size() ? this->Of.placed[i]
                                      : this->copy(i - this->Of.placed.size(), scratch);
  }
  const Coincidence& coincidence() const { return this->Surfaces; }
  // Of several parts; its leaves are parts.
  const WideTree& tree() const { return this->Tree; }
  const TraversalBox& box() const { return this->Box; }
  const EntryBox& entry() const { return this->Entry; }
  // Of a placed part: for the upper tree.
  const Placement& placement() const { return this->Place; }
  double near() const { return this->Near; }
  const Placed& leaf(std::uint32_t i, PlacedScratch& scratch) const
  {
    return this->part(this->PartOfLeaf[i], scratch);
  }

private:
  void rebuild(Device& device);
  void fit();
  const PlacedCopies& groupOf(std::size_t& copy) const;
  const Placed& copy(std::size_t i, PlacedScratch& scratch) const;
  TraversalBox boxOf(std::size_t i) const;

  TopLevelParts Of;
  std::vector<std::size_t> FirstCopy; // of each part with copies, among all copies
  std::size_t Count = 0;
  Coincidence Surfaces;
  TraversalBox Box;
  EntryBox Entry;
  Placement Place;
  double Near = 0.0;
  WideTree Tree;
  std::vector<std::uint32_t> PartOfLeaf;
  double CostWhenBuilt = 0.0;
};

} // namespace bvh
} // namespace hrt
