// Eight neighbouring triangles in single precision, tested together: a sieve before the exact
// kernel. It may let a triangle pass that the kernel refuses, never the other way round; what the
// kernel then says is the result. That is why the sieve may use any instruction set and fused
// operations.
//
// The edge functions are those of Geometry/TriangleTest.h, rounded to float. Let R be the reach of
// the hierarchy's box (TraversalRay.h), e = 2^-24. Against the true ray and the true corners,
//   a corner relative to the origin is off by 4 R e: the corner's own rounding R e, the origin's R
//   e and that of a difference of up to 2 R; its sheared coordinate by 16 R e: twice the above, the
//   shear's rounding times a depth of 2 R, the rounding of a product of 2 R and of a difference of
//   4 R; an edge function, with s the larger |x| + |y| of a corner, by 2 * 16 R e * s for the
//   factors, 2 (16 R e)^2 for their errors' products and 4 e * 4 R * s for three roundings.
// Together 48 R e * (s + 16 R e). The rest of 64 is for everything done in double, the kernel's own
// roundings included: about a million times finer, unless a matrix is so skewed that inverting it
// loses that (kLargestCondition in Grouping.h keeps such parts out of hierarchies of their own).
#pragma once

#include "Rendering/Core/Structures/TraversalRay.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace hrt
{

// Inlined into callers that are compiled for several instruction sets.
#if defined(__GNUC__)
#define HRT_ALWAYS_INLINE inline __attribute__((always_inline))
#define HRT_NEVER_INLINE __attribute__((noinline))
#else
#define HRT_ALWAYS_INLINE inline
#define HRT_NEVER_INLINE
#endif

struct alignas(64) TriangleBlock // five cache lines
{
  static constexpr int kLanes = 8;
  float corner[3][3][kLanes]; // corner, axis, lane
};

// The bounds of the paragraph above for a hierarchy.
struct SieveSlack
{
  float edge = 0;  // of an edge function, per s
  float floor = 0; // the same where s is zero
  float depth = 0;

  SieveSlack() = default;
  explicit SieveSlack(double reach)
  {
    // Below 1e-15 products reach float's smallest numbers, above 1e18 its largest: the first get a
    // slack against which nothing is decided, the second an infinite one.
    const float largest = reach > 1e18 ? std::numeric_limits<float>::infinity()
                                       : static_cast<float>(std::max(reach, 1e-15));
    constexpr float e = 0x1p-24f;
    this->edge = 64.0f * e * largest;
    this->floor = this->edge * 16.0f * e * largest + 1e-37f;
    this->depth = 8.0f * e * largest;
  }
};

// A traversal ray as the sieve wants it.
struct SieveRay
{
  int x, y, z; // axes; z: one along which the direction is 1 or -1
  float originX, originY, originZ;
  float shearX, shearY;
  float forward; // the sign of the direction's z
  float end;     // parameter where the search ends, rounded outward

  HRT_ALWAYS_INLINE SieveRay(const float (&origin)[3], const float (&direction)[3], float last)
  {
    this->z = std::fabs(direction[0]) >= 1.0f ? 0 : (std::fabs(direction[1]) >= 1.0f ? 1 : 2);
    this->x = this->z == 2 ? 0 : this->z + 1;
    this->y = this->z == 0 ? 2 : this->z - 1;
    this->originX = origin[this->x];
    this->originY = origin[this->y];
    this->originZ = origin[this->z];
    this->forward = direction[this->z];
    this->shearX = direction[this->x] * this->forward;
    this->shearY = direction[this->y] * this->forward;
    this->end = last;
  }
};

// Which lanes may be hit, and which of these surely are.
struct SieveResult
{
  unsigned int possible = 0;
  unsigned int sure = 0;
};

// Bits of all lanes together; in words of two lanes, which takes compilers fewer steps.
HRT_ALWAYS_INLINE unsigned int unionOf(const std::int32_t (&lanes)[TriangleBlock::kLanes])
{
  std::uint64_t pairs[TriangleBlock::kLanes / 2];
  std::memcpy(pairs, lanes, sizeof(pairs));
  const std::uint64_t both = (pairs[0] | pairs[1]) | (pairs[2] | pairs[3]);
  return static_cast<unsigned int>(both | both >> 32);
}

// The loop body is what one lane does; compilers turn it into one pass over all lanes.
HRT_ALWAYS_INLINE SieveResult sieve(
  const TriangleBlock& block, const SieveRay& ray, const SieveSlack& slacks)
{
  constexpr int n = TriangleBlock::kLanes;
  const float* const xa = block.corner[0][ray.x];
  const float* const ya = block.corner[0][ray.y];
  const float* const za = block.corner[0][ray.z];
  const float* const xb = block.corner[1][ray.x];
  const float* const yb = block.corner[1][ray.y];
  const float* const zb = block.corner[1][ray.z];
  const float* const xc = block.corner[2][ray.x];
  const float* const yc = block.corner[2][ray.y];
  const float* const zc = block.corner[2][ray.z];
  const float ox = ray.originX, oy = ray.originY, oz = ray.originZ;
  const float sx = ray.shearX, sy = ray.shearY, forward = ray.forward;
  const float slack = slacks.edge, floor = slacks.floor;
  const float begin = slacks.depth, end = ray.end + slacks.depth;
  const float surelyBefore = ray.end * (1.0f - 0x1p-21f) - slacks.depth;
  std::int32_t possible[n], sure[n];
  for (int i = 0; i < n; ++i)
  {
    const float az = za[i] - oz, bz = zb[i] - oz, cz = zc[i] - oz;
    const float ax = (xa[i] - ox) - sx * az, ay = (ya[i] - oy) - sy * az;
    const float bx = (xb[i] - ox) - sx * bz, by = (yb[i] - oy) - sy * bz;
    const float cx = (xc[i] - ox) - sx * cz, cy = (yc[i] - oy) - sy * cz;
    const float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    const float sa = std::fabs(ax) + std::fabs(ay);
    const float sb = std::fabs(bx) + std::fabs(by);
    const float sc = std::fabs(cx) + std::fabs(cy);
    const float sab = sa > sb ? sa : sb, s = sab > sc ? sab : sc;
    const float bound = slack * s + floor;
    const float leastUv = u < v ? u : v, least = leastUv < w ? leastUv : w;
    const float mostUv = u > v ? u : v, most = mostUv > w ? mostUv : w;
    const float da = az * forward, db = bz * forward, dc = cz * forward;
    const float nearAb = da < db ? da : db, nearest = nearAb < dc ? nearAb : dc;
    const float farAb = da > db ? da : db, farthest = farAb > dc ? farAb : dc;
    const bool outside =
      ((least < -bound) & (most > bound)) | (nearest > end) | (farthest < -begin);
    const bool inside =
      ((least > bound) | (most < -bound)) & (nearest > begin) & (farthest < surelyBefore);
    possible[i] = outside ? 0 : 1 << i;
    sure[i] = inside ? 1 << i : 0;
  }
  SieveResult result;
  result.possible = unionOf(possible);
  result.sure = unionOf(sure);
  return result;
}

} // namespace hrt
