// A single-precision stand-in for a double-precision ray, good enough to find every box that the
// true ray meets. It lets a float hierarchy serve an exact kernel: the hierarchy proposes, the
// kernel decides, and the padding derived here guarantees that nothing is left unproposed.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/InstructionSet.h"

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
  //   R e   that of the grown plane itself.
  // The parameter is then off by the factors 1 + e of r and of the difference: beside a parameter
  // of at most 2 H, which is as far as the ray runs within the box, by 4 H e, and |r| >= 1.
  // Together 4 (R + H) e. The rest of 5 is for everything done in double, a million times finer,
  // and for kSteepest. The floor keeps a box at the origin from vanishing among the smallest
  // numbers.
  double padding() const
  {
    const glm::dvec3 side = this->upper - this->lower;
    const double half = 0.5 * std::max({ side.x, side.y, side.z });
    return std::max(5.0 * 0x1p-24 * (this->reach() + half), 1e-30);
  }
};

// An outer box, grown, as rays meet it.
struct EntryBox
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  EntryBox() = default;
  explicit EntryBox(const TraversalBox& box)
    : lower(box.lower - box.padding())
    , upper(box.upper + box.padding())
  {
  }
};

// Reciprocals of the direction's components end here: its product with the largest coordinate
// admitted is a finite float, and a ray tilted by 1e-18 is, over 2 R, off by far less than R e.
inline constexpr double kSteepest = 1e18;

// The ray from where it enters the outer box; parameters count from there, in units such that the
// direction's longest component is 1 or -1, exactly.
struct TraversalRay
{
  glm::vec3 origin;
  glm::vec3 direction;
  glm::vec3 inverse;  // of the direction, never infinite
  double start = 0.0; // of the box, in the same units from the true ray's origin
  double scale = 1.0; // parameter per t

  // The end of the search for a true t, rounded outward: boxes at the same t stay in. Two ulps are
  // for the two roundings.
  float end(double t) const
  {
    const double parameter = std::max(t * this->scale - this->start, 0.0);
    return static_cast<float>(parameter) * (1.0f + 0x1p-22f) + std::numeric_limits<float>::min();
  }
};

// A finite ray whose direction is not zero, by the exact kernel's rule: some component is normal.
HRT_ALWAYS_INLINE bool isUsable(const glm::dvec3& origin, const glm::dvec3& direction)
{
  // Asked without arithmetic, which would raise floating-point exceptions in hosts that trap them.
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!std::isfinite(origin[axis]) || !std::isfinite(direction[axis]))
    {
      return false;
    }
  }
  const glm::dvec3 lengths = glm::abs(direction);
  return std::max({ lengths.x, lengths.y, lengths.z }) >= std::numeric_limits<double>::min();
}

// The direction in units of its longest component. A reciprocal saves two divisions, but that of a
// very large number is not a normal one.
inline glm::dvec3 inUnitsOf(double longest, const glm::dvec3& direction)
{
  return longest < 1e300 ? direction * (1.0 / longest) : direction / longest;
}

// False when the usable ray, up to tMaximum, misses the grown outer box. The bound above holds for
// origins up to 2^26 reaches away: farther, the rounding of the entry point is no longer small
// beside the padding.
HRT_ALWAYS_INLINE bool enterBox(const EntryBox& box, const glm::dvec3& origin,
  const glm::dvec3& direction, double tMaximum, TraversalRay& ray)
{
  const glm::dvec3 lengths = glm::abs(direction);
  ray.scale = std::max({ lengths.x, lengths.y, lengths.z });
  const glm::dvec3 along = inUnitsOf(ray.scale, direction);
  // A ray parallel to two faces is before both at minus infinity, or before or behind both: the
  // products say so. Only on a grown face is one no number, and then either answer is right.
  const glm::dvec3 inverse = ray.scale / direction;
  double enter = 0.0, leave = tMaximum * ray.scale;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double t0 = (box.lower[axis] - origin[axis]) * inverse[axis];
    const double t1 = (box.upper[axis] - origin[axis]) * inverse[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  ray.start = enter;
  ray.origin = glm::vec3(origin + enter * along);
  ray.direction = glm::vec3(along);
  ray.inverse = glm::vec3(glm::clamp(inverse, -kSteepest, kSteepest));
  return enter <= leave;
}

} // namespace hrt
