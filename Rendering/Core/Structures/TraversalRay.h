// A single-precision stand-in for a double-precision ray, good enough to find every box that the
// true ray meets. It lets a float hierarchy serve an exact kernel: the hierarchy proposes, the
// kernel decides, and the padding derived here guarantees that nothing is left unproposed.
#pragma once

#include "Rendering/Core/Snapshot.h"

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

  // How far each box within the hierarchy is grown. With R the reach and e = 2^-24, half an ulp:
  //   the ray starts on or in the outer box, where rounding moves it by            R e,
  //   its direction's longest component is 1; rounding turns it, over the length
  //   of at most 2 R that the ray runs within the box, by                          2 R e / 2,
  //   a grown face is itself rounded, by about                                     R e,
  // together 3 R e. The rest of 4 R e is for everything done in double, which is a million times
  // finer. Embree's robust mode covers the rounding of its own box test. The floor keeps a box at
  // the origin from vanishing among Embree's smallest numbers.
  double padding() const { return std::max(0x1p-22 * this->reach(), 1e-30); }
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

// The ray from where it enters the outer box; parameters count from there, in units such that the
// direction's longest component is 1 or -1, exactly.
struct TraversalRay
{
  glm::vec3 origin;
  glm::vec3 direction;
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
inline bool isUsable(const glm::dvec3& origin, const glm::dvec3& direction)
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
inline bool enterBox(const EntryBox& box, const glm::dvec3& origin, const glm::dvec3& direction,
  double tMaximum, TraversalRay& ray)
{
  const glm::dvec3 lengths = glm::abs(direction);
  ray.scale = std::max({ lengths.x, lengths.y, lengths.z });
  const glm::dvec3 along = inUnitsOf(ray.scale, direction);
  // A ray parallel to two faces is before both at minus infinity, or before or behind both: the
  // products say so. Only on a grown face is one no number, and then either answer is right.
  const glm::dvec3 inverse = 1.0 / along;
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
  return enter <= leave;
}

} // namespace hrt
