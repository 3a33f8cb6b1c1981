// Makes groups of cells and blocks of triangles from a finished tree.
#include "Rendering/Core/Structures/KdTreeCells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

namespace hrt
{

namespace
{

// Where each leaf's blocks begin, and where the last one's end.
std::vector<std::uint32_t> blockNumbers(const std::vector<KdLeaf>& leaves)
{
  std::vector<std::uint32_t> first(leaves.size() + 1, 0);
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    first[i + 1] = first[i] + kdcost::blocksOf(leaves[i].count);
  }
  return first;
}

class CellGrouping
{
public:
  CellGrouping(const std::vector<KdNode>& nodes, const std::vector<KdLeaf>& leaves)
    : Nodes(nodes)
    , Leaves(leaves)
    , Blocks(blockNumbers(leaves))
    , Fitted(nodes.size())
  {
    if (!leaves.empty())
    {
      this->fit(0);
      this->add(0);
    }
  }

  HugePageVector<KdCells>& groups() { return this->Groups; }

private:
  // A node's cell without the empty space in it.
  struct Cell
  {
    KdBox bounds;
    std::uint32_t leaf = 0; // number in Leaves
  };
  static constexpr std::size_t kLanes = KdCells::kLanes;
  using Lanes = std::array<std::uint32_t, kLanes>; // nodes

  bool isEmpty(std::uint32_t node) const { return this->Fitted[node].bounds.empty(); }

  void fit(std::uint32_t node);
  std::size_t largestInner(const Lanes& lanes, std::size_t used) const;
  std::size_t open(std::uint32_t node, Lanes& lanes) const;
  std::uint32_t add(std::uint32_t node);

  const std::vector<KdNode>& Nodes;
  const std::vector<KdLeaf>& Leaves;
  const std::vector<std::uint32_t> Blocks; // of Leaves
  std::vector<Cell> Fitted;                // by node
  HugePageVector<KdCells> Groups;
  std::uint32_t Next = 0; // of Leaves
};

void CellGrouping::fit(std::uint32_t node)
{
  Cell& cell = this->Fitted[node];
  const KdNode& n = this->Nodes[node];
  if (!n.isLeaf())
  {
    for (std::uint32_t child = n.children(); child < n.children() + 2; ++child)
    {
      this->fit(child);
      const KdBox& bounds = this->Fitted[child].bounds;
      cell.bounds.lower = glm::min(cell.bounds.lower, bounds.lower);
      cell.bounds.upper = glm::max(cell.bounds.upper, bounds.upper);
    }
  }
  else if (n.count() > 0)
  {
    cell.leaf = this->Next++;
    cell.bounds = this->Leaves[cell.leaf].bounds;
  }
}

// The lane of the largest cell that can be opened; `used` when there is none.
std::size_t CellGrouping::largestInner(const Lanes& lanes, std::size_t used) const
{
  std::size_t largest = used;
  double most = -1.0;
  for (std::size_t i = 0; i < used; ++i)
  {
    const double surface = kdcost::halfSurface(this->Fitted[lanes[i]].bounds);
    if (!this->Nodes[lanes[i]].isLeaf() && surface > most)
    {
      largest = i;
      most = surface;
    }
  }
  return largest;
}

// Replaces the node by those below it, until there is no more room; most rays meet the largest cells, so
// these come first. Returns how many lanes are used.
std::size_t CellGrouping::open(std::uint32_t node, Lanes& lanes) const
{
  std::size_t used = 1;
  lanes[0] = node;
  for (;;)
  {
    const std::size_t i = this->largestInner(lanes, used);
    if (i == used)
    {
      return used;
    }
    const std::uint32_t below = this->Nodes[lanes[i]].children(), above = below + 1;
    if (this->isEmpty(below) || this->isEmpty(above))
    {
      lanes[i] = this->isEmpty(below) ? above : below;
      continue;
    }
    if (used == kLanes)
    {
      return used;
    }
    lanes[i] = below;
    lanes[used++] = above;
  }
}

// Adds the group of a node, and those below. Returns its number.
std::uint32_t CellGrouping::add(std::uint32_t node)
{
  const std::size_t number = this->Groups.size();
  this->Groups.emplace_back();
  Lanes lanes{};
  const std::size_t used = this->open(node, lanes);
  for (std::size_t i = 0; i < kLanes; ++i)
  {
    const KdBox bounds = i < used ? this->Fitted[lanes[i]].bounds : KdBox();
    std::uint32_t child = KdCells::kLeaf, blocks = 0;
    if (i < used && this->Nodes[lanes[i]].isLeaf())
    {
      const std::uint32_t leaf = this->Fitted[lanes[i]].leaf;
      child |= this->Blocks[leaf];
      blocks = this->Blocks[leaf + 1] - this->Blocks[leaf];
    }
    else if (i < used)
    {
      child = this->add(lanes[i]);
    }
    KdCells& group = this->Groups[number];
    for (int axis = 0; axis < 3; ++axis)
    {
      group.bounds[axis][i] = bounds.lower[axis];
      group.bounds[3 + axis][i] = bounds.upper[axis];
    }
    group.child[i] = child;
    group.blocks[i] = blocks;
  }
  return static_cast<std::uint32_t>(number);
}

void copyLane(TriangleBlock& block, std::uint32_t lane, std::uint32_t triangle, const Geometry& mesh)
{
  block.triangle[lane] = triangle;
  const std::array<glm::vec3, 3> positions = mesh.cornerPositions(triangle);
  for (std::size_t corner = 0; corner < 3; ++corner)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      block.corner[corner][axis][lane] = positions[corner][axis];
    }
  }
}

} // namespace

HugePageVector<KdCells> groupCells(
  const std::vector<KdNode>& nodes, const std::vector<KdLeaf>& leaves)
{
  return std::move(CellGrouping(nodes, leaves).groups());
}

HugePageVector<TriangleBlock> copyTriangles(const std::vector<KdLeaf>& leaves,
  const std::vector<std::uint32_t>& references, const Geometry& mesh)
{
  const std::vector<std::uint32_t> numbers = blockNumbers(leaves);
  HugePageVector<TriangleBlock> blocks(numbers.back());
  const auto copy = [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
    {
      const KdLeaf& leaf = leaves[i];
      const std::uint32_t lanes = (numbers[i + 1] - numbers[i]) * kdcost::kBlock;
      for (std::uint32_t lane = 0; lane < lanes; ++lane)
      {
        const std::uint32_t triangle = references[leaf.first + std::min(lane, leaf.count - 1)];
        copyLane(blocks[numbers[i] + lane / kdcost::kBlock], lane % kdcost::kBlock, triangle, mesh);
      }
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 512), copy);
  return blocks;
}

} // namespace hrt
