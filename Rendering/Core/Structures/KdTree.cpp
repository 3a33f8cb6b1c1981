// What a finished kd-tree tells of itself.
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
  }

  const KdNode* Nodes;
  double Root;
  KdTreeQuality& Quality;
};

} // namespace

KdTreeQuality KdTree::quality() const
{
  KdTreeQuality quality;
  quality.triangles = this->Count;
  quality.bytes = this->Lines.size() * sizeof(KdNodeLine) +
    this->References.size() * sizeof(std::uint32_t) +
    this->Triangles.size() * sizeof(KdTriangle);
  quality.depthLimit = this->DepthLimit;
  quality.milliseconds = this->Milliseconds;
  if (quality.triangles > 0)
  {
    QualitySum(this->nodes(), this->Box, quality);
  }
  quality.cost =
    kdcost::kStep * quality.expectedInnerVisits + quality.expectedTriangleTests;
  return quality;
}

std::ostream& operator<<(std::ostream& stream, const KdTreeQuality& q)
{
  return stream << q.triangles << " triangles, " << q.references << " references, " << q.innerNodes
                << " inner nodes, " << q.leaves << " leaves (" << q.emptyLeaves
                << " empty, longest list " << q.longestList << "), depth " << q.depth << " of "
                << q.depthLimit << ", " << q.bytes << " bytes, built in " << q.milliseconds
                << " ms; expected of a random line: cost " << q.cost << ", "
                << q.expectedInnerVisits << " steps, " << q.expectedLeafVisits << " leaves, "
                << q.expectedTriangleTests << " triangle tests";
}

} // namespace hrt
