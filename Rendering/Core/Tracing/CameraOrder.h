// Which of two surfaces on one of its rays the camera is shown, as a depth test would have it: the nearer
// one, by depths that polygon offsets have moved; of those in one place (Geometry/Coincidence.h) the one
// that is drawn last.
#pragma once

#include "Rendering/Core/Tracing/ClipPlanes.h"
#include "Rendering/Core/Tracing/Surface.h"

namespace hrt
{

class CameraOrder
{
public:
  // Both must outlive it.
  CameraOrder(const Snapshot& snapshot, const Surfaces& surfaces);

  bool anyOffset() const { return this->AnyOffset; }

  // Offsets may bring a surface before another that is nearer.
  bool offsetsMatter() const { return this->OffsetsDiffer; }

  // Whether the one hides the other. The ray is cut by no plane: see ClipPlanes.
  bool hides(const Ray& ray, const Hit& one, const Hit& other) const;

  // z / w in OpenGL's clip space, -1 near to 1 far, where the camera is shown a hit.
  double clipDepth(const Ray& ray, const Hit& hit) const;

private:
  const Material& materialOf(const Hit& hit) const;

  const Snapshot& Scene;
  const Surfaces& Points;
  ClipPlanes Planes;
  bool AnyOffset = false;
  bool OffsetsDiffer = false;
  glm::dmat4 PlaneToClip{ 1.0 }; // of a plane in coordinates relative to the scene's origin, as a row
};

} // namespace hrt
