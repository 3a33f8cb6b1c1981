// The near and the far plane as rays meet them: a rasteriser cuts triangles there, a ray has to be told.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Surface/SurfaceKernels.h"

#include <algorithm>

namespace hrt
{

class ClipPlanes
{
public:
  explicit ClipPlanes(const Snapshot& snapshot)
    : ToClip(snapshot.camera.viewToClip * snapshot.camera.worldToView)
  {
    this->ToClip[3] = this->ToClip * glm::dvec4(snapshot.origin, 1.0);
  }

  // The part of a ray, from `first` to `last`, that lies between the planes; false when none does.
  bool between(const Ray& ray, double& first, double& last) const
  {
    const glm::dvec4 from = this->ToClip * glm::dvec4(ray.origin, 1.0);
    const glm::dvec4 along = this->ToClip * glm::dvec4(ray.direction, 0.0);
    first = 0.0;
    last = ray.tMaximum;
    // Inside, w + z and w - z are positive; each is linear along the ray.
    for (const double sign : { 1.0, -1.0 })
    {
      const double start = from.w + sign * from.z;
      const double slope = along.w + sign * along.z;
      if (slope > 0.0)
      {
        first = std::max(first, -start / slope);
      }
      else if (slope < 0.0)
      {
        last = std::min(last, -start / slope);
      }
      else if (start < 0.0)
      {
        return false;
      }
    }
    return first < last;
  }

  // z / w in OpenGL's clip space, -1 near to 1 far, of a point relative to the snapshot's origin.
  double depth(const glm::dvec3& position) const
  {
    const glm::dvec4 clip = this->ToClip * glm::dvec4(position, 1.0);
    return glm::clamp(clip.z / clip.w, -1.0, 1.0);
  }

  // For lanes.
  ClipRows rows() const
  {
    ClipRows rows;
    for (int column = 0; column < 4; ++column)
    {
      rows.z[column] = this->ToClip[column][2];
      rows.w[column] = this->ToClip[column][3];
    }
    return rows;
  }

private:
  glm::dmat4 ToClip; // from coordinates relative to the snapshot's origin
};

} // namespace hrt
