// By how much farther away the finished picture's depth is put for VTK than it was computed, so that what
// VTK draws in the same place as a traced surface - a translucent twin, a selection's outline, a contour -
// passes its depth test, as it does where VTK draws both.
//
// VTK's depth and ours are computed on different ways, each off by
//   - what rounding does to a corner's clip coordinates z and w. VTK multiplies a float matrix with float
//     coordinates: with u = 2^-24 each product has two roundings, the matrix' and its own, and the sum
//     three. No rounding is larger than u S(z), S the sum of the products' sizes; of five that do not know
//     of each other, each even between -u S and u S, three standard deviations are sqrt(15) u S < 4 u S.
//     Window depth, half of z / w, is then off by 2 u (S(z) + S(w)) / w, as |z| <= w; with ours,
//     which is computed so too, by sqrt(2) as much: 3 u (S(z) + S(w)) / w.
//   - what rounding does to depths between 0 and 1: of the division, the viewport's product and sum, and half
//     a step of a buffer of 24 bits, less than 4 u together.
//   - corners that the rasteriser snaps to 1/256 pixel: the same one may go to neighbours of that grid, which
//     moves the depth by its change from pixel to pixel over 256. As much again is for the rasteriser's
//     own interpolation from a far corner, whose rounding grows with that change.
#pragma once

#include "Rendering/Core/Snapshot.h"

namespace hrt
{
namespace gl
{

struct DepthMargin
{
  // 1 / w of a surface is perW[0] + perW[1] (z / w).
  float perW[2] = { 0.0f, 0.0f };
  // The margin is byW / w + fixed + bySlope times the depth's change from pixel to pixel.
  float byW = 0.0f;

  static constexpr float kFixed = 8.0f * 0x1p-24f; // of both ways
  static constexpr float kBySlope = 2.0f / 256.0f;
  // From pixel to pixel: what changes by more is another surface.
  static constexpr float kSteepest = 1.0f / 16.0f;

  static DepthMargin of(const Snapshot& snapshot);
};

} // namespace gl
} // namespace hrt
