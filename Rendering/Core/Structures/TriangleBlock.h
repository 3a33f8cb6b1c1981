// Eight neighbouring triangles in single precision, tested together: a sieve before the exact
// kernel. It may let a triangle pass that the kernel refuses, never the other way round; what the
// kernel then says is the result. That is why the sieve may use any instruction set and fused
// operations.
//
// The edge functions are those of Geometry/TriangleIntersection.h, rounded to float. Let R be the reach of
// the hierarchy's box (TraversalRay.h), e = 2^-24. Against the true ray and the true corners,
//   a corner relative to the origin is off by 5 R e: the corner's own rounding R e, the origin's R
//   e, R e for everything done in double (TraversalBox::padding, or what a larger R makes up for), and that of a
//   difference of up to 2 R; its sheared coordinate by 18 R e: twice the above, the shear's rounding
//   times a depth of 2 R, the rounding of a product of 2 R and of a difference of 4 R; an edge
//   function, with s the larger |x| + |y| of a corner, by 2 * 18 R e * s for the factors,
//   2 (18 R e)^2 for their errors' products and 4 e * 4 R * s for three roundings.
// Together 52 R e * (s + 13 R e), where a larger s does as well; the rest of 64 and 16 is to spare.
#pragma once

#include "Rendering/Core/Structures/TraversalRay.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace hrt
{

struct alignas(64) TriangleBlock // five cache lines
{
  static constexpr int kLanes = 8;
  float corner[3][3][kLanes];     // corner, axis, lane
  std::uint32_t triangle[kLanes]; // the geometry's number of it
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

static_assert(sizeof(TriangleBlock) == 320, "blocks are read by whole cache lines");

// Which lanes may be hit, and which of these surely are.
struct SieveResult
{
  unsigned int possible = 0;
  unsigned int sure = 0;
};

} // namespace hrt
