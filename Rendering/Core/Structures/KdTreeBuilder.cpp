// Builds the kd-tree: the recursion over KdTreeSplit.h, its threads, and the layout of the result.
//
// Large cells are split one by one, their two halves as tasks of oneTBB; cells below a fixed number of
// triangles are finished by one thread without asking the heap. The number is fixed, and the finished
// pieces are laid out in the order of the tree: so the result depends neither on the number of threads
// nor on their luck.
#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Structures/KdTreeSplit.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
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

// A finished piece of the tree. Numbers of children and references count from its own start; the root is
// the first node, and the second is left out to keep pairs at even places.
struct Piece
{
  std::vector<KdNode> nodes;
  std::vector<std::uint32_t> references;
};

// The tree of the large cells.
struct Branch
{
  int axis = -1; // -1: a piece, else two branches
  float plane = 0.0f;
  std::unique_ptr<Branch> below, above;
  Piece piece;
};

} // namespace

class KdTreeBuilder
{
public:
  KdTreeBuilder(const Geometry& geometry, const KdTreeBuildControl& control)
    : Corners(geometry.positions.data())
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
  void buildBranch(Branch& branch, OwnedCell cell, double share);
  void buildPiece(Piece& piece, std::size_t node, const KdCell& cell, KdWorkspace& workspace) const;
  void makeLeaf(Piece& piece, std::size_t node, const KdCell& cell) const;
  void layOut(const Branch& root, KdTree& tree) const;
  void copyTriangles(KdTree& tree) const;
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

  const glm::vec3* Corners;
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
    const glm::vec3* c = this->Corners + 3 * std::size_t(i);
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
      const glm::vec3* c = this->Corners + 3 * std::size_t(i);
      const float a = c[0][axis] + 0.0f, b = c[1][axis] + 0.0f, d = c[2][axis] + 0.0f;
      events.add(std::min(a, std::min(b, d)), std::max(a, std::max(b, d)), i);
    }
    const std::unique_ptr<KdEvent[]> scratch(new KdEvent[events.count]);
    sortEvents(events, scratch.get());
  });
  return cell;
}

void KdTreeBuilder::buildBranch(Branch& branch, OwnedCell cell, double share)
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
    splitCell(cell, split, this->Corners, workspace, below, above,
      [](const auto& distribute) { tbb::parallel_for(0, 3, distribute); });
  }
  cell.memory.reset();
  branch.axis = split.axis;
  branch.plane = split.plane;
  branch.below = std::make_unique<Branch>();
  branch.above = std::make_unique<Branch>();
  const double lowerShare = share * split.below / (double(split.below) + split.above);
  tbb::parallel_invoke(
    [&] { this->buildBranch(*branch.below, std::move(below), lowerShare); },
    [&] { this->buildBranch(*branch.above, std::move(above), share - lowerShare); });
}

void KdTreeBuilder::makeLeaf(Piece& piece, std::size_t node, const KdCell& cell) const
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
}

void KdTreeBuilder::buildPiece(
  Piece& piece, std::size_t node, const KdCell& cell, KdWorkspace& workspace) const
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
  splitCell(cell, split, this->Corners, workspace, below, above, [](const auto& distribute) {
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

namespace
{

// Where a piece goes in the whole tree.
struct Place
{
  const Piece* piece;
  std::size_t root;       // its first node
  std::size_t nodes;      // the others
  std::size_t references;
};

// Numbers the nodes of the large cells and the places of the pieces, depth first.
class Layout
{
public:
  Layout(const Branch& root, std::vector<KdNode>& large)
    : Large(large)
  {
    this->Large.resize(2);
    this->visit(root, 0);
    this->Nodes = this->Large.size();
    for (Place& place : this->Places)
    {
      place.nodes = this->Nodes;
      place.references = this->References;
      this->Nodes += place.piece->nodes.size() - 2;
      this->References += place.piece->references.size();
    }
  }

  const std::vector<Place>& places() const { return this->Places; }
  std::size_t nodes() const { return this->Nodes; }
  std::size_t references() const { return this->References; }

private:
  void visit(const Branch& branch, std::size_t node)
  {
    if (branch.axis < 0)
    {
      this->Places.push_back({ &branch.piece, node, 0, 0 });
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

} // namespace

// Rearranges a tree's nodes in cache lines (see KdNodeLine): each line is filled breadth first from the pair
// where it begins, and what is left below goes to later lines, lower cells first.
class CacheLines
{
public:
  CacheLines(const std::vector<KdNode>& nodes, std::vector<KdNodeLine>& lines)
    : From(nodes)
    , To(lines)
  {
    constexpr std::size_t kNodes = KdNodeLine::kNodes;
    this->To.resize((nodes.size() + kNodes - 1) / kNodes);
    this->at(0) = nodes[0];
    this->Next = 2;
    this->enqueue(0);
    while (!this->Waiting.empty())
    {
      this->Line.assign(1, this->Waiting.back());
      this->Waiting.pop_back();
      for (std::size_t i = 0; i < this->Line.size(); ++i)
      {
        this->placePair(this->Line[i]);
        if (this->Next % kNodes == 0)
        {
          // Full: the others begin lines of their own, the last one first.
          this->Waiting.insert(this->Waiting.end(), this->Line.rbegin(),
            this->Line.rend() - static_cast<std::ptrdiff_t>(i + 1));
          break;
        }
      }
    }
  }

private:
  KdNode& at(std::size_t i)
  {
    return this->To[i / KdNodeLine::kNodes].nodes[i % KdNodeLine::kNodes];
  }

  // The new place of a node whose children have none yet.
  void enqueue(std::size_t parent)
  {
    if (!this->at(parent).isLeaf())
    {
      this->Waiting.push_back(static_cast<std::uint32_t>(parent));
    }
  }

  // Places the children of a node that has its place; they still name their own children's old places.
  void placePair(std::uint32_t parent)
  {
    KdNode& node = this->at(parent);
    const std::size_t old = node.children();
    node = KdNode::inner(
      static_cast<int>(node.axis()), node.split(), static_cast<std::uint32_t>(this->Next));
    for (std::size_t side = 0; side < 2; ++side)
    {
      this->at(this->Next) = this->From[old + side];
      if (!this->From[old + side].isLeaf())
      {
        this->Line.push_back(static_cast<std::uint32_t>(this->Next));
      }
      ++this->Next;
    }
  }

  const std::vector<KdNode>& From;
  std::vector<KdNodeLine>& To;
  std::size_t Next = 0;
  std::vector<std::uint32_t> Line;    // parents whose children go to the line at hand
  std::vector<std::uint32_t> Waiting; // parents whose children begin lines
};

void KdTreeBuilder::layOut(const Branch& root, KdTree& tree) const
{
  std::vector<KdNode> all;
  const Layout layout(root, all);
  if (layout.nodes() >= kKdTreeMaximumTriangles ||
    layout.references() > std::numeric_limits<std::uint32_t>::max())
  {
    throw std::length_error("kd-tree: too many nodes or references for 32 bits");
  }
  all.resize(layout.nodes());
  tree.References.resize(layout.references());
  tbb::parallel_for(std::size_t(0), layout.places().size(), [&](std::size_t i) {
    const Place& place = layout.places()[i];
    const std::vector<KdNode>& nodes = place.piece->nodes;
    all[place.root] = moved(nodes[0], place);
    std::transform(nodes.begin() + 2, nodes.end(), all.begin() + static_cast<std::ptrdiff_t>(place.nodes),
      [&](const KdNode& node) { return moved(node, place); });
    std::copy(place.piece->references.begin(), place.piece->references.end(),
      tree.References.begin() + static_cast<std::ptrdiff_t>(place.references));
  });
  CacheLines(all, tree.Lines);
}

void KdTreeBuilder::copyTriangles(KdTree& tree) const
{
  tree.Triangles.resize(tree.References.size() + 1);
  const auto copy = [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
    {
      const glm::vec3* corners = this->Corners + 3 * std::size_t(tree.References[i]);
      for (int k = 0; k < 3; ++k)
      {
        tree.Triangles[i].coordinates[k] = corners[k].x;
        tree.Triangles[i].coordinates[3 + k] = corners[k].y;
        tree.Triangles[i].coordinates[6 + k] = corners[k].z;
      }
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree.References.size(), 4096), copy);
}

std::unique_ptr<const KdTree> KdTreeBuilder::build()
{
  const auto started = std::chrono::steady_clock::now();
  std::unique_ptr<KdTree> tree(new KdTree);
  OwnedCell cell = this->rootCell();
  tree->Box = cell.box;
  const glm::vec3 most = glm::max(glm::abs(cell.box.lower), glm::abs(cell.box.upper));
  tree->Reach = cell.triangles ? std::max({ most.x, most.y, most.z }) : 0.0;
  Branch root;
  this->buildBranch(root, std::move(cell), 1.0);
  if (this->aborted())
  {
    return nullptr;
  }
  this->layOut(root, *tree);
  this->copyTriangles(*tree);
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
