// The cost model of the kd-tree, on its own so that the naive builder of the tests applies the very
// same numbers.
//
// I. Wald, V. Havran: "On building fast kd-trees for ray tracing, and on doing that in O(N log N)",
// IEEE Symposium on Interactive Ray Tracing 2006, section 3. A random line that meets a cell meets a
// convex part of it with the probability of the ratio of their surfaces.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace kdcost
{

// One step through a node against one triangle test (KdTreeTraversal.h), by the clock.
inline constexpr double kStep = 2.5;
// A split that cuts off empty space is favoured: section 3.3 of the paper.
inline constexpr double kEmptyBonus = 0.8;

// Half of a box' surface.
inline double halfSurface(const KdBox& box)
{
  const glm::dvec3 size = glm::dvec3(box.upper) - glm::dvec3(box.lower);
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

// The cost of splitting one cell along one axis, times half of the cell's surface: without a
// division the candidates compare just as well.
class SplitCost
{
public:
  SplitCost(const KdBox& cell, int axis)
    : Lower(cell.lower[axis])
    , Upper(cell.upper[axis])
    , Step(kStep * halfSurface(cell))
  {
    const glm::dvec3 size = glm::dvec3(cell.upper) - glm::dvec3(cell.lower);
    const double width = size[(axis + 1) % 3], height = size[(axis + 2) % 3];
    this->Face = width * height;
    this->Girth = width + height;
  }

  double operator()(float plane, double below, double above) const
  {
    const double lowerSurface = this->Face + (double(plane) - this->Lower) * this->Girth;
    const double upperSurface = this->Face + (this->Upper - double(plane)) * this->Girth;
    const double cost = this->Step + (lowerSurface * below + upperSurface * above);
    return below == 0.0 || above == 0.0 ? kEmptyBonus * cost : cost;
  }

private:
  double Lower, Upper, Step, Face, Girth;
};

// The cost of leaving the cell as it is, on the same scale.
inline double leafCost(const KdBox& cell, std::size_t triangles)
{
  return halfSurface(cell) * double(triangles);
}

// Havran's rule for the greatest useful depth, 8 + 1.3 log2 N. It only ends hopeless cases - the
// cost ends all others - and is therefore kept at 48 for small inputs; the traversal's stack and
// the bound of KdTree::padding rely on 64.
inline constexpr int kDepthLimitLeast = 48;
inline constexpr int kDepthLimitMost = 64;
inline int depthLimit(std::size_t triangles)
{
  const double rule = 8.0 + 1.3 * std::log2(std::max<double>(1.0, double(triangles)));
  return std::clamp(static_cast<int>(rule), kDepthLimitLeast, kDepthLimitMost);
}

} // namespace kdcost
} // namespace hrt
