// The truth that the tests hold every engine against: the nearest triangle of each pixel's ray by
// trying the triangles one by one in double precision, without any acceleration structure and
// without the product's own intersection code (signed volumes here, a sheared test there).
//
// To be usable on a mesh of 70,000 triangles and 480,000 rays, a triangle is tried only with the rays
// of its own box in the picture, one pixel wider on each side: a ray outside of it cannot meet the
// triangle. A triangle that crosses the eye's plane is tried with every ray.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <vector>

namespace hrt
{
namespace reference
{

struct Pixel
{
  TriangleId triangle = kNoTriangle; // of equally near ones the largest number
  double t = 0.0;                    // in the length of CameraRays::direction
  double u = 0.0, v = 0.0;
  // The next nearest hit's distance relative to t: how clear the decision is. Infinite: no other.
  double gap = 0.0;
};

// width x height pixels, row 0 at the bottom. Only parts that the camera sees; the near and far
// planes cut, as the rasteriser does.
std::vector<Pixel> bruteForce(const Snapshot& snapshot);

} // namespace reference
} // namespace hrt
