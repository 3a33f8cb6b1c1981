// Lays out the pieces of a build.
#include "Rendering/Core/Structures/KdTreePieces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace hrt
{

namespace
{

// Where a piece goes in the whole tree.
struct Place
{
  const KdPiece* piece;
  std::size_t root;       // its first node
  std::size_t nodes;      // the others
  std::size_t references;
  std::size_t leaves;
};

// Numbers the nodes of the large cells and the places of the pieces, depth first.
class Layout
{
public:
  Layout(const KdBranch& root, std::vector<KdNode>& large)
    : Large(large)
  {
    this->Large.resize(2);
    this->visit(root, 0);
    this->Nodes = this->Large.size();
    for (Place& place : this->Places)
    {
      place.nodes = this->Nodes;
      place.references = this->References;
      place.leaves = this->Leaves;
      this->Nodes += place.piece->nodes.size() - 2;
      this->References += place.piece->references.size();
      this->Leaves += place.piece->leaves.size();
    }
  }

  const std::vector<Place>& places() const { return this->Places; }
  std::size_t nodes() const { return this->Nodes; }
  std::size_t references() const { return this->References; }
  std::size_t leaves() const { return this->Leaves; }

private:
  void visit(const KdBranch& branch, std::size_t node)
  {
    if (branch.axis < 0)
    {
      this->Places.push_back({ &branch.piece, node, 0, 0, 0 });
      return;
    }
    const std::size_t children = this->Large.size();
    this->Large.resize(children + 2);
    this->Large[node] =
      KdNode::inner(branch.axis, branch.plane, static_cast<std::uint32_t>(children));
    this->visit(*branch.below, children);
    this->visit(*branch.above, children + 1);
  }

  std::vector<KdNode>& Large;
  std::vector<Place> Places;
  std::size_t Nodes = 0;
  std::size_t References = 0;
  std::size_t Leaves = 0;
};

KdNode moved(const KdNode& node, const Place& place)
{
  if (node.isLeaf())
  {
    return KdNode::leaf(
      node.first() + static_cast<std::uint32_t>(place.references), node.count());
  }
  const std::size_t children = node.children() - 2 + place.nodes;
  return KdNode::inner(
    static_cast<int>(node.axis()), node.split(), static_cast<std::uint32_t>(children));
}

void copyPiece(const Place& place, std::vector<KdNode>& nodes,
  std::vector<std::uint32_t>& references, std::vector<KdLeaf>& leaves)
{
  const KdPiece& piece = *place.piece;
  const auto at = [](auto& list, std::size_t i) { return list.begin() + std::ptrdiff_t(i); };
  nodes[place.root] = moved(piece.nodes[0], place);
  std::transform(at(piece.nodes, 2), piece.nodes.end(), at(nodes, place.nodes),
    [&](const KdNode& node) { return moved(node, place); });
  std::copy(piece.references.begin(), piece.references.end(), at(references, place.references));
  std::transform(piece.leaves.begin(), piece.leaves.end(), at(leaves, place.leaves),
    [&](KdLeaf leaf) {
      leaf.first += static_cast<std::uint32_t>(place.references);
      return leaf;
    });
}

} // namespace

void layOutPieces(const KdBranch& root, std::vector<KdNode>& nodes,
  std::vector<std::uint32_t>& references, std::vector<KdLeaf>& leaves)
{
  const Layout layout(root, nodes);
  if (layout.nodes() >= kKdTreeMaximumTriangles ||
    layout.references() > std::numeric_limits<std::uint32_t>::max())
  {
    throw std::length_error("kd-tree: too many nodes or references for 32 bits");
  }
  nodes.resize(layout.nodes());
  references.resize(layout.references());
  leaves.resize(layout.leaves());
  tbb::parallel_for(std::size_t(0), layout.places().size(),
    [&](std::size_t i) { copyPiece(layout.places()[i], nodes, references, leaves); });
}

} // namespace hrt
