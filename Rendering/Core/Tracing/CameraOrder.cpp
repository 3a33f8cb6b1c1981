// Implements the camera's order.
#include "Rendering/Core/Tracing/CameraOrder.h"

#include <algorithm>

namespace hrt
{

CameraOrder::CameraOrder(const Snapshot& snapshot, const Surfaces& surfaces)
  : Scene(snapshot)
  , Points(surfaces)
  , Planes(snapshot)
{
  const DepthOffset* first = nullptr;
  bool bySlope = false;
  for (const Part& part : snapshot.parts)
  {
    if (part.visibleToCamera)
    {
      const DepthOffset& offset = part.material.depthOffset;
      first = first ? first : &offset;
      bySlope = bySlope || offset.slope != 0.0f;
      this->AnyOffset = this->AnyOffset || offset.any();
      this->OffsetsDiffer = this->OffsetsDiffer || !(offset == *first);
    }
  }
  this->OffsetsDiffer = this->OffsetsDiffer || bySlope;
  if (bySlope)
  {
    glm::dmat4 toClip = snapshot.camera.viewToClip * snapshot.camera.worldToView;
    toClip[3] = toClip * glm::dvec4(snapshot.origin, 1.0);
    this->PlaneToClip = glm::transpose(glm::inverse(toClip));
  }
}

const Material& CameraOrder::materialOf(const Hit& hit) const
{
  return this->Scene.parts[this->Scene.partOf(hit.triangle)].material;
}

bool CameraOrder::hides(const Ray& ray, const Hit& one, const Hit& other) const
{
  if (this->OffsetsDiffer &&
    !(this->materialOf(one).depthOffset == this->materialOf(other).depthOffset))
  {
    const double depth = this->clipDepth(ray, one), otherDepth = this->clipDepth(ray, other);
    return depth < otherDepth ||
      (depth == otherDepth && this->Scene.drawnAfter(one.triangle, other.triangle));
  }
  const HitWindow window = this->Points.coincidence().windowOf(ray.direction);
  const Hit &near = one.before(other) ? one : other, &far = one.before(other) ? other : one;
  if (window.holds(near.t, far.t) &&
    (near.t == far.t ||
      this->Points.coincidence().inOnePlace(
        near.triangle, far.triangle, this->Points.positionOf(near), kSetMargin)))
  {
    return this->Scene.drawnAfter(one.triangle, other.triangle);
  }
  return one.t < other.t;
}

// In a plane's image z / w is affine: from pixel to pixel it changes by the same everywhere. A plane,
// as the row of its coefficients (a, b, c, d), is L = (a, b, c, d) M^-1 in clip space, where L (x, y, z, w)
// vanishes on it; so z / w changes with x / w by -L.x / L.z.
double CameraOrder::clipDepth(const Ray& ray, const Hit& hit) const
{
  const double depth = this->Planes.depth(ray.origin + hit.t * ray.direction);
  if (!this->AnyOffset)
  {
    return depth;
  }
  const DepthOffset& offset = this->materialOf(hit).depthOffset;
  if (!offset.any())
  {
    return depth;
  }
  double moved = offset.constant; // in window depth, half of clip space's
  if (offset.slope != 0.0f)
  {
    const SurfacePoint point = this->Points.at(hit, ray.direction);
    const glm::dvec3& n = point.geometricNormal;
    const glm::dvec4 plane = this->PlaneToClip * glm::dvec4(n, -glm::dot(n, point.position));
    const glm::dvec2 perPixel(
      plane.x / plane.z / this->Scene.camera.width, plane.y / plane.z / this->Scene.camera.height);
    moved += offset.slope * glm::length(perPixel);
  }
  return std::clamp(depth + 2.0 * moved, -1.0, 1.0);
}

} // namespace hrt
