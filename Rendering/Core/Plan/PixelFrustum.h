// Which parts a rectangle of the picture can show. A worker that draws one tile leaves the others out,
// which is what sort-first gains; the answer may err to one side only, so that no pixel can tell.
#pragma once

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Snapshot.h"

namespace hrt
{

class PixelFrustum
{
public:
  PixelFrustum(const Camera& camera, const PixelBounds& bounds);

  // False only when neither a ray through a pixel's centre nor a rasteriser that works in single
  // precision can find the part within the bounds and between the clip planes. A part near a corner
  // of the frustum may be counted as seen, which costs time but no pixel.
  bool mayShow(const Part& part) const;

private:
  glm::dmat4 WorldToClip;
  glm::dvec4 Planes[6]; // in clip space; a point p is outside where dot(plane, p) > 0
  bool Empty;
};

} // namespace hrt
