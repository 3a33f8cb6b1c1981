// The kd-tree as rays go through it: the same cells and lists as its nodes, eight at a time.
//
// A node of KdTree.h decides between two cells. A ray needs dozens of such decisions; of many a processor
// guesses the outcome wrong, and for some it waits for memory. Here three levels and more make one group: up
// to eight cells, met together by vector instructions. Of each cell there are the bounds of the parts of triangles in it,
// which the builder knows: empty space is not visited, and empty cells are not there. Leaves hold copies of
// their triangles, eight a block, for the sieve of TriangleBlock.h.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"
#include "Rendering/Core/Structures/KdTreeCost.h"
#include "Rendering/Core/Structures/TriangleBlock.h"

namespace hrt
{

// Four cache lines.
struct alignas(64) KdCells
{
  static constexpr int kLanes = 8;
  static constexpr std::uint32_t kLeaf = 1u << 31;

  float bounds[6][kLanes];      // lower x, y, z, then upper; the wrong way round in an unused lane
  std::uint32_t child[kLanes];  // another group's number, or kLeaf and a leaf's first block
  std::uint32_t blocks[kLanes]; // of a leaf

  bool isLeaf(int lane) const { return (this->child[lane] & kLeaf) != 0; }
  std::uint32_t firstBlock(int lane) const { return this->child[lane] & ~kLeaf; }
  KdBox box(int lane) const
  {
    return { { this->bounds[0][lane], this->bounds[1][lane], this->bounds[2][lane] },
      { this->bounds[3][lane], this->bounds[4][lane], this->bounds[5][lane] } };
  }
};

static_assert(kdcost::kBlock == TriangleBlock::kLanes, "the cost counts these blocks");

// A leaf that lists triangles, as the builder leaves it.
struct KdLeaf
{
  KdBox bounds;        // of the triangles' parts in the cell
  std::uint32_t first; // of its list in KdTree::references
  std::uint32_t count;
};

// Groups the cells below the first node. `leaves`: those that list triangles, lower cells first.
HugePageVector<KdCells> groupCells(
  const std::vector<KdNode>& nodes, const std::vector<KdLeaf>& leaves);

// Copies the leaves' triangles.
HugePageVector<TriangleBlock> copyTriangles(const std::vector<KdLeaf>& leaves,
  const std::vector<std::uint32_t>& references, const Geometry& mesh);

} // namespace hrt
