// The coordinates that the GPU shades in, and that shadow maps are looked up in: view coordinates, which are
// VTK's, as long as single precision can do with them.
//
// Where the eye is far from the scene in terms of the scene's size - a parallel camera may stand anywhere, one
// with a long lens has to - they are moved along the view's axis, so that the scene's origin is at depth 0.
// Where the scene is so small or so large that products of four lengths, as the square of a triangle's
// normal is one, leave the range of float, they are scaled by a power of two: then units do not matter.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace hrt
{

// How many times the scene's radius the eye may be away. A coordinate that large is rounded by 2^-20 of the
// radius, far less than what a texel of a shadow map covers.
inline constexpr double kFarEye = 16.0;

// Scenes of a radius up to this, or down to its reciprocal, are not scaled. Within a scene lengths span a
// few powers of ten more: (2^12)^4 = 2^48 of the 2^126 that float has either way leaves 2^19 to a length.
inline constexpr double kLargeScene = 4096.0;

struct ShadingFrame
{
  glm::dmat4 fromWorld;
  glm::dmat4 toView;        // back to view coordinates
  double scale = 1.0;       // of lengths in view coordinates
  glm::dvec3 viewer{ 0.0 }; // the origin of view coordinates
  CameraRays rays;          // the camera's

  explicit ShadingFrame(const Snapshot& snapshot)
    : rays(snapshot.camera.viewRays())
  {
    const glm::dmat4& view = snapshot.camera.worldToView;
    const glm::dvec4 origin = view * glm::dvec4(snapshot.origin, 1.0);
    const double depth = origin.z / origin.w;
    const glm::dvec3 size = glm::max(snapshot.boundsMax - snapshot.boundsMin, glm::dvec3(0.0));
    // The view may be scaled itself.
    const double radius = 0.5 * glm::length(size) * glm::length(glm::dvec3(view[0]));
    glm::dvec3 moved(0.0);
    if (std::isgreater(std::abs(depth), kFarEye * radius))
    {
      moved.z = depth;
    }
    if (std::isgreater(radius, 0.0) && std::isfinite(radius) &&
      (radius > kLargeScene || radius < 1.0 / kLargeScene))
    {
      this->scale = std::exp2(-std::round(std::log2(radius)));
    }
    this->fromWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(this->scale)) *
      (glm::translate(glm::dmat4(1.0), -moved) * view);
    this->toView = glm::scale(
      glm::translate(glm::dmat4(1.0), moved), glm::dvec3(1.0 / this->scale));
    this->viewer = -this->scale * moved;
    this->rays.origin0 = this->scale * (this->rays.origin0 - moved);
    this->rays.originX *= this->scale;
    this->rays.originY *= this->scale;
  }
};

} // namespace hrt
