// A ray against axis-aligned planes, in double precision and never too late or too early: what the
// kd-tree and the tree of the parts share.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hrt
{

// Every box and half-space is met as if grown by `slack`, the bound of what rounding can do to ray and
// box. Where a comparison involves what is not a number, the box counts as met.
class KdSlabs
{
public:
  KdSlabs() = default;
  KdSlabs(const glm::dvec3& origin, const glm::dvec3& direction, double slack)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      // For a component of zero the largest number stands in for infinity: no 0 * inf, no division by
      // zero, and places in front of, on and behind the plane are still told apart.
      constexpr double kLargest = std::numeric_limits<double>::max();
      this->Inverse[axis] = direction[axis] == 0.0
        ? std::copysign(kLargest, direction[axis])
        : std::max(-kLargest, std::min(kLargest, 1.0 / direction[axis]));
      this->Negative[axis] = std::signbit(direction[axis]);
      const double grown = this->Negative[axis] ? -slack : slack;
      this->FarOrigin[axis] = origin[axis] + grown;
      this->NearOrigin[axis] = origin[axis] - grown;
    }
  }

  // 1 when the ray runs from the upper side of planes to the lower one.
  std::uint32_t negative(unsigned axis) const { return this->Negative[axis]; }

  // Where the ray is first as near to what lies behind the plane as the slack, and where it is last as
  // near to what lies before.
  double farStart(unsigned axis, double plane) const
  {
    return (plane - this->FarOrigin[axis]) * this->Inverse[axis];
  }
  double nearEnd(unsigned axis, double plane) const
  {
    return (plane - this->NearOrigin[axis]) * this->Inverse[axis];
  }

  // Narrows [start, end] to the box; false when nothing is left.
  bool meet(const glm::dvec3& lower, const glm::dvec3& upper, double& start, double& end) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double in = this->Negative[axis] ? upper[axis] : lower[axis];
      const double out = this->Negative[axis] ? lower[axis] : upper[axis];
      // The operands' order drops what is not a number.
      start = std::max(start, this->farStart(axis, in));
      end = std::min(end, this->nearEnd(axis, out));
    }
    return !(start > end);
  }

private:
  double FarOrigin[3], NearOrigin[3], Inverse[3];
  std::uint32_t Negative[3];
};

} // namespace hrt
