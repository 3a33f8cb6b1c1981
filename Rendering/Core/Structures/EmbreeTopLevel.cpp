// Implements the upper level: built anew whenever a part has moved, which for a few hundred parts
// takes a fraction of a millisecond.
#include "Rendering/Core/Structures/EmbreeTopLevel.h"

#include <utility>

namespace hrt
{
namespace embree
{

bool TopLevel::update(Device& device, std::vector<Placed> placed, std::vector<Member> members)
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

void TopLevel::rebuild(Device& device)
{
  this->Box = TraversalBox();
  std::vector<RTCBuildPrimitive> boxes;
  for (std::size_t i = 0; i < this->Parts.size() && this->Parts.size() > 1; ++i)
  {
    const TraversalBox& box = this->Parts[i].box;
    this->Box.include(box.lower);
    this->Box.include(box.upper);
    const glm::vec3 lower(box.lower), upper(box.upper);
    boxes.push_back(
      { lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, static_cast<unsigned int>(i) });
  }
  this->Entry = EntryBox(this->Box);
  const std::vector<WideTree::Leaf> leaves =
    this->Tree.build(device, boxes, 1, "building the hierarchy of the parts");
  this->PartOfLeaf.clear();
  for (const WideTree::Leaf& leaf : leaves)
  {
    this->PartOfLeaf.push_back(leaf.box[0]);
  }
  this->Tree.fit(this->Box.padding(), [this](std::uint32_t leaf) { return this->leaf(leaf).box; });
}

} // namespace embree
} // namespace hrt
