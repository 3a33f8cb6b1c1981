// One step of the O(N log N) build: choose the plane that splits a cell and hand its triangles'
// events, still sorted, to the two children.
//
// I. Wald, V. Havran: "On building fast kd-trees for ray tracing, and on doing that in O(N log N)",
// IEEE Symposium on Interactive Ray Tracing 2006, section 4.3. The events are sorted once for the whole
// tree; a split sweeps over them, marks each triangle's side, passes on the events of triangles on one
// side in their order, and merges in the few new events of those that were cut.
#pragma once

#include "Rendering/Core/Structures/KdTreeCost.h"
#include "Rendering/Core/Structures/KdTreeEvents.h"

namespace hrt
{

// A cell that is still to be split or made a leaf.
struct KdCell
{
  KdBox box;
  KdEventList events[3];
  std::uint32_t triangles = 0;
  int depth = 0;
};

struct KdSplit
{
  double cost = 0.0;
  int axis = -1; // none: nothing is cheaper than a leaf
  float plane = 0.0f;
  bool planarBelow = false;        // the side of the triangles in the plane
  std::uint32_t below = 0, above = 0; // triangles of the children; cut ones count in both
};

// The cheapest split of the cell. Of equal ones the first by axis, by position, and with the planar
// triangles above. A cell that may not be split has no axis.
KdSplit cheapestSplit(const KdCell& cell, int depthLimit);

// A thread's memory for splitting cells of at most `triangles` numbers.
struct KdWorkspace
{
  explicit KdWorkspace(std::size_t triangles)
    : sides(new std::uint8_t[triangles])
  {
  }
  std::unique_ptr<std::uint8_t[]> sides; // by triangle; only those of the cell at hand are meaningful
  KdArena arena;
};

// The children of a cell. `below` and `above` must have room in each list for two events a triangle and
// one more. `perAxis` runs a function for the axes 0, 1, 2: in turn, or at once.
template <class PerAxis>
void splitCell(const KdCell& cell, const KdSplit& split, const Geometry& mesh,
  KdWorkspace& workspace, KdCell& below, KdCell& above, PerAxis perAxis);

// --- Implementation of the template ---------------------------------------------------------------

// The triangles that the plane cuts, with the new events of both their parts, sorted.
struct KdCutTriangles
{
  std::uint32_t* triangles = nullptr;
  std::uint32_t count = 0;
  KdEventList below[3], above[3];
};

// Marks the sides of all triangles and lists those that are cut.
void markSides(
  const KdEventList& along, const KdSplit& split, std::uint8_t* sides, KdCutTriangles& cut);
// Computes the new events.
void cutTriangles(const KdCell& cell, const KdSplit& split, const Geometry& mesh,
  KdArena& arena, KdCutTriangles& cut);
// Sorts an axis' new events and gives the children their events along it.
void distributeEvents(const KdEventList& events, const std::uint8_t* sides, KdEventList& cutBelow,
  KdEventList& cutAbove, KdEventList& below, KdEventList& above);

template <class PerAxis>
void splitCell(const KdCell& cell, const KdSplit& split, const Geometry& mesh,
  KdWorkspace& workspace, KdCell& below, KdCell& above, PerAxis perAxis)
{
  below.box = above.box = cell.box;
  below.box.upper[split.axis] = split.plane;
  above.box.lower[split.axis] = split.plane;
  below.triangles = split.below;
  above.triangles = split.above;
  below.depth = above.depth = cell.depth + 1;

  const KdArena::Mark mark = workspace.arena.mark();
  KdCutTriangles cut;
  const std::uint32_t most = split.below + split.above - cell.triangles;
  // Room for one more: the list is written ahead of the decision whether an entry stays.
  cut.triangles =
    reinterpret_cast<std::uint32_t*>(workspace.arena.allocate((std::size_t(most) + 2) / 2));
  markSides(cell.events[split.axis], split, workspace.sides.get(), cut);
  cutTriangles(cell, split, mesh, workspace.arena, cut);
  perAxis([&](int axis) {
    distributeEvents(cell.events[axis], workspace.sides.get(), cut.below[axis], cut.above[axis],
      below.events[axis], above.events[axis]);
  });
  workspace.arena.release(mark);
}

} // namespace hrt
