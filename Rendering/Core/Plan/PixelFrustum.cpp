// See PixelFrustum.h.
#include "Rendering/Core/Plan/PixelFrustum.h"

namespace hrt
{

namespace
{

// Error of a clip coordinate that a vertex shader computes as a row of a float matrix times a corner,
// over the sum of the products' magnitudes: the matrix' rounding, the product's and three sums' are
// 5 * 2^-24; 8 * 2^-24 forgives a GPU that rounds a multiply-add less well.
constexpr double kVertexRounding = 0x1p-21;

// The planes go along the edges of the outermost pixels while samples lie at their centres. The half
// pixel between them is more than what remains, of the perspective division, of the viewport
// transformation (2^-10 pixels in a picture of 16,384) and of the rasteriser's grid (2^-8 pixels).
double edge(int pixel, int pixels)
{
  return 2.0 * pixel / pixels - 1.0;
}

} // namespace

PixelFrustum::PixelFrustum(const Camera& camera, const PixelBounds& bounds)
  : WorldToClip(camera.viewToClip * camera.worldToView)
{
  const PixelBounds inside = bounds.within(camera.width, camera.height);
  this->Empty = inside.empty();
  if (this->Empty)
  {
    return;
  }
  this->Planes[0] = { -1.0, 0.0, 0.0, edge(inside.x0, camera.width) };
  this->Planes[1] = { 1.0, 0.0, 0.0, -edge(inside.x1, camera.width) };
  this->Planes[2] = { 0.0, -1.0, 0.0, edge(inside.y0, camera.height) };
  this->Planes[3] = { 0.0, 1.0, 0.0, -edge(inside.y1, camera.height) };
  this->Planes[4] = { 0.0, 0.0, -1.0, -1.0 };
  this->Planes[5] = { 0.0, 0.0, 1.0, -1.0 };
}

// A box is outside of a plane when its corners are. Written so that a NaN counts as inside.
bool PixelFrustum::mayShow(const Part& part) const
{
  if (this->Empty || part.triangleCount() == 0)
  {
    return false;
  }
  const glm::dmat4 toClip =
    this->WorldToClip * (part.copies ? part.localToWorld : part.positionsToWorld());
  const glm::dvec3 lower =
    part.copies ? part.copies->boundsMin : glm::dvec3(part.geometry->boundsMin);
  const glm::dvec3 upper =
    part.copies ? part.copies->boundsMax : glm::dvec3(part.geometry->boundsMax);
  const glm::dvec3 farthest = glm::max(glm::abs(lower), glm::abs(upper));
  glm::dvec4 error = glm::abs(toClip[3]);
  for (int column = 0; column < 3; ++column)
  {
    error += farthest[column] * glm::abs(toClip[column]);
  }
  error *= kVertexRounding;

  bool beyond[6] = { true, true, true, true, true, true };
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 clip = toClip *
      glm::dvec4((corner & 1) ? upper.x : lower.x, (corner & 2) ? upper.y : lower.y,
        (corner & 4) ? upper.z : lower.z, 1.0);
    for (int i = 0; i < 6; ++i)
    {
      const double margin = glm::dot(glm::abs(this->Planes[i]), error);
      beyond[i] = beyond[i] && glm::dot(this->Planes[i], clip) > margin;
    }
  }
  for (const bool outside : beyond)
  {
    if (outside)
    {
      return false;
    }
  }
  return true;
}

} // namespace hrt
