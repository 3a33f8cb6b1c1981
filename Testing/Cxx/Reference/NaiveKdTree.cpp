// See NaiveKdTree.h.
#include "Testing/Cxx/Reference/NaiveKdTree.h"

#include "Rendering/Core/Structures/KdTreeClip.h"
#include "Rendering/Core/Structures/KdTreeCost.h"

#include <algorithm>

namespace hrt
{
namespace reference
{
namespace
{

// A triangle's part in a cell.
struct Part
{
  std::uint32_t triangle;
  KdBox box;
};
using Parts = std::vector<Part>;

enum Kind
{
  End,
  Planar,
  Start
};

struct Event
{
  float position;
  Kind kind;

  bool operator<(const Event& o) const
  {
    return position != o.position ? position < o.position : kind < o.kind;
  }
};

struct Split
{
  double cost;
  int axis = -1;
  float plane = 0.0f;
  bool planarBelow = false;
};

std::vector<Event> sortedEvents(const Parts& parts, int axis)
{
  std::vector<Event> events;
  for (const Part& part : parts)
  {
    if (part.box.lower[axis] == part.box.upper[axis])
    {
      events.push_back({ part.box.lower[axis], Planar });
      continue;
    }
    events.push_back({ part.box.lower[axis], Start });
    events.push_back({ part.box.upper[axis], End });
  }
  std::sort(events.begin(), events.end());
  return events;
}

// Algorithm 2 of Wald and Havran 2006: all events at one place counted, then the plane weighed with its
// planar triangles on either side. A side of the cell itself counts only if it gets triangles.
void weighPlanes(const Parts& parts, const KdBox& cell, int axis, Split& best)
{
  const kdcost::SplitCost cost(cell, axis);
  const float lower = cell.lower[axis], upper = cell.upper[axis];
  if (lower == upper)
  {
    return;
  }
  const std::vector<Event> events = sortedEvents(parts, axis);
  std::uint32_t below = 0, above = std::uint32_t(parts.size());
  for (std::size_t i = 0; i < events.size();)
  {
    const float plane = events[i].position;
    std::uint32_t ending = 0, planar = 0, starting = 0;
    for (; i < events.size() && events[i].position == plane; ++i)
    {
      ++(events[i].kind == End ? ending : events[i].kind == Planar ? planar : starting);
    }
    above -= planar + ending;
    const auto weigh = [&](std::uint32_t l, std::uint32_t r, bool planarBelow) {
      const double c = cost(plane, l, r);
      if (c < best.cost)
      {
        best = { c, axis, plane, planarBelow };
      }
    };
    if (plane > lower && (plane < upper || planar > 0))
    {
      weigh(below, above + planar, false);
    }
    if (plane < upper && planar > 0)
    {
      weigh(below + planar, above, true);
    }
    below += planar + starting;
  }
}

class Builder
{
public:
  explicit Builder(const Geometry& geometry)
    : Mesh(geometry)
    , DepthLimit(kdcost::depthLimit(geometry.triangleCount()))
  {
    Parts parts;
    for (std::uint32_t i = 0; i < geometry.triangleCount(); ++i)
    {
      KdBox box;
      for (const glm::vec3& corner : geometry.cornerPositions(i))
      {
        box.include(corner + 0.0f);
        this->Tree.box.include(corner + 0.0f);
      }
      parts.push_back({ i, box });
    }
    this->Tree.nodes.resize(1);
    this->build(0, parts, this->Tree.box, 0);
  }

  NaiveKdTree& tree() { return this->Tree; }

private:
  void build(std::size_t node, const Parts& parts, const KdBox& cell, int depth)
  {
    Split split{ kdcost::leafCost(cell, std::uint32_t(parts.size())) };
    for (int axis = 0; axis < 3 && depth < this->DepthLimit; ++axis)
    {
      weighPlanes(parts, cell, axis, split);
    }
    if (split.axis < 0)
    {
      this->Tree.nodes[node] =
        KdNode::leaf(std::uint32_t(this->Tree.references.size()), std::uint32_t(parts.size()));
      for (const Part& part : parts)
      {
        this->Tree.references.push_back(part.triangle);
      }
      return;
    }
    Parts below, above;
    for (const Part& part : parts)
    {
      this->sort(part, cell, split, below, above);
    }
    const std::size_t children = this->Tree.nodes.size();
    this->Tree.nodes.resize(children + 2);
    this->Tree.nodes[node] = KdNode::inner(split.axis, split.plane, std::uint32_t(children));
    KdBox lowerCell = cell, upperCell = cell;
    lowerCell.upper[split.axis] = upperCell.lower[split.axis] = split.plane;
    this->build(children, below, lowerCell, depth + 1);
    this->build(children + 1, above, upperCell, depth + 1);
  }

  void sort(
    const Part& part, const KdBox& cell, const Split& split, Parts& below, Parts& above) const
  {
    const float lower = part.box.lower[split.axis], upper = part.box.upper[split.axis];
    const bool planar = lower == split.plane && upper == split.plane;
    if (planar ? split.planarBelow : upper <= split.plane)
    {
      below.push_back(part);
      return;
    }
    if (planar || lower >= split.plane)
    {
      above.push_back(part);
      return;
    }
    const KdSplitBounds bounds = splitTriangle(
      this->Mesh.cornerPositions(part.triangle).data(), cell, split.axis, split.plane);
    below.push_back({ part.triangle, bounds.lower });
    above.push_back({ part.triangle, bounds.upper });
  }

  const Geometry& Mesh;
  int DepthLimit;
  NaiveKdTree Tree;
};

} // namespace

NaiveKdTree naiveKdTree(const Geometry& geometry)
{
  return std::move(Builder(geometry).tree());
}

} // namespace reference
} // namespace hrt
