// The coordinates that the GPU shades in, and that shadow maps are looked up in: view coordinates, which are
// VTK's, as long as single precision holds the scene there. Where the eye is far from the scene in terms of the
// scene's size - a parallel camera may stand anywhere, one with a long lens has to - they are moved along
// the view's axis, so that the scene's origin is at depth 0.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace hrt
{

// How many times the scene's radius the eye may be away. A coordinate that large is rounded by 2^-20 of the
// radius, far less than what a texel of a shadow map covers.
inline constexpr double kFarEye = 16.0;

struct ShadingFrame
{
  glm::dmat4 fromWorld;
  glm::dmat4 toView;      // a move along the axis, or none
  glm::dvec3 viewer{ 0.0 }; // the origin of view coordinates
  CameraRays rays;        // the camera's

  explicit ShadingFrame(const Snapshot& snapshot)
    : fromWorld(snapshot.camera.worldToView)
    , toView(1.0)
    , rays(snapshot.camera.viewRays())
  {
    const glm::dvec4 origin = this->fromWorld * glm::dvec4(snapshot.origin, 1.0);
    const double depth = origin.z / origin.w;
    const glm::dvec3 size = glm::max(snapshot.boundsMax - snapshot.boundsMin, glm::dvec3(0.0));
    // Of view coordinates that are scaled, as the axis is.
    const double scale = glm::length(glm::dvec3(this->fromWorld[0]));
    if (std::isgreater(std::abs(depth), kFarEye * 0.5 * scale * glm::length(size)))
    {
      const glm::dvec3 along(0.0, 0.0, depth);
      this->toView = glm::translate(glm::dmat4(1.0), along);
      this->fromWorld = glm::translate(glm::dmat4(1.0), -along) * this->fromWorld;
      this->viewer = -along;
      this->rays.origin0 -= along;
    }
  }
};

} // namespace hrt
