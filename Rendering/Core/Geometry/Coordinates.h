// The one bound on coordinates: what the scene's door refuses and what the ray structures leave out.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace hrt
{

// The largest coordinate admitted, Embree's own FLT_LARGE. Engines square differences of coordinates
// and add a few such products; (1.844e18)^2 = 3.4e36 leaves a factor of 100 to the largest float.
inline constexpr double kLargestCoordinate = 1.844e18;

// Finite and within the bound; no comparison that a NaN would pass.
inline bool isAdmissible(const glm::vec3& point)
{
  constexpr auto largest = static_cast<float>(kLargestCoordinate);
  return std::abs(point.x) <= largest && std::abs(point.y) <= largest &&
    std::abs(point.z) <= largest;
}

} // namespace hrt
