// What rounding is worth in the geometry of rays and triangles, for all that computes it: one by one and in
// lanes. No more may be included here: see Surface/SurfaceKernels.h.
#pragma once

namespace hrt
{

// Edge functions are taken without cancellation where their sum is less than this share of the magnitudes
// of the products that they are made of: d < M / 4 of Geometry/TriangleIntersection.h.
inline constexpr double kCancelled = 0.25;

// Of what is computed in double from corners, relative to their size: Geometry/Coincidence.h.
inline constexpr double kComputedRounding = 0x1p-43;

// Barycentric coordinates above this are far enough inside, unless the triangle is a million times less
// high than the scene is large: for most points nothing more is computed.
inline constexpr double kSurelyInside = 0x1p-20;

} // namespace hrt
