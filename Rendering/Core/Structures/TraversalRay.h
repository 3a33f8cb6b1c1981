// A single-precision stand-in for a double-precision ray, good enough to find every box that the
// true ray meets. It lets a float hierarchy serve an exact kernel: the hierarchy proposes, the
// kernel decides, and the padding derived here guarantees that nothing is left unproposed.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hrt
{

// The outer box of one hierarchy. `reach` is the largest absolute coordinate in it.
struct TraversalBox
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  void include(const glm::dvec3& point)
  {
    this->lower = glm::min(this->lower, point);
    this->upper = glm::max(this->upper, point);
  }

  double reach() const
  {
    const glm::dvec3 most = glm::max(glm::abs(this->lower), glm::abs(this->upper));
    return std::max({ most.x, most.y, most.z });
  }

  // How far each box within the hierarchy is grown, so that one fused multiplication a plane
  // decides whether a ray meets a box, with no allowance at the node: for the plane at p, p * r - o
  // * r with r the float next to the reciprocal of the direction's component, o the float origin.
  // With R the reach, H half the longest side and e = 2^-24, half an ulp, a plane is as if moved by
  //   R e   the rounding of the origin, which lies on or in the outer box,
  //   R e   that of o * r, which is e |o| in units of r,
  //   R e   that of p * r where the processor does not fuse,
  //   R e   that of the grown plane itself,
  //   R e   that of the corners, where they are merged into the coordinates of others,
  //   R e   everything done in double, for near rays (BvhTopLevel.h).
  // The parameter is then off by the factors 1 + e of r and of the difference: beside a parameter
  // of at most 2 H, which is as far as the ray runs within the box, by 4 H e, and |r| >= 1.
  // Together 6 R e + 4 H e. The rest of 7 is for kSteepest. The floor keeps a box at the origin
  // from vanishing among the smallest numbers.
  double padding() const
  {
    const glm::dvec3 side = this->upper - this->lower;
    const double half = 0.5 * std::max({ side.x, side.y, side.z });
    return std::max(7.0 * 0x1p-24 * (this->reach() + half), 1e-30);
  }
};

// An outer box, grown, as rays meet it.
struct EntryBox
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  EntryBox() = default;
  // `margin`: what it is grown by beyond its padding.
  explicit EntryBox(const TraversalBox& box, double margin = 0.0)
    : lower(box.lower - (box.padding() + margin))
    , upper(box.upper + (box.padding() + margin))
  {
  }
};

// Reciprocals of the direction's components end here: its product with the largest coordinate
// admitted is a finite float, and a ray tilted by 1e-18 is, over 2 R, off by far less than R e.
inline constexpr double kSteepest = 1e18;

// Lengths of directions, by their longest component, for which the exact kernel's t, and its
// products on the way to it, are normal numbers for all coordinates admitted, and for which `slope`
// is right. Beyond, the kernel refuses some hits, as infinite or zero, however surely the triangle
// is met.
inline constexpr double kShortest = 1e-100, kLongest = 1e100;

// The reciprocal of a component of a direction in units of the longest, from kShortest to kLongest;
// for none that of a ray tilted by next to nothing. No exception is raised, which hosts may trap,
// and products with coordinates are finite.
HRT_ALWAYS_INLINE double slope(double longest, double component)
{
  return longest / (component + std::copysign(1e-150, component));
}

// The ray from where it enters the outer box; parameters count from there, in units such that the
// direction's longest component is 1 or -1, exactly.
struct TraversalRay
{
  glm::vec3 origin;
  glm::vec3 direction;
  glm::vec3 inverse;   // of the direction, never infinite
  double start = 0.0;  // of the box, in the same units from the true ray's origin
  double scale = 1.0;  // parameter per t
  double margin = 0.0; // how far everything may lie from where the numbers say, beyond the padding

  // The end of the search for a true t, rounded outward: boxes at the same t stay in. Two ulps are
  // for the two roundings.
  float end(double t) const
  {
    const double parameter = std::max(t * this->scale - this->start + this->margin, 0.0);
    return static_cast<float>(parameter) * (1.0f + 0x1p-22f) + std::numeric_limits<float>::min();
  }

  // Before here, rounded outward, a hit may be on a twin of the ray's origin. `twinEnd`: Ray's.
  float begin(float twinEnd) const { return this->end(static_cast<double>(twinEnd)); }
};

// Asked without arithmetic, which would raise floating-point exceptions in hosts that trap them.
HRT_ALWAYS_INLINE bool isFinite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// A finite ray whose direction is not zero, by the exact kernel's rule: some component is normal.
HRT_ALWAYS_INLINE bool isUsable(const glm::dvec3& origin, const glm::dvec3& direction)
{
  if (!isFinite(origin) || !isFinite(direction))
  {
    return false;
  }
  return largest(direction) >= std::numeric_limits<double>::min();
}

// Whether its length is within these; false for what is not a number.
HRT_ALWAYS_INLINE bool isOrdinary(const glm::dvec3& direction)
{
  const glm::dvec3 lengths = sizes(direction);
  return std::islessequal(lengths.x, kLongest) && std::islessequal(lengths.y, kLongest) &&
    std::islessequal(lengths.z, kLongest) &&
    std::max({ lengths.x, lengths.y, lengths.z }) >= kShortest;
}

// False when the ordinary ray, up to tMaximum, misses the grown outer box. `margin`:
// TraversalRay's.
HRT_ALWAYS_INLINE bool enterBox(const EntryBox& box, const glm::dvec3& origin,
  const glm::dvec3& direction, double tMaximum, double margin, TraversalRay& ray)
{
  ray.scale = largest(direction);
  ray.margin = margin;
  const glm::dvec3 along = direction * (1.0 / ray.scale);
  const glm::dvec3 inverse(
    slope(ray.scale, direction.x), slope(ray.scale, direction.y), slope(ray.scale, direction.z));
  double enter = 0.0, leave = tMaximum * ray.scale + margin;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double t0 = (box.lower[axis] - origin[axis]) * inverse[axis];
    const double t1 = (box.upper[axis] - origin[axis]) * inverse[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter <= leave))
  {
    return false;
  }
  ray.start = enter;
  ray.origin = glm::vec3(origin + enter * along);
  ray.direction = glm::vec3(along);
  ray.inverse = glm::vec3(glm::clamp(inverse, -kSteepest, kSteepest));
  return true;
}

} // namespace hrt
