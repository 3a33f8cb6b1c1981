// The upper level over the kd-trees: a binary tree over the boxes of the placed parts. Parts move from
// frame to frame and are few; it is built anew in no time, halving the parts at the median of their
// centres.
#pragma once

#include "Rendering/Core/Structures/KdTreeSlabs.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace hrt
{

struct PartBox
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  void include(const glm::dvec3& point)
  {
    this->lower = glm::min(this->lower, point);
    this->upper = glm::max(this->upper, point);
  }
  void include(const PartBox& box)
  {
    this->lower = glm::min(this->lower, box.lower);
    this->upper = glm::max(this->upper, box.upper);
  }
  double reach() const
  {
    const glm::dvec3 most = glm::max(glm::abs(this->lower), glm::abs(this->upper));
    return std::max({ most.x, most.y, most.z });
  }
};

class KdTreeParts
{
public:
  KdTreeParts() = default;
  explicit KdTreeParts(const std::vector<PartBox>& boxes);

  // Of all boxes; zero when there is none.
  double reach() const { return this->Reach; }

  // Calls visit(number of the part) for the parts whose boxes the ray meets at 0 <= t <= end, nearer ones
  // roughly first. It returns the new end; below zero ends the search.
  template <class Visit>
  void traverse(const KdSlabs& ray, double end, Visit&& visit) const;

private:
  struct Node
  {
    PartBox box;
    std::uint32_t children = 0; // the first; 0, the root, for a leaf
    std::uint32_t part = 0;     // of a leaf
  };
  void split(std::size_t node, std::uint32_t* parts, std::size_t count,
    const std::vector<PartBox>& boxes);

  std::vector<Node> Nodes;
  double Reach = 0.0;
};

template <class Visit>
void KdTreeParts::traverse(const KdSlabs& ray, double end, Visit&& visit) const
{
  struct Entry
  {
    std::uint32_t node;
    double start;
  };
  // The median halves the parts: 32 levels, of which each leaves one entry, and the two at hand.
  Entry stack[34];
  int size = 0;
  const auto push = [&](std::uint32_t node) {
    double start = 0.0, leave = end;
    const PartBox& box = this->Nodes[node].box;
    if (ray.meet(box.lower, box.upper, start, leave))
    {
      stack[size++] = { node, start };
    }
  };
  if (!this->Nodes.empty())
  {
    push(0);
  }
  while (size > 0)
  {
    const Entry entry = stack[--size];
    const Node& node = this->Nodes[entry.node];
    if (entry.start > end)
    {
      continue;
    }
    if (node.children == 0)
    {
      end = visit(node.part);
      continue;
    }
    const int before = size;
    push(node.children);
    push(node.children + 1);
    if (size == before + 2 && stack[before].start < stack[before + 1].start)
    {
      std::swap(stack[before], stack[before + 1]);
    }
  }
}

} // namespace hrt
