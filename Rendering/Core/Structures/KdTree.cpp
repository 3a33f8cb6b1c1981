// What a finished kd-tree tells of itself.
#include "Rendering/Core/Structures/KdTreeCells.h"
#include "Rendering/Core/Structures/KdTreeCost.h"

#include <ostream>

namespace hrt
{

namespace
{

// Sums over the tree, each node weighted by the probability that a random line through the root's box
// meets the node's (section 3.1 of Wald and Havran 2006).
class QualitySum
{
public:
  QualitySum(const KdNode* nodes, const KdBox& box, KdTreeQuality& quality)
    : Nodes(nodes)
    , Root(kdcost::halfSurface(box))
    , Quality(quality)
  {
    this->add(0, box, 0);
  }

private:
  void add(std::size_t index, const KdBox& box, int depth)
  {
    const KdNode& node = this->Nodes[index];
    const double met = this->Root > 0.0 ? kdcost::halfSurface(box) / this->Root : 1.0;
    if (node.isLeaf())
    {
      this->addLeaf(node, met, depth);
      return;
    }
    ++this->Quality.innerNodes;
    this->Quality.expectedInnerVisits += met;
    this->Quality.cost += met * kdcost::kStep;
    KdBox below = box, above = box;
    below.upper[static_cast<int>(node.axis())] = node.split();
    above.lower[static_cast<int>(node.axis())] = node.split();
    this->add(node.children(), below, depth + 1);
    this->add(node.children() + 1, above, depth + 1);
  }

  void addLeaf(const KdNode& leaf, double met, int depth)
  {
    KdTreeQuality& q = this->Quality;
    ++q.leaves;
    q.emptyLeaves += leaf.count() == 0;
    q.references += leaf.count();
    q.longestList = std::max<std::uint64_t>(q.longestList, leaf.count());
    q.depth = std::max(q.depth, depth);
    q.expectedLeafVisits += met;
    q.expectedTriangleTests += met * leaf.count();
    q.cost += met * kdcost::testCost(leaf.count());
  }

  const KdNode* Nodes;
  double Root;
  KdTreeQuality& Quality;
};

// The same over the groups, none of which refers to an earlier one: `met` is the groups' probability.
void sumGroups(const HugePageVector<KdCells>& groups, const KdBox& box, KdTreeQuality& quality)
{
  const double root = kdcost::halfSurface(box);
  std::vector<double> met(groups.size(), 1.0);
  for (std::size_t i = 0; i < groups.size(); ++i)
  {
    quality.expectedSteps += met[i];
    for (int lane = 0; lane < KdCells::kLanes; ++lane)
    {
      const KdBox cell = groups[i].box(lane);
      if (cell.empty())
      {
        continue;
      }
      const double probability = root > 0.0 ? kdcost::halfSurface(cell) / root : 1.0;
      if (!groups[i].isLeaf(lane))
      {
        met[groups[i].child[lane]] = probability;
        continue;
      }
      quality.expectedLeaves += probability;
      quality.expectedBlockTests += probability * groups[i].blocks[lane];
    }
  }
}

} // namespace

KdTree::KdTree() = default;
KdTree::~KdTree() = default;

KdTreeQuality KdTree::quality() const
{
  KdTreeQuality quality;
  quality.triangles = this->Count;
  quality.groups = this->Groups.size();
  quality.blocks = this->Blocks.size();
  quality.bytes = this->Nodes.size() * sizeof(KdNode) +
    this->References.size() * sizeof(std::uint32_t) + this->Groups.size() * sizeof(KdCells) +
    this->Blocks.size() * sizeof(TriangleBlock);
  quality.depthLimit = this->DepthLimit;
  quality.milliseconds = this->Milliseconds;
  if (quality.triangles > 0)
  {
    QualitySum(this->nodes(), this->Box, quality);
    sumGroups(this->Groups, this->Box, quality);
  }
  return quality;
}

std::ostream& operator<<(std::ostream& stream, const KdTreeQuality& q)
{
  return stream << q.triangles << " triangles, " << q.references << " references, " << q.innerNodes
                << " inner nodes, " << q.leaves << " leaves (" << q.emptyLeaves
                << " empty, longest list " << q.longestList << "), depth " << q.depth << " of "
                << q.depthLimit << ", " << q.groups << " groups of cells, " << q.blocks
                << " blocks, " << q.bytes << " bytes, built in " << q.milliseconds
                << " ms; expected of a random line: cost " << q.cost << ", "
                << q.expectedInnerVisits << " inner nodes, " << q.expectedLeafVisits << " leaves, "
                << q.expectedTriangleTests << " triangles; by groups " << q.expectedSteps
                << " steps, " << q.expectedLeaves << " leaves, " << q.expectedBlockTests
                << " block tests";
}

} // namespace hrt
