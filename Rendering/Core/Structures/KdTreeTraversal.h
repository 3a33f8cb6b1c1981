// One ray through one kd-tree: finds, roughly from near to far, every triangle that the exact kernel
// might accept, and asks the caller about each once or, rarely, twice.
//
// V. Havran: "Heuristic Ray Shooting Algorithms", PhD thesis, Czech Technical University 2000, appendix
// C, with one difference: every cell is met as if grown by `slack` on all sides, the bound of all that
// rounding can do. A plane therefore ends the near child a little behind itself and starts the far one a
// little before; where both are met both are visited. There is no other epsilon, and no case for rays
// within a plane, on a plane, or along an axis.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"
#include "Rendering/Core/Structures/KdTreeSlabs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace hrt
{

// Counts what a traversal does; the empty kind costs nothing.
struct KdNoCounters
{
  void step() {}
  void leaf() {}
  void triangleTest() {}
  void candidate() {}
};
struct KdCounters
{
  std::uint64_t steps = 0;         // inner nodes
  std::uint64_t leaves = 0;
  std::uint64_t triangleTests = 0; // in single precision
  std::uint64_t candidates = 0;    // exact tests
  void step() { ++this->steps; }
  void leaf() { ++this->leaves; }
  void triangleTest() { ++this->triangleTests; }
  void candidate() { ++this->candidates; }
};

// Rejects triangles that a ray misses clearly, in single precision and all three corners at once.
//
// It is the exact kernel's test - the ray sheared to the axis of its longest component, then the signs of
// three edge functions - with a margin for all that differs from exact arithmetic. With R the reach, to
// which the ray's start is clipped, and e = 2^-24, a sheared corner is off by
//   2 R e   the start's rounding, sheared,
//   2 R e   the shear's own rounding, over a depth of at most 2 R,
//   4 R e   the differences of corner and start, sheared,
//   6 R e   the product and the last difference, of at most 2 R and 4 R,
// together 14 R e; `Margin` is 16 R e plus the slack of the traversal. An edge function of corners off by
// m is off by m (|bx|+|by|+|cx|+|cy|+2m); its own rounding, 2 e (|bx cy| + |by cx|) with |cx| <= 4 R, is
// below half of that. Twice the sum is the threshold. Whatever overflows gives no rejection.
class KdTriangleFilter
{
public:
  // `start`: a point of the ray in the tree's box.
  void set(const glm::dvec3& start, const glm::dvec3& direction, double reach, double slack)
  {
    const double from[3] = { start.x, start.y, start.z };
    const double along[3] = { direction.x, direction.y, direction.z };
    const double x = std::abs(along[0]), y = std::abs(along[1]), z = std::abs(along[2]);
    const int kz = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    const int kx = kz == 2 ? 0 : kz + 1, ky = kx == 2 ? 0 : kx + 1;
    const int order[3] = { kx, ky, kz };
    for (int i = 0; i < 3; ++i)
    {
      this->Offset[i] = 3 * order[i];
      this->Start[i] = static_cast<float>(from[order[i]]);
      this->Shear[i] = static_cast<float>(along[order[i]] / along[kz]);
    }
    this->Margin = static_cast<float>((16.0 * 0x1p-24 * reach + slack) * (1.0 + 0x1p-20));
  }

  bool rejects(const KdTriangle& triangle) const
  {
#if defined(__SSE2__)
    const __m128 z = this->distance(triangle, 2);
    const __m128 x =
      _mm_sub_ps(this->distance(triangle, 0), _mm_mul_ps(_mm_set1_ps(this->Shear[0]), z));
    const __m128 y =
      _mm_sub_ps(this->distance(triangle, 1), _mm_mul_ps(_mm_set1_ps(this->Shear[1]), z));
    const __m128 edge = _mm_sub_ps(_mm_mul_ps(x, nextCorner(y)), _mm_mul_ps(y, nextCorner(x)));
    const __m128 margin = _mm_set1_ps(this->Margin);
    const __m128 signs = _mm_set1_ps(-0.0f);
    const __m128 size =
      _mm_add_ps(_mm_add_ps(_mm_andnot_ps(signs, x), _mm_andnot_ps(signs, y)), margin);
    const __m128 threshold =
      _mm_mul_ps(_mm_add_ps(margin, margin), _mm_add_ps(size, nextCorner(size)));
    const int above = _mm_movemask_ps(_mm_cmpgt_ps(edge, threshold));
    const int below = _mm_movemask_ps(_mm_cmplt_ps(edge, _mm_xor_ps(signs, threshold)));
    return (above & kCorners) != 0 && (below & kCorners) != 0;
#else
    float x[3], y[3];
    for (int i = 0; i < 3; ++i)
    {
      const float z = triangle.coordinates[this->Offset[2] + i] - this->Start[2];
      x[i] = triangle.coordinates[this->Offset[0] + i] - this->Start[0] - this->Shear[0] * z;
      y[i] = triangle.coordinates[this->Offset[1] + i] - this->Start[1] - this->Shear[1] * z;
    }
    bool above = false, below = false;
    for (int i = 0; i < 3; ++i)
    {
      const int j = i == 2 ? 0 : i + 1;
      const float edge = x[i] * y[j] - y[i] * x[j];
      const float size = std::abs(x[i]) + std::abs(y[i]) + std::abs(x[j]) + std::abs(y[j]) +
        2.0f * this->Margin;
      const float threshold = 2.0f * this->Margin * size;
      above = above || edge > threshold;
      below = below || edge < -threshold;
    }
    return above && below;
#endif
  }

private:
#if defined(__SSE2__)
  static constexpr int kCorners = 7; // the fourth number is none of the triangle's
  __m128 distance(const KdTriangle& triangle, int i) const
  {
    const float* numbers = reinterpret_cast<const float*>(&triangle) + this->Offset[i];
    return _mm_sub_ps(_mm_loadu_ps(numbers), _mm_set1_ps(this->Start[i]));
  }
  static __m128 nextCorner(__m128 v) { return _mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1)); }
#endif

  // In the order x, y, z of the sheared ray; the last shear is 1.
  int Offset[3];
  float Start[3];
  float Shear[3];
  float Margin = 0.0f;
};

// A ray made ready for one tree, in the tree's coordinates. Its t is that of the ray in the scene: an
// affine map keeps it.
class KdRay
{
public:
  // False when the ray misses the tree's box, or the tree is empty. `slack`: how far the tree's triangles
  // and the ray may lie from where the numbers say. The direction's longest component must be far from
  // both ends of the numbers.
  bool enter(const KdTree& tree, const glm::dvec3& origin, const glm::dvec3& direction,
    double tMaximum, double slack)
  {
    this->Slabs = KdSlabs(origin, direction, slack);
    this->Start = 0.0;
    this->End = tMaximum;
    if (!this->Slabs.meet(tree.box().lower, tree.box().upper, this->Start, this->End))
    {
      return false;
    }
    this->Filter.set(origin + this->Start * direction, direction, tree.reach(), slack);
    return true;
  }

  // Calls candidate(number) for triangles that may be hit. It returns the ray's new end: the search goes
  // on up to there, inclusive; below zero ends it.
  template <class Candidate, class Counters>
  void traverse(const KdTree& tree, Candidate&& candidate, Counters& counters)
  {
    struct Entry
    {
      double start, end;
      std::uint32_t node;
    };
    Entry stack[kStackSize];
    int size = 0;
    Mailbox mailbox;
    const KdNode* const nodes = tree.nodes();
    std::uint32_t index = 0;
    double start = this->Start, end = this->End;
    for (;;)
    {
      KdNode node = nodes[index];
      while (!node.isLeaf())
      {
        counters.step();
        const unsigned axis = node.axis();
        const double farStart = this->Slabs.farStart(axis, node.split());
        const double nearEnd = this->Slabs.nearEnd(axis, node.split());
        const std::uint32_t near = node.children() + this->Slabs.negative(axis);
        // Both conditions are written so that what is not a number visits.
        if (farStart > end)
        {
          index = near;
        }
        else if (nearEnd < start)
        {
          index = near ^ 1u;
        }
        else
        {
          stack[size++] = { farStart > start ? farStart : start, end, near ^ 1u };
          end = nearEnd < end ? nearEnd : end;
          index = near;
        }
        node = nodes[index];
      }
      counters.leaf();
      this->testLeaf(tree, node, mailbox, candidate, counters);
      do
      {
        if (size == 0)
        {
          return;
        }
        --size;
      } while (stack[size].start > this->End);
      index = stack[size].node;
      start = stack[size].start;
      end = std::min(stack[size].end, this->End);
    }
  }

private:
  // One entry a level: see kdcost::kDepthLimitMost.
  static constexpr int kStackSize = 64;

  // The triangles tested last, by the lowest bits of their numbers: a large triangle lies in many leaves,
  // and the exact test is worth being spared, other than the filter.
  // Amanatides and Woo: "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987; hashed as
  // in Mitsuba, so that rays of several threads need no memory per triangle.
  struct Mailbox
  {
    static constexpr std::uint32_t kSlots = 8;
    std::uint32_t slots[kSlots];
    Mailbox() { std::fill(slots, slots + kSlots, ~0u); }
    bool tested(std::uint32_t triangle)
    {
      std::uint32_t& slot = this->slots[triangle % kSlots];
      const bool known = slot == triangle;
      slot = triangle;
      return known;
    }
  };

  template <class Candidate, class Counters>
  void testLeaf(const KdTree& tree, const KdNode& leaf, Mailbox& mailbox, Candidate&& candidate,
    Counters& counters)
  {
    const std::size_t last = std::size_t(leaf.first()) + leaf.count();
    for (std::size_t i = leaf.first(); i < last; ++i)
    {
      counters.triangleTest();
      if (this->Filter.rejects(tree.triangle(i)))
      {
        continue;
      }
      const std::uint32_t triangle = tree.references()[i];
      if (!mailbox.tested(triangle))
      {
        counters.candidate();
        this->End = candidate(triangle);
      }
    }
  }

  KdSlabs Slabs;
  double Start = 0.0;
  double End = 0.0;
  KdTriangleFilter Filter;
};

} // namespace hrt
