// The oracle of the kd-tree's build: the same tree by the obvious algorithm, O(N log^2 N). Every cell
// clips its triangles anew, makes a list of all boxes' bounds, sorts it, and weighs each plane with
// counts taken the way the definition reads. Common to both builders are the cost function, the rule for
// ties and the clipping of one triangle, which have tests of their own.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"

#include <vector>

namespace hrt
{
namespace reference
{

struct NaiveKdTree
{
  std::vector<KdNode> nodes; // the root is the first; children side by side
  std::vector<std::uint32_t> references;
  KdBox box;
};

NaiveKdTree naiveKdTree(const Geometry& geometry);

} // namespace reference
} // namespace hrt
