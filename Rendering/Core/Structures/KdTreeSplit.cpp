// Implements the split of one cell. The loops over events run once a level over all triangles: they are
// written without branches on what cannot be predicted, a triangle's side or an event's kind.
// Compiled with -ffp-contract=off, so that the costs compare alike on every machine.
#include "Rendering/Core/Structures/KdTreeSplit.h"

#include "Rendering/Core/Structures/KdTreeClip.h"

#include <algorithm>

namespace hrt
{

namespace
{

enum Side : std::uint8_t
{
  Cut = 0, // on both sides, each with its own part
  Below = 1,
  Above = 2
};

void consider(KdSplit& best, double cost, int axis, float plane, bool planarBelow,
  std::uint32_t below, std::uint32_t above)
{
  if (cost < best.cost)
  {
    best = { cost, axis, plane, planarBelow, below, above };
  }
}

// The plane sweep of the paper's algorithm 4, one plane at a time: behind the triangles that end there, in
// front of those that start, and on either side of those that lie in it. Only there the counts are
// right, and others must not be weighed: where a side's area is zero, or vanishes in rounding,
// triangles too many on it would cost nothing.
//
// A plane in the cell's own side would split nothing off, unless triangles lie in it: these then get a
// flat cell of their own, which a ray passes in no time.
void sweep(const KdCell& cell, int axis, KdSplit& best)
{
  const float lower = cell.box.lower[axis], upper = cell.box.upper[axis];
  if (!(lower < upper))
  {
    return;
  }
  const kdcost::SplitCost cost(cell.box, axis);
  const KdEvent inside = firstEventAfter(lower), outside = firstEventAt(upper);
  const KdEvent* event = cell.events[axis].begin();
  const KdEvent* const end = cell.events[axis].end();
  std::uint32_t below = 0, above = cell.triangles;
  for (; event != end && *event < inside && kindOf(*event) == KdEventKind::Planar; ++event)
  {
    ++below;
    --above;
  }
  if (below > 0)
  {
    consider(best, cost(lower, below, above), axis, lower, true, below, above);
  }
  for (; event != end && *event < inside; ++event)
  {
    ++below;
  }
  while (event != end && *event < outside)
  {
    const float plane = positionOf(*event);
    const KdEvent planar = makeEvent(plane, KdEventKind::Planar, 0);
    const KdEvent start = firstStartAt(plane), after = firstEventAfter(plane);
    for (; event != end && *event < planar; ++event)
    {
      --above;
    }
    consider(best, cost(plane, below, above), axis, plane, false, below, above);
    if (event != end && *event < start)
    {
      for (; event != end && *event < start; ++event)
      {
        ++below;
        --above;
      }
      consider(best, cost(plane, below, above), axis, plane, true, below, above);
    }
    for (; event != end && *event < after; ++event)
    {
      ++below;
    }
  }
  for (; event != end && kindOf(*event) == KdEventKind::End; ++event)
  {
    --above;
  }
  if (above > 0)
  {
    consider(best, cost(upper, below, above), axis, upper, false, below, above);
  }
}

} // namespace

KdSplit cheapestSplit(const KdCell& cell, int depthLimit)
{
  KdSplit best;
  best.cost = kdcost::leafCost(cell.box, cell.triangles);
  if (cell.depth < depthLimit)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      sweep(cell, axis, best);
    }
  }
  return best;
}

void markSides(
  const KdEventList& along, const KdSplit& split, std::uint8_t* sides, KdCutTriangles& cut)
{
  // In front of the plane: whoever starts there is cut unless it also ends there.
  static constexpr std::uint8_t kInFront[4] = { Below, Below, Cut, Cut };
  const std::uint8_t inPlane[4] = { Below, split.planarBelow ? Below : Above, Above, Above };
  const KdEvent at = firstEventAt(split.plane), after = firstEventAfter(split.plane);
  const KdEvent* event = along.begin();
  const KdEvent* const end = along.end();
  for (; event != end && *event < at; ++event)
  {
    sides[triangleOf(*event)] = kInFront[std::size_t(kindOf(*event))];
  }
  for (; event != end && *event < after; ++event)
  {
    sides[triangleOf(*event)] = inPlane[std::size_t(kindOf(*event))];
  }
  for (; event != end; ++event)
  {
    const std::uint32_t triangle = triangleOf(*event);
    if (kindOf(*event) != KdEventKind::End)
    {
      sides[triangle] = Above;
      continue;
    }
    cut.triangles[cut.count] = triangle;
    cut.count += sides[triangle] == Cut;
  }
}

void cutTriangles(const KdCell& cell, const KdSplit& split, const Geometry& mesh,
  KdArena& arena, KdCutTriangles& cut)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    cut.below[axis].events = arena.allocate(2 * std::size_t(cut.count) + 1);
    cut.above[axis].events = arena.allocate(2 * std::size_t(cut.count) + 1);
  }
  for (std::uint32_t i = 0; i < cut.count; ++i)
  {
    const std::uint32_t triangle = cut.triangles[i];
    const KdSplitBounds bounds =
      splitTriangle(mesh.cornerPositions(triangle).data(), cell.box, split.axis, split.plane);
    for (int axis = 0; axis < 3; ++axis)
    {
      cut.below[axis].add(bounds.lower.lower[axis], bounds.lower.upper[axis], triangle);
      cut.above[axis].add(bounds.upper.lower[axis], bounds.upper.upper[axis], triangle);
    }
  }
}

void distributeEvents(const KdEventList& events, const std::uint8_t* sides, KdEventList& cutBelow,
  KdEventList& cutAbove, KdEventList& below, KdEventList& above)
{
  for (KdEventList* fresh : { &cutBelow, &cutAbove })
  {
    std::sort(fresh->events, fresh->events + fresh->count);
    fresh->events[fresh->count] = kNoEvent;
  }
  const KdEvent* freshBelow = cutBelow.begin();
  const KdEvent* freshAbove = cutAbove.begin();
  KdEvent* toBelow = below.events;
  KdEvent* toAbove = above.events;
  for (const KdEvent event : events)
  {
    while (*freshBelow < event)
    {
      *toBelow++ = *freshBelow++;
    }
    while (*freshAbove < event)
    {
      *toAbove++ = *freshAbove++;
    }
    const std::uint8_t side = sides[triangleOf(event)];
    *toBelow = event;
    toBelow += side & Below;
    *toAbove = event;
    toAbove += side >> 1;
  }
  toBelow = std::copy(freshBelow, cutBelow.end(), toBelow);
  toAbove = std::copy(freshAbove, cutAbove.end(), toAbove);
  below.count = static_cast<std::uint32_t>(toBelow - below.events);
  above.count = static_cast<std::uint32_t>(toAbove - above.events);
}

} // namespace hrt
