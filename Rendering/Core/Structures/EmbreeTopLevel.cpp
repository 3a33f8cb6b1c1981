// Implements the upper level: refitted when parts have moved, and built anew when parts came or went or
// when refitting has made it too much worse.
#include "Rendering/Core/Structures/EmbreeTopLevel.h"

#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <utility>

namespace hrt
{
namespace embree
{

bool TopLevel::update(Device& device, std::vector<Placed> placed, std::vector<Member> members)
{
  this->Members = std::move(members);
  const bool same = this->Parts == placed;
  const bool sameHierarchies = std::equal(this->Parts.begin(), this->Parts.end(), placed.begin(),
    placed.end(), [](const Placed& a, const Placed& b) { return a.hierarchy == b.hierarchy; });
  // Assigned in any case: who is seen and who casts may differ.
  this->Parts = std::move(placed);
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

void TopLevel::rebuild(Device& device)
{
  std::vector<RTCBuildPrimitive> boxes;
  for (std::size_t i = 0; i < this->Parts.size() && this->Parts.size() > 1; ++i)
  {
    const TraversalBox& box = this->Parts[i].box;
    const glm::vec3 lower(box.lower), upper(box.upper);
    boxes.push_back(
      { lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, static_cast<unsigned int>(i) });
  }
  const std::vector<WideTree::Leaf> leaves =
    this->Tree.build(device, boxes, 1, "building the hierarchy of the parts");
  this->PartOfLeaf.clear();
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
  for (const Placed& part : this->Parts)
  {
    this->Box.include(part.box.lower);
    this->Box.include(part.box.upper);
  }
  this->Entry = EntryBox(this->Box);
  this->Place = Placement(glm::dmat4(1.0), glm::dmat3(1.0), this->Box.reach());
  this->Near = Placed::nearFor(this->Place, this->Box);
  this->Tree.fit(this->Box.padding(), [this](std::uint32_t leaf) { return this->leaf(leaf).box; });
}

} // namespace embree
} // namespace hrt
