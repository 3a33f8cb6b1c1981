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

// The ray from where it enters the outer box; parameters count from there, in units such that the
// direction's longest component is 1.
struct TraversalRay
{
  glm::vec3 origin;
  glm::vec3 direction;
  double start = 0.0; // the true ray's t at `origin`
  double scale = 1.0; // parameter per t

  // The end of the search for a true t, rounded outward: boxes at the same t stay in.
  float end(double t) const
  {
    const float parameter = static_cast<float>((t - this->start) * this->scale);
    return std::nextafter(parameter, std::numeric_limits<float>::infinity());
  }
};

// False when the ray, up to tMaximum, misses the grown outer box. The direction must be finite and
// not zero. The bound above holds for origins up to 2^28 reaches away: farther, the rounding of
// the entry point is no longer small beside the padding.
inline bool enterBox(const TraversalBox& box, const glm::dvec3& origin,
  const glm::dvec3& direction, double tMaximum, TraversalRay& ray)
{
  const double padding = box.padding();
  double enter = 0.0, leave = tMaximum;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double lower = box.lower[axis] - padding - origin[axis];
    const double upper = box.upper[axis] + padding - origin[axis];
    if (direction[axis] == 0.0)
    {
      if (lower > 0.0 || upper < 0.0)
      {
        return false;
      }
      continue;
    }
    const double t0 = lower / direction[axis], t1 = upper / direction[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter <= leave))
  {
    return false;
  }
  const glm::dvec3 lengths = glm::abs(direction);
  ray.start = enter;
  ray.scale = std::max({ lengths.x, lengths.y, lengths.z });
  ray.origin = glm::vec3(origin + enter * direction);
  ray.direction = glm::vec3(direction / ray.scale);
  return true;
}

} // namespace hrt
