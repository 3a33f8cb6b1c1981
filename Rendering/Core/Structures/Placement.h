// How far rounding can part what a structure holds in coordinates of its own from a ray that comes
// from the scene's: the matrix in between, and how far away the ray begins, decide. Both structures
// work in such coordinates and have to let the exact kernel, which works in the scene's, see all
// that it may hit.
#pragma once

#include "Rendering/Core/Structures/InstructionSet.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace hrt
{

// Half an ulp of 1 in double precision.
inline constexpr double kRounding = 0x1p-53;

// GLM's abs compares and negates, and raises an exception for what is not a number.
HRT_ALWAYS_INLINE glm::dvec3 sizes(const glm::dvec3& v)
{
  return { std::fabs(v.x), std::fabs(v.y), std::fabs(v.z) };
}
HRT_ALWAYS_INLINE double largest(const glm::dvec3& v)
{
  return std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
}

struct Placement
{
  double perUnit = 0.0;    // of `slack`, for each unit of the scene's reach and of the ray's origin
  double sceneReach = 0.0; // of everything on the way to the scene's coordinates

  Placement() = default;
  // `inverse`: the matrix' without its translation, as computed. `reach`: the largest coordinate in
  // the structure's own coordinates.
  Placement(const glm::dmat4& toScene, const glm::dmat3& inverse, double reach);

  // How far, in the structure's coordinates, triangles and a ray whose origin lies within
  // `originReach` of the scene's can lie from where the numbers say.
  double slack(double originReach) const
  {
    return this->perUnit * (originReach + this->sceneReach);
  }
};

} // namespace hrt
