// Implements the upper level: refitted when parts have moved, and built anew when parts came or went or
// when refitting has made it too much worse.
#include "Rendering/Core/Structures/BvhTopLevel.h"

#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <utility>

namespace hrt
{
namespace bvh
{

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

} // namespace

Member memberOf(const Part& part, const glm::dvec3& sceneOrigin, std::size_t copy)
{
  return { positionsToScene(part, sceneOrigin, copy), part.firstTriangle, part.visibleToRays,
    part.castsShadow };
}

namespace
{

template <class Sets, class Same>
bool alike(const Sets& a, const Sets& b, Same same)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

} // namespace

void Placed::place(const Hierarchy& own, const Member& member)
{
  this->hierarchy = &own;
  const glm::dmat4& toScene = member.toScene;
  const glm::dmat3 inverse = glm::inverse(glm::dmat3(toScene));
  this->fromScene = glm::dmat4(inverse);
  this->fromScene[3] = glm::dvec4(-(inverse * glm::dvec3(toScene[3])), 1.0);
  this->onlyShifted = inverse == glm::dmat3(1.0);
  this->placement = Placement(toScene, inverse, own.box().reach());
  this->setNear();
  this->visibleToRays = member.visibleToRays;
  this->castsShadow = member.castsShadow;
}

void Placed::setBox(const Hierarchy& own, const Member& member)
{
  this->box = boxInScene(own.box(), member.toScene);
}

Member PlacedCopies::member(std::size_t copy) const
{
  Member member = memberOf(this->part, this->origin, copy);
  member.firstTriangle +=
    static_cast<TriangleId>(copy * this->part.geometry->triangleCount());
  return member;
}

TraversalBox PlacedCopies::box(std::size_t copy) const
{
  return boxInScene(this->hierarchy->box(), this->member(copy).toScene);
}

bool TopLevel::update(Device& device, TopLevelParts parts, Coincidence coincidence)
{
  this->Surfaces = std::move(coincidence);
  const auto sameHierarchy = [](const auto& a, const auto& b) { return a.hierarchy == b.hierarchy; };
  const bool same = this->Of.placed == parts.placed && this->Of.copies == parts.copies;
  const bool sameHierarchies = alike(this->Of.placed, parts.placed, sameHierarchy) &&
    alike(this->Of.copies, parts.copies, sameHierarchy) &&
    alike(this->Of.copies, parts.copies,
      [](const auto& a, const auto& b) { return a.part.copyCount() == b.part.copyCount(); });
  // Assigned in any case: who is seen and who casts may differ.
  this->Of = std::move(parts);
  for (Placed& placed : this->Of.placed)
  {
    placed.members = this->Of.members.data() + placed.firstMember;
  }
  this->FirstCopy.clear();
  this->Count = this->Of.placed.size();
  for (const PlacedCopies& group : this->Of.copies)
  {
    this->FirstCopy.push_back(this->Count - this->Of.placed.size());
    this->Count += group.part.copyCount();
  }
  if (same)
  {
    return false;
  }
  if (sameHierarchies)
  {
    this->fit();
  }
  if (!sameHierarchies || this->Tree.cost() > kWorstDecay * this->CostWhenBuilt)
  {
    this->rebuild(device);
  }
  return true;
}

// The part that the copy belongs to; `copy` becomes its number there.
const PlacedCopies& TopLevel::groupOf(std::size_t& copy) const
{
  const auto after = std::upper_bound(this->FirstCopy.begin(), this->FirstCopy.end(), copy);
  copy -= after[-1];
  return this->Of.copies[static_cast<std::size_t>(after - this->FirstCopy.begin()) - 1];
}

const Placed& TopLevel::copy(std::size_t i, PlacedScratch& scratch) const
{
  const PlacedCopies& group = this->groupOf(i);
  scratch.member = group.member(i);
  scratch.placed.place(*group.hierarchy, scratch.member);
  scratch.placed.members = &scratch.member;
  return scratch.placed;
}

TraversalBox TopLevel::boxOf(std::size_t i) const
{
  if (i < this->Of.placed.size())
  {
    return this->Of.placed[i].box;
  }
  i -= this->Of.placed.size();
  const PlacedCopies& group = this->groupOf(i);
  return group.box(i);
}

void TopLevel::rebuild(Device& device)
{
  // Lists of a million copies that grow leave holes in the heap as large as themselves.
  std::vector<RTCBuildPrimitive> boxes;
  boxes.reserve(this->Count);
  for (std::size_t i = 0; i < this->Count && this->Count > 1; ++i)
  {
    const TraversalBox box = this->boxOf(i);
    const glm::vec3 lower(box.lower), upper(box.upper);
    boxes.push_back(
      { lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, static_cast<unsigned int>(i) });
  }
  const std::vector<WideTree::Leaf> leaves =
    this->Tree.build(device, boxes, 1, "building the hierarchy of the parts");
  this->PartOfLeaf.clear();
  this->PartOfLeaf.reserve(leaves.size());
  for (const WideTree::Leaf& leaf : leaves)
  {
    this->PartOfLeaf.push_back(leaf.box[0]);
  }
  this->fit();
  this->CostWhenBuilt = this->Tree.cost();
}

// Everything that follows from where the parts are.
void TopLevel::fit()
{
  this->Box = TraversalBox();
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    const TraversalBox box = this->boxOf(i);
    this->Box.include(box.lower);
    this->Box.include(box.upper);
  }
  this->Entry = EntryBox(this->Box);
  this->Place = Placement(glm::dmat4(1.0), glm::dmat3(1.0), this->Box.reach());
  this->Near = Placed::nearFor(this->Place, this->Box);
  this->Tree.fit(this->Box.padding(),
    [this](std::uint32_t leaf) { return this->boxOf(this->PartOfLeaf[leaf]); });
}

} // namespace bvh
} // namespace hrt
