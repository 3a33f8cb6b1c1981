// The one bound on coordinates, of a mesh and of a part in the world: what the scene's door refuses and
// what the ray structures leave out.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace hrt
{

// The largest coordinate admitted, Embree's own FLT_LARGE. Engines square differences of coordinates
// and add a few such products; (1.844e18)^2 = 3.4e36 leaves a factor of 100 to the largest float.
// A float itself, so that rounding a coordinate to single precision carries it over no bound.
inline constexpr double kLargestCoordinate = 1.844e18f;

// Finite and within the bound; no comparison that a NaN would pass.
inline bool isAdmissible(const glm::vec3& point)
{
  constexpr auto largest = static_cast<float>(kLargestCoordinate);
  return std::abs(point.x) <= largest && std::abs(point.y) <= largest &&
    std::abs(point.z) <= largest;
}
inline bool isAdmissible(const glm::dvec3& point)
{
  return std::abs(point.x) <= kLargestCoordinate && std::abs(point.y) <= kLargestCoordinate &&
    std::abs(point.z) <= kLargestCoordinate;
}

} // namespace hrt
