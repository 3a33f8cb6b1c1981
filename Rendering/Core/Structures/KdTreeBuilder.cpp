// Builds the kd-tree: the recursion over KdTreeSplit.h and its threads.
//
// Large cells are split one by one, their two halves as tasks of oneTBB; cells below a fixed number of
// triangles are finished by one thread without asking the heap. The number is fixed, and the finished
// pieces are laid out in the order of the tree: so the result depends neither on the number of threads
// nor on their luck (KdTreePieces.h).
#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Structures/KdTreeCells.h"
#include "Rendering/Core/Structures/KdTreePieces.h"
#include "Rendering/Core/Structures/KdTreeSplit.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace hrt
{

namespace
{

// Below: about a millisecond of work, a thousand times what a task costs.
constexpr std::uint32_t kTaskTriangles = 2048;

} // namespace

class KdTreeBuilder
{
public:
  KdTreeBuilder(const Geometry& geometry, const KdTreeBuildControl& control)
    : Mesh(geometry)
    , Count(static_cast<std::uint32_t>(geometry.triangleCount()))
    , DepthLimit(kdcost::depthLimit(geometry.triangleCount()))
    , Control(control)
    , Caller(std::this_thread::get_id())
    , Workspaces([this] { return KdWorkspace(this->Count); })
  {
  }

  std::unique_ptr<const KdTree> build();

private:
  // A large cell with the memory of its events.
  struct OwnedCell : KdCell
  {
    std::unique_ptr<KdEvent[]> memory;

    // Room for two events a triangle, and one for writing ahead, in each list.
    void reserve(std::uint32_t triangles)
    {
      const std::size_t room = 2 * std::size_t(triangles) + 1;
      this->memory.reset(new KdEvent[3 * room]);
      for (int axis = 0; axis < 3; ++axis)
      {
        this->events[axis].events = this->memory.get() + axis * room;
      }
    }
  };

  OwnedCell rootCell() const;
  void buildBranch(KdBranch& branch, OwnedCell cell, double share);
  void buildPiece(KdPiece& piece, std::size_t node, const KdCell& cell, KdWorkspace& workspace) const;
  void makeLeaf(KdPiece& piece, std::size_t node, const KdCell& cell) const;
  void layOut(const KdBranch& root, KdTree& tree) const;
  // Stays true once it was, whatever becomes of the caller's flag.
  bool aborted() const
  {
    if (this->Control.abort && this->Control.abort->load(std::memory_order_relaxed))
    {
      this->Aborted.store(true, std::memory_order_relaxed);
    }
    return this->Aborted.load(std::memory_order_relaxed);
  }
  void advance(double share);

  const Geometry& Mesh;
  std::uint32_t Count;
  int DepthLimit;
  const KdTreeBuildControl& Control;
  std::thread::id Caller;
  tbb::enumerable_thread_specific<KdWorkspace> Workspaces;
  mutable std::atomic<bool> Aborted{ false };
  std::mutex Mutex;
  double Done = 0.0;
};

void KdTreeBuilder::advance(double share)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Done += share;
  // 1 is left to the end of the build; the shares' sum may come out above it.
  if (this->Control.progress && std::this_thread::get_id() == this->Caller && this->Done < 1.0)
  {
    this->Control.progress(this->Done);
  }
}

KdTreeBuilder::OwnedCell KdTreeBuilder::rootCell() const
{
  OwnedCell cell;
  std::vector<std::uint32_t> admitted;
  admitted.reserve(this->Count);
  for (std::uint32_t i = 0; i < this->Count; ++i)
  {
    const std::array<glm::vec3, 3> c = this->Mesh.cornerPositions(i);
    // Others cannot be ordered and clipped. The scene's door refuses them; a snapshot made otherwise
    // must do no harm.
    if (isAdmissible(c[0]) && isAdmissible(c[1]) && isAdmissible(c[2]))
    {
      admitted.push_back(i);
      for (int k = 0; k < 3; ++k)
      {
        cell.box.include(c[k] + 0.0f); // -0 becomes +0, see KdTreeClip.cpp
      }
    }
  }
  cell.triangles = static_cast<std::uint32_t>(admitted.size());
  cell.reserve(cell.triangles);
  tbb::parallel_for(0, 3, [&](int axis) {
    KdEventList& events = cell.events[axis];
    for (const std::uint32_t i : admitted)
    {
      const std::array<glm::vec3, 3> c = this->Mesh.cornerPositions(i);
      const float a = c[0][axis] + 0.0f, b = c[1][axis] + 0.0f, d = c[2][axis] + 0.0f;
      events.add(std::min(a, std::min(b, d)), std::max(a, std::max(b, d)), i);
    }
    const std::unique_ptr<KdEvent[]> scratch(new KdEvent[events.count]);
    sortEvents(events, scratch.get());
  });
  return cell;
}

void KdTreeBuilder::buildBranch(KdBranch& branch, OwnedCell cell, double share)
{
  if (this->aborted())
  {
    return;
  }
  if (cell.triangles <= kTaskTriangles)
  {
    branch.piece.nodes.resize(2);
    this->buildPiece(branch.piece, 0, cell, this->Workspaces.local());
    this->advance(share);
    return;
  }
  const KdSplit split = cheapestSplit(cell, this->DepthLimit);
  if (split.axis < 0)
  {
    branch.piece.nodes.resize(2);
    this->makeLeaf(branch.piece, 0, cell);
    this->advance(share);
    return;
  }
  OwnedCell below, above;
  below.reserve(split.below);
  above.reserve(split.above);
  {
    // Not the thread's own workspace: while the axes are waited for, the thread may finish a piece.
    KdWorkspace workspace(this->Count);
    splitCell(cell, split, this->Mesh, workspace, below, above,
      [](const auto& distribute) { tbb::parallel_for(0, 3, distribute); });
  }
  cell.memory.reset();
  branch.axis = split.axis;
  branch.plane = split.plane;
  branch.below = std::make_unique<KdBranch>();
  branch.above = std::make_unique<KdBranch>();
  const double lowerShare = share * split.below / (double(split.below) + split.above);
  tbb::parallel_invoke(
    [&] { this->buildBranch(*branch.below, std::move(below), lowerShare); },
    [&] { this->buildBranch(*branch.above, std::move(above), share - lowerShare); });
}

void KdTreeBuilder::makeLeaf(KdPiece& piece, std::size_t node, const KdCell& cell) const
{
  const std::size_t first = piece.references.size();
  for (const KdEvent event : cell.events[0])
  {
    if (kindOf(event) != KdEventKind::End)
    {
      piece.references.push_back(triangleOf(event));
    }
  }
  piece.nodes[node] = KdNode::leaf(static_cast<std::uint32_t>(first), cell.triangles);
  if (cell.triangles == 0)
  {
    return;
  }
  KdLeaf leaf{ {}, static_cast<std::uint32_t>(first), cell.triangles };
  for (int axis = 0; axis < 3; ++axis)
  {
    leaf.bounds.lower[axis] = positionOf(cell.events[axis].events[0]);
    leaf.bounds.upper[axis] = positionOf(cell.events[axis].events[cell.events[axis].count - 1]);
  }
  piece.leaves.push_back(leaf);
}

void KdTreeBuilder::buildPiece(
  KdPiece& piece, std::size_t node, const KdCell& cell, KdWorkspace& workspace) const
{
  const KdSplit split = cheapestSplit(cell, this->DepthLimit);
  if (split.axis < 0 || this->aborted())
  {
    this->makeLeaf(piece, node, cell);
    return;
  }
  const KdArena::Mark mark = workspace.arena.mark();
  KdCell below, above;
  for (int axis = 0; axis < 3; ++axis)
  {
    below.events[axis].events = workspace.arena.allocate(2 * std::size_t(split.below) + 1);
    above.events[axis].events = workspace.arena.allocate(2 * std::size_t(split.above) + 1);
  }
  splitCell(cell, split, this->Mesh, workspace, below, above, [](const auto& distribute) {
    distribute(0);
    distribute(1);
    distribute(2);
  });
  const std::size_t children = piece.nodes.size();
  piece.nodes.resize(children + 2);
  piece.nodes[node] = KdNode::inner(split.axis, split.plane, static_cast<std::uint32_t>(children));
  this->buildPiece(piece, children, below, workspace);
  this->buildPiece(piece, children + 1, above, workspace);
  workspace.arena.release(mark);
}

void KdTreeBuilder::layOut(const KdBranch& root, KdTree& tree) const
{
  std::vector<KdLeaf> leaves;
  layOutPieces(root, tree.Nodes, tree.References, leaves);
  tbb::parallel_invoke([&] { tree.Groups = groupCells(tree.Nodes, leaves); },
    [&] { tree.Blocks = copyTriangles(leaves, tree.References, this->Mesh); });
}

std::unique_ptr<const KdTree> KdTreeBuilder::build()
{
  const auto started = std::chrono::steady_clock::now();
  std::unique_ptr<KdTree> tree(new KdTree);
  OwnedCell cell = this->rootCell();
  tree->Box = cell.box;
  const glm::vec3 most = glm::max(glm::abs(cell.box.lower), glm::abs(cell.box.upper));
  tree->Reach = cell.triangles ? std::max({ most.x, most.y, most.z }) : 0.0;
  KdBranch root;
  this->buildBranch(root, std::move(cell), 1.0);
  if (this->aborted())
  {
    return nullptr;
  }
  this->layOut(root, *tree);
  tree->Count = this->Count;
  tree->DepthLimit = this->DepthLimit;
  tree->Milliseconds =
    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
  if (this->Control.progress)
  {
    this->Control.progress(1.0);
  }
  return tree;
}

std::unique_ptr<const KdTree> KdTree::build(
  const Geometry& geometry, const KdTreeBuildControl& control)
{
  if (geometry.triangleCount() >= kKdTreeMaximumTriangles)
  {
    throw std::length_error("kd-tree: more than 2^30 triangles");
  }
  return KdTreeBuilder(geometry, control).build();
}

} // namespace hrt
