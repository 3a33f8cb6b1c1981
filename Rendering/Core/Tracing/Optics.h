// The directions in which a ray goes on at a mirror or at glass, for surfaces whose shading normal is
// interpolated and may disagree with the face that was hit.
#pragma once

#include "Rendering/Core/Tracing/Fresnel.h"
#include "Rendering/Core/Tracing/Surface.h"

namespace hrt
{

// What becomes of a ray at a glass surface.
struct Boundary
{
  glm::dvec3 reflected;
  glm::dvec3 refracted{ 0.0 };
  double reflectance = 1.0; // 1: nothing is refracted
};

// An interpolated normal may be turned away from the viewer where the face is not.
inline glm::dvec3 normalTowardsViewer(const SurfacePoint& point, const glm::dvec3& direction)
{
  return glm::dot(point.opticalNormal, direction) < 0.0 ? point.opticalNormal
                                                        : point.geometricNormal;
}

// By the shading normal, or by the face's own where that would lead below the surface.
inline glm::dvec3 mirrorDirection(const SurfacePoint& point, const glm::dvec3& direction)
{
  const glm::dvec3 smooth = reflected(direction, normalTowardsViewer(point, direction));
  return glm::dot(smooth, point.geometricNormal) > 0.0
    ? smooth
    : reflected(direction, point.geometricNormal);
}

inline Boundary boundaryAt(const SurfacePoint& point, const glm::dvec3& direction)
{
  Boundary boundary;
  boundary.reflected = mirrorDirection(point, direction);
  const double index = point.material->indexOfRefraction;
  const double eta = point.outside ? 1.0 / index : index;
  glm::dvec3 normal = normalTowardsViewer(point, direction);
  if (!refracted(direction, normal, eta, boundary.refracted))
  {
    return boundary;
  }
  if (!(glm::dot(boundary.refracted, point.geometricNormal) < 0.0))
  {
    normal = point.geometricNormal; // the smooth direction does not cross the face
    if (!refracted(direction, normal, eta, boundary.refracted))
    {
      return boundary;
    }
  }
  boundary.reflectance = fresnelReflectance(-glm::dot(direction, normal), eta);
  return boundary;
}

} // namespace hrt
