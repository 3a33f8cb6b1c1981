// The paper's acceleration structure: a kd-tree over the triangles of one geometry, in the
// coordinates of its positions. Built by the O(N log N) surface area heuristic (KdTreeBuilder.cpp),
// traversed without an epsilon (KdTreeTraversal.h) in a layout made for that (KdTreeCells.h). It proposes
// triangles; which of them a ray meets is decided elsewhere, by Geometry/TriangleIntersection.h.
//
// What the tree promises. Every point of a triangle lies in, or within `padding` of, the closed cell
// of a leaf that lists the triangle, and of the bounds that the leaf has in KdTreeCells.h. A traversal that
// visits every cell within that distance of the ray therefore misses nothing.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/HugePages.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <vector>

namespace hrt
{

// Eight bytes: a split plane and where the two children are, or a leaf's list of triangles. Children
// lie side by side, the lower one at an even number: one cache line holds both.
class KdNode
{
public:
  static KdNode inner(int axis, float split, std::uint32_t children)
  {
    KdNode node;
    node.Split = split;
    node.Word = children << 2 | static_cast<std::uint32_t>(axis);
    return node;
  }
  static KdNode leaf(std::uint32_t first, std::uint32_t count)
  {
    KdNode node;
    node.First = first;
    node.Word = count << 2 | kLeaf;
    return node;
  }

  // An empty leaf.
  KdNode()
    : First(0)
    , Word(kLeaf)
  {
  }

  bool isLeaf() const { return this->axis() == kLeaf; }
  unsigned axis() const { return this->Word & 3u; }
  float split() const { return this->Split; }
  std::uint32_t children() const { return this->Word >> 2; } // the lower one; the upper one follows
  std::uint32_t first() const { return this->First; }        // of the leaf's list
  std::uint32_t count() const { return this->Word >> 2; }

  bool operator==(const KdNode& o) const { return First == o.First && Word == o.Word; }

private:
  static constexpr std::uint32_t kLeaf = 3;
  union
  {
    float Split;
    std::uint32_t First;
  };
  std::uint32_t Word;
};
static_assert(sizeof(KdNode) == 8, "two children must fit a quarter of a cache line");

// Numbers that a build of N triangles may at most use: 30 bits for a node or a list's length.
inline constexpr std::uint32_t kKdTreeMaximumTriangles = 1u << 30;

struct KdBox
{
  glm::vec3 lower{ std::numeric_limits<float>::infinity() };
  glm::vec3 upper{ -std::numeric_limits<float>::infinity() };

  bool empty() const { return !(this->lower.x <= this->upper.x); }
  void include(const glm::vec3& point)
  {
    this->lower = glm::min(this->lower, point);
    this->upper = glm::max(this->upper, point);
  }
};

struct KdCells;
struct TriangleBlock;

// What the tree is worth, by the cost model that built it and by counting. "Expected" numbers are
// those of a random line through the box that nothing stops: an upper bound of what rays need.
struct KdTreeQuality
{
  std::uint64_t triangles = 0;
  std::uint64_t innerNodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t emptyLeaves = 0;
  std::uint64_t references = 0; // sum of the leaves' lists
  std::uint64_t longestList = 0;
  std::uint64_t groups = 0;     // of cells
  std::uint64_t blocks = 0;     // of triangles
  std::uint64_t bytes = 0;
  int depth = 0;                // of the deepest leaf; the root has depth 0
  int depthLimit = 0;
  // Of the model, which knows nodes and their cells.
  double expectedInnerVisits = 0.0;
  double expectedLeafVisits = 0.0;
  double expectedTriangleTests = 0.0;
  double cost = 0.0;            // in units of one block test
  // Of the groups, which leave empty space out: what KdCounters counts.
  double expectedSteps = 0.0;
  double expectedLeaves = 0.0;
  double expectedBlockTests = 0.0;
  double milliseconds = 0.0;
};
std::ostream& operator<<(std::ostream& stream, const KdTreeQuality& quality);

// How a build is watched and called off.
struct KdTreeBuildControl
{
  // Called with the share that is done, growing from 0 to 1, only by the thread that called build:
  // a host's callback need not be safe against the workers.
  std::function<void(double)> progress;
  // Set by anyone at any time: the build stops within a few milliseconds and returns null.
  const std::atomic<bool>* abort = nullptr;
};

class KdTree
{
public:
  // The triangles' corners must be finite. Uses the threads of the caller's TBB arena; the result
  // does not depend on their number. Null: aborted. Throws std::length_error when the tree would
  // not fit its 30 bit numbers.
  static std::unique_ptr<const KdTree> build(
    const Geometry& geometry, const KdTreeBuildControl& control = {});

  ~KdTree();

  const KdBox& box() const { return this->Box; }
  const KdNode* nodes() const { return this->Nodes.data(); } // the root is the first
  // The lists of the leaves: numbers of triangles within the geometry.
  const std::vector<std::uint32_t>& references() const { return this->References; }
  // The same as rays go through it: the root's group is the first; none when there is no triangle.
  const HugePageVector<KdCells>& groups() const { return this->Groups; }
  const HugePageVector<TriangleBlock>& blocks() const { return this->Blocks; }

  // The largest absolute coordinate, the unit of all error bounds.
  double reach() const { return this->Reach; }

  // How far a point of a triangle may lie outside of the cells that list the triangle. Clipping in
  // double moves a bound by at most 4 roundings, 2^-51 of the reach, on each of at most 64 levels.
  double padding() const { return 0x1p-45 * this->Reach; }

  // Counted when asked for.
  KdTreeQuality quality() const;

private:
  friend class KdTreeBuilder;
  KdTree();

  std::vector<KdNode> Nodes;
  std::vector<std::uint32_t> References;
  HugePageVector<KdCells> Groups;
  HugePageVector<TriangleBlock> Blocks;
  std::size_t Count = 0;             // triangles of the geometry
  KdBox Box;
  double Reach = 0.0;
  int DepthLimit = 0;
  double Milliseconds = 0.0;
};

} // namespace hrt
