// How light divides at a smooth boundary between two media: directions by the laws of reflection
// and refraction, shares by Fresnel's equations for unpolarised light.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace hrt
{

// Share of light reflected at a boundary between dielectrics. `cosine`: of the angle between the
// arriving ray and the normal, in [0, 1]; `eta`: index of refraction of the medium the ray comes
// from over that of the medium it enters. 1 under total internal reflection.
inline double fresnelReflectance(double cosine, double eta)
{
  const double sinSquaredInside = eta * eta * (1.0 - cosine * cosine);
  if (sinSquaredInside >= 1.0)
  {
    return 1.0;
  }
  const double inside = std::sqrt(1.0 - sinSquaredInside);
  const double across = (eta * cosine - inside) / (eta * cosine + inside);
  const double along = (cosine - eta * inside) / (cosine + eta * inside);
  return 0.5 * (across * across + along * along);
}

// A unit direction mirrored at a plane with unit normal.
inline glm::dvec3 reflected(const glm::dvec3& direction, const glm::dvec3& normal)
{
  return direction - 2.0 * glm::dot(direction, normal) * normal;
}

// Snell's law for a unit direction that arrives against the unit normal. False under total internal
// reflection.
inline bool refracted(
  const glm::dvec3& direction, const glm::dvec3& normal, double eta, glm::dvec3& out)
{
  const double cosine = -glm::dot(direction, normal);
  const double sinSquaredInside = eta * eta * (1.0 - cosine * cosine);
  if (sinSquaredInside >= 1.0)
  {
    return false;
  }
  out = eta * direction + (eta * cosine - std::sqrt(1.0 - sinSquaredInside)) * normal;
  return true;
}

} // namespace hrt
