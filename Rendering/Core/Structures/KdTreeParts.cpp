// Builds the tree over the parts.
#include "Rendering/Core/Structures/KdTreeParts.h"

#include <numeric>

namespace hrt
{

namespace
{

int longestAxis(const glm::dvec3& size)
{
  if (size.x >= size.y && size.x >= size.z)
  {
    return 0;
  }
  return size.y >= size.z ? 1 : 2;
}

} // namespace

KdTreeParts::KdTreeParts(const std::vector<PartBox>& boxes)
{
  if (boxes.empty())
  {
    return;
  }
  std::vector<std::uint32_t> parts(boxes.size());
  std::iota(parts.begin(), parts.end(), 0u);
  this->Nodes.reserve(2 * boxes.size());
  this->Nodes.resize(1);
  this->split(0, parts.data(), parts.size(), boxes);
  this->Reach = this->Nodes[0].box.reach();
}

void KdTreeParts::split(std::size_t node, std::uint32_t* parts, std::size_t count,
  const std::vector<PartBox>& boxes)
{
  PartBox centres;
  const auto centre = [&](std::uint32_t part) { return boxes[part].lower + boxes[part].upper; };
  for (std::size_t i = 0; i < count; ++i)
  {
    this->Nodes[node].box.include(boxes[parts[i]]);
    centres.include(centre(parts[i]));
  }
  if (count == 1)
  {
    this->Nodes[node].part = parts[0];
    return;
  }
  const int axis = longestAxis(centres.upper - centres.lower);
  const std::size_t half = count / 2;
  std::nth_element(parts, parts + half, parts + count, [&](std::uint32_t a, std::uint32_t b) {
    const double ca = centre(a)[axis], cb = centre(b)[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const std::size_t children = this->Nodes.size();
  this->Nodes.resize(children + 2);
  this->Nodes[node].children = static_cast<std::uint32_t>(children);
  this->split(children, parts, half, boxes);
  this->split(children + 1, parts + half, count - half, boxes);
}

} // namespace hrt
