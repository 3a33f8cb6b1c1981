// The sieve of TriangleBlock.h for one ray, in plain C++ that compilers turn into vector instructions of
// whatever set the caller is compiled for. The kd-tree's; Embree's hierarchies have theirs in
// BvhKernels.inl, where rays too lie side by side.
#pragma once

#include "Rendering/Core/Structures/InstructionSet.h"
#include "Rendering/Core/Structures/TriangleBlock.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace hrt
{

// A traversal ray as the sieve wants it.
struct SieveRay
{
  int x, y, z; // axes; z: one along which the direction is 1 or -1
  float originX, originY, originZ;
  float shearX, shearY;
  float forward; // the sign of the direction's z
  float end;     // parameter where the search ends, rounded outward
  float begin;   // and before which no hit is sure to count: a twin of the ray's origin may be there

  HRT_ALWAYS_INLINE SieveRay(
    const float (&origin)[3], const float (&direction)[3], float first, float last)
  {
    this->begin = first;
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
  const float surelyAfter = ray.begin + slacks.depth;
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
      ((least > bound) | (most < -bound)) & (nearest > surelyAfter) & (farthest < surelyBefore);
    possible[i] = outside ? 0 : 1 << i;
    sure[i] = inside ? 1 << i : 0;
  }
  SieveResult result;
  result.possible = unionOf(possible);
  result.sure = unionOf(sure);
  return result;
}

} // namespace hrt
