// The kd-tree while it is being built: pieces, each finished by one thread, below a tree of the cells that
// were too large for that; and how they become one tree, in an order that depends on the tree alone.
#pragma once

#include "Rendering/Core/Structures/KdTreeCells.h"

#include <memory>
#include <vector>

namespace hrt
{

// A finished piece of the tree. Numbers of children and references count from its own start; the root is
// the first node, and the second is left out to keep pairs at even places.
struct KdPiece
{
  std::vector<KdNode> nodes;
  std::vector<std::uint32_t> references;
  std::vector<KdLeaf> leaves; // those that list triangles, lower cells first
};

// The tree of the large cells.
struct KdBranch
{
  int axis = -1; // -1: a piece, else two branches
  float plane = 0.0f;
  std::unique_ptr<KdBranch> below, above;
  KdPiece piece;
};

// Copies the pieces into one tree. Throws std::length_error when it does not fit KdNode's numbers.
void layOutPieces(const KdBranch& root, std::vector<KdNode>& nodes,
  std::vector<std::uint32_t>& references, std::vector<KdLeaf>& leaves);

} // namespace hrt
