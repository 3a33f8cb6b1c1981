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

// The unit of cost is one test of a block, up to kBlock triangles at once (KdTreeCells.h): a list costs
// the blocks that it takes. What each triangle costs besides, by memory and exact tests, is little, but
// must not be nothing: the sweep of KdTreeSplit.cpp relies on every triangle to add to the cost.
inline constexpr std::uint32_t kBlock = 8;
inline constexpr double kTriangle = 0.01;
// One step from a cell to the two below it. Rays take about three of them at a time, so that a step is
// less than a test by the clock; but a finer tree has more blocks that are not full, and waits for memory
// more. Between 0.4 and 1.2 the rays per second hardly change, while the tree at 0.4 is half as large
// again, and takes half as long again to build, as at 1.2.
inline constexpr double kStep = 0.8;
// A split that cuts off empty space is favoured: section 3.3 of the paper.
inline constexpr double kEmptyBonus = 0.8;

inline std::uint32_t blocksOf(std::uint32_t triangles)
{
  return triangles / kBlock + (triangles % kBlock != 0);
}

inline double testCost(std::uint32_t triangles)
{
  return double(blocksOf(triangles)) + kTriangle * double(triangles);
}

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

  double operator()(float plane, std::uint32_t below, std::uint32_t above) const
  {
    const double lowerSurface = this->Face + (double(plane) - this->Lower) * this->Girth;
    const double upperSurface = this->Face + (this->Upper - double(plane)) * this->Girth;
    const double cost =
      this->Step + (lowerSurface * testCost(below) + upperSurface * testCost(above));
    return below == 0 || above == 0 ? kEmptyBonus * cost : cost;
  }

private:
  double Lower, Upper, Step, Face, Girth;
};

// The cost of leaving the cell as it is, on the same scale.
inline double leafCost(const KdBox& cell, std::uint32_t triangles)
{
  return halfSurface(cell) * testCost(triangles);
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
