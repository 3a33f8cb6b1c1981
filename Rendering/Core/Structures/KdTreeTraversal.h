// One ray through one kd-tree: finds, from near to far, every triangle that the exact kernel might accept.
//
// V. Havran: "Heuristic Ray Shooting Algorithms", PhD thesis, Czech Technical University 2000, appendix
// C, with two differences. A step takes a ray to the nearest of up to eight cells (KdTreeCells.h). And every
// cell is met as if grown on all sides by a bound of all that rounding can do; there is no other epsilon, and
// no case for rays within a plane, on a plane, or along an axis.
//
// The cells are met in single precision. Let R be the tree's reach, e = 2^-24, and `slack` the bound of
// what double precision does to ray and triangles. The ray is followed from where it enters the tree's box,
// in units such that its direction's longest component is 1.
//   Cells are grown by the slack and 4 R e, of which the start, at most R away on each axis, takes R e when
//   it is rounded to a float. Where a direction component's reciprocal is cut off, at the largest float, the
//   ray moves on that axis by less than 2^-100 R over all its way: to be within the grown cell or not is
//   then the same from start to end.
//   A parameter is a difference, a reciprocal and a product off, 3 e of itself; the search's end by 2 e. Of
//   two that are compared, the one that must not be too small is made larger by 8 e.
// So a cell that fails the test is not met by the true ray, nor by any within the slack of it.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"
#include "Rendering/Core/Structures/KdTreeCells.h"
#include "Rendering/Core/Structures/TriangleSieve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hrt
{

// Counts what a traversal does; the empty kind costs nothing.
struct KdNoCounters
{
  void step() {}
  void leaf(std::uint32_t) {}
  void blockTest() {}
  void candidate() {}
};
struct KdCounters
{
  std::uint64_t steps = 0;      // groups of cells
  std::uint64_t leaves = 0;
  std::uint64_t blockTests = 0; // up to eight triangles in single precision
  std::uint64_t candidates = 0; // exact tests
  void step() { ++this->steps; }
  void leaf(std::uint32_t blocks) { this->leaves += blocks != 0; }
  void blockTest() { ++this->blockTests; }
  void candidate() { ++this->candidates; }
};

HRT_ALWAYS_INLINE int lowestBit(unsigned int bits)
{
#if defined(__GNUC__)
  return __builtin_ctz(bits);
#else
  int i = 0;
  while (!(bits >> i & 1u))
  {
    ++i;
  }
  return i;
#endif
}

// A ray made ready for one tree, in the tree's coordinates. Its t is that of the ray in the scene: an
// affine map keeps it.
class KdRay
{
public:
  enum class Entry
  {
    Missed,   // the tree's box, or the tree is empty
    Entered,
    Unbounded // numbers too large or too small for the bounds above
  };

  // `slack`: how far the tree's triangles and the ray may lie from where the numbers say. `twinEnd`:
  // Ray's. Only an entered ray can traverse.
  Entry enter(const KdTree& tree, const glm::dvec3& origin, const glm::dvec3& direction,
    double tMaximum, double slack, double twinEnd = 0.0)
  {
    if (tree.groups().empty())
    {
      return Entry::Missed;
    }
    const glm::dvec3 lengths = glm::abs(direction);
    this->Scale = std::max({ lengths.x, lengths.y, lengths.z });
    // Written so that what is not a number is out of bounds.
    const double sum = lengths.x + lengths.y + lengths.z;
    if (!(this->Scale >= 1.0 / kLargestScale && sum <= kLargestScale && slack <= kLargestSlack))
    {
      return Entry::Unbounded;
    }
    // The floor keeps a cell at the origin from vanishing among the smallest floats.
    const double grown = slack + 0x1p-22 * tree.reach() + 1e-30;
    const glm::dvec3 along = direction * (1.0 / this->Scale);
    glm::dvec3 inverse;
    double start = 0.0, end = tMaximum * this->Scale;
    for (int axis = 0; axis < 3; ++axis)
    {
      inverse[axis] = std::clamp(slope(1.0, along[axis]), -kLargestFloat, kLargestFloat);
      const bool negative = std::signbit(along[axis]);
      const double lower = tree.box().lower[axis] - grown, upper = tree.box().upper[axis] + grown;
      start = std::max(start, ((negative ? upper : lower) - origin[axis]) * inverse[axis]);
      end = std::min(end, ((negative ? lower : upper) - origin[axis]) * inverse[axis]);
    }
    if (start > end)
    {
      return Entry::Missed;
    }
    this->Start = start;
    this->Last = std::min<double>(end - start, kLargestFloat);
    this->TwinEnd = this->endAt(twinEnd);
    this->place(origin + start * along, along, inverse, grown);
    // The sieve takes its bounds for floats' roundings from a reach: this one's is the slack.
    this->Slack = SieveSlack(tree.reach() + 0x1p24 * slack);
    return Entry::Entered;
  }

  // Calls candidates(block, sieve's result) for blocks with triangles that may be hit. It returns the t up
  // to which the search goes on, inclusive; below zero ends it.
  template <class Candidates, class Counters>
  HRT_ALWAYS_INLINE void traverse(
    const KdTree& tree, double tMaximum, Candidates&& candidates, Counters& counters) const
  {
    const KdCells* const groups = tree.groups().data();
    const Slabs slabs = this->TheSlabs;
    Stack stack;
    SieveRay ray(this->Origin, this->Direction, this->TwinEnd, this->endAt(tMaximum));
    Cell cell{ 0.0f, 0, 0 };
    do
    {
      while (!(cell.child & KdCells::kLeaf))
      {
        counters.step();
        if (!step(groups[cell.child], slabs, ray.end * kLater, cell, stack))
        {
          cell = { 0.0f, KdCells::kLeaf, 0 };
          break;
        }
      }
      counters.leaf(cell.blocks);
      const TriangleBlock* const blocks = tree.blocks().data() + (cell.child & ~KdCells::kLeaf);
      for (std::uint32_t i = 0; i < cell.blocks; ++i)
      {
        counters.blockTest();
        const SieveResult lanes = sieve(blocks[i], ray, this->Slack);
        if (lanes.possible != 0)
        {
          const double t = candidates(blocks[i], lanes);
          if (t < 0.0)
          {
            return;
          }
          ray.end = this->endAt(t);
        }
      }
    } while (stack.pop(ray.end * kLater, cell));
  }

private:
  static constexpr double kLargestFloat = std::numeric_limits<float>::max();
  // Far from where squares, reciprocals and sums of doubles and floats overflow.
  static constexpr double kLargestScale = 1e150, kLargestSlack = 1e30;
  static constexpr float kLater = 1.0f + 0x1p-21f;

  // A cell on the ray's way.
  struct Cell
  {
    float start;
    std::uint32_t child, blocks; // as in KdCells
  };

  // The ray as it meets cells. On its own, so that a traversal can keep a copy in registers.
  struct Slabs
  {
    float farOrigin[3], nearOrigin[3]; // of bounds that are grown by moving the ray
    float inverse[3];
    int first[3], last[3]; // which of KdCells::bounds the ray meets first and last

    // Which cells the ray meets at parameters up to `end`, and where it enters them.
    HRT_ALWAYS_INLINE unsigned int meet(
      const KdCells& cells, float end, float (&starts)[KdCells::kLanes]) const
    {
      constexpr int n = KdCells::kLanes;
      const float* const nearX = cells.bounds[this->first[0]];
      const float* const nearY = cells.bounds[this->first[1]];
      const float* const nearZ = cells.bounds[this->first[2]];
      const float* const farX = cells.bounds[this->last[0]];
      const float* const farY = cells.bounds[this->last[1]];
      const float* const farZ = cells.bounds[this->last[2]];
      const float fx = this->farOrigin[0], fy = this->farOrigin[1], fz = this->farOrigin[2];
      const float nx = this->nearOrigin[0], ny = this->nearOrigin[1], nz = this->nearOrigin[2];
      const float ix = this->inverse[0], iy = this->inverse[1], iz = this->inverse[2];
      std::int32_t met[n];
      for (int i = 0; i < n; ++i)
      {
        const float x0 = (nearX[i] - fx) * ix, y0 = (nearY[i] - fy) * iy, z0 = (nearZ[i] - fz) * iz;
        const float x1 = (farX[i] - nx) * ix, y1 = (farY[i] - ny) * iy, z1 = (farZ[i] - nz) * iz;
        const float startX = x0 > 0.0f ? x0 : 0.0f;
        const float startY = y0 > startX ? y0 : startX;
        const float start = z0 > startY ? z0 : startY;
        const float lastXy = x1 < y1 ? x1 : y1;
        const float lastXyz = (lastXy < z1 ? lastXy : z1) * kLater;
        const float last = lastXyz < end ? lastXyz : end;
        starts[i] = start;
        met[i] = start > last ? 0 : 1 << i;
      }
      return unionOf(met);
    }
  };

  // The cells to come, the next one on top.
  class Stack
  {
  public:
    int size() const { return this->Size; }

    // Puts a cell among those above `base` by its start.
    HRT_ALWAYS_INLINE void insert(int base, const Cell& cell)
    {
      int place = this->Size++;
      for (; place > base && this->Cells[place - 1].start < cell.start; --place)
      {
        this->Cells[place] = this->Cells[place - 1];
      }
      this->Cells[place] = cell;
    }

    // False when none starts before the end.
    HRT_ALWAYS_INLINE bool pop(float end, Cell& cell)
    {
      while (this->Size > 0)
      {
        cell = this->Cells[--this->Size];
        if (cell.start <= end)
        {
          return true;
        }
      }
      return false;
    }

  private:
    // A level of groups leaves seven cells at most, and each takes at least one level of the tree.
    Cell Cells[(KdCells::kLanes - 1) * (kdcost::kDepthLimitMost + 1)];
    int Size = 0;
  };

  // The end of the search for a t as a parameter within the tree, rounded outward: two ulps are for the two
  // roundings.
  float endAt(double t) const
  {
    const double parameter = std::clamp(t * this->Scale - this->Start, 0.0, this->Last);
    return static_cast<float>(parameter) * (1.0f + 0x1p-22f) + std::numeric_limits<float>::min();
  }

  void place(const glm::dvec3& start, const glm::dvec3& along, const glm::dvec3& inverse, double grown)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool negative = std::signbit(along[axis]);
      this->Origin[axis] = static_cast<float>(start[axis]);
      this->Direction[axis] = static_cast<float>(along[axis]);
      this->TheSlabs.inverse[axis] = static_cast<float>(inverse[axis]);
      this->TheSlabs.farOrigin[axis] = static_cast<float>(start[axis] + (negative ? -grown : grown));
      this->TheSlabs.nearOrigin[axis] = static_cast<float>(start[axis] - (negative ? -grown : grown));
      this->TheSlabs.first[axis] = negative ? 3 + axis : axis;
      this->TheSlabs.last[axis] = negative ? axis : 3 + axis;
    }
  }

  // Goes on to the nearest cell of the group that the ray meets and leaves the others on the stack. False
  // when it meets none.
  HRT_ALWAYS_INLINE static bool step(
    const KdCells& cells, const Slabs& slabs, float end, Cell& next, Stack& stack)
  {
    float starts[KdCells::kLanes];
    unsigned int met = slabs.meet(cells, end, starts);
    if (met == 0)
    {
      return false;
    }
    const auto at = [&](int lane) {
      return Cell{ starts[lane], cells.child[lane], cells.blocks[lane] };
    };
    const int base = stack.size();
    next = at(lowestBit(met));
    for (met &= met - 1; met != 0; met &= met - 1)
    {
      Cell other = at(lowestBit(met));
      if (other.start < next.start)
      {
        std::swap(other, next);
      }
      stack.insert(base, other);
    }
    return true;
  }

  float Origin[3], Direction[3];
  Slabs TheSlabs;
  double Scale = 1.0;             // parameter per t
  double Start = 0.0, Last = 0.0; // parameters of the tree's box, from the true origin and from there
  float TwinEnd = 0.0f;           // as a parameter, rounded outward
  SieveSlack Slack;
};

} // namespace hrt
