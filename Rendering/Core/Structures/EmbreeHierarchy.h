// A hierarchy over triangles: the triangles of one geometry, or those of many parts merged into
// common coordinates. Embree builds and traverses it; its primitives are blocks of up to eight
// neighbouring triangles (TriangleBlock.h), whose possible hits the exact kernel decides.
#pragma once

#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/EmbreeSearch.h"

#include <array>
#include <memory>
#include <vector>

namespace hrt
{
namespace embree
{

// A triangle in the hierarchy's coordinates.
struct SourceTriangle
{
  std::array<glm::vec3, 3> corner;
  Source source;
};

class Hierarchy
{
public:
  // `positions`: the geometries' own, a triangle's corners each, where the hierarchy's coordinates
  // are others and their rounding has to be undone; else empty.
  Hierarchy(Device& device, const std::vector<SourceTriangle>& triangles,
    const std::vector<std::array<glm::vec3, 3>>& positions, Scene::Kind kind);
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;

  RTCScene scene() const { return this->Tree->handle(); }
  const TraversalBox& box() const { return this->Box; }
  const EntryBox& entry() const { return this->Entry; }

  // Moves the triangles of a hierarchy of one geometry to that geometry's new positions. False when
  // the hierarchy has become so much worse than it was when built that it is better built anew.
  bool refit(Device& device, const std::vector<glm::vec3>& positions);

private:
  friend struct BlockCallbacks;
  struct Node // of the tree that the blocks are the leaves of
  {
    std::uint32_t child[2]; // a node's number, or ~ the number of a block
  };
  struct Builder;
  struct Lanes;

  void setLane(std::size_t block, int lane, const std::array<glm::vec3, 3>& corner);
  double cost() const;
  static void boundsOf(const RTCBoundsFunctionArguments* arguments);

  struct alignas(64) BlockSources : std::array<Source, TriangleBlock::kLanes> // a cache line
  {
  };

  std::vector<TriangleBlock> Blocks;
  std::vector<BlockSources> Sources;
  std::vector<std::array<glm::vec3, 3>> Positions; // kLanes a block, if not those of the blocks
  std::vector<Node> Nodes;                         // children before parents
  TraversalBox Box;
  EntryBox Entry;
  SieveSlack Slack;
  double CostWhenBuilt = 0.0;
  std::unique_ptr<Scene> Tree;
};

} // namespace embree
} // namespace hrt
