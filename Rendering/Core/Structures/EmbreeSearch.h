// What a ray looks for on its way through the hierarchies, and the exact test of what they propose.
#pragma once

#include "Rendering/Core/Structures/ExactLanes.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Structures/TraversalRay.h"

#include <cmath>
#include <cstdint>

namespace hrt
{
namespace embree
{

// A part as its hierarchy sees it; renewed with every update.
struct Member
{
  glm::dmat4 toScene{ 1.0 }; // from the geometry's positions
  TriangleId firstTriangle = 0;
  bool visibleToRays = false; // neither: also when the part has left the hierarchy
  bool castsShadow = false;
};

// True when the hit becomes the best. The order of traversal must not show: of equal hits the largest
// number wins, which is drawn last.
inline bool offer(const Hit& hit, Hit& best)
{
  if (hit.t > best.t || (hit.t == best.t && hit.triangle <= best.triangle))
  {
    return false;
  }
  best = hit;
  return true;
}

// What one ray looks for, shared by all levels of its traversal.
struct Search
{
  const Ray* ray = nullptr;
  ExactShear shear; // made when the first triangle needs it
  Hit best;
  bool found = false; // for occlusion: some hit

  Search() = default;
  explicit Search(const Ray& r)
    : ray(&r)
  {
  }
  double end() const { return this->best.valid() ? this->best.t : this->ray->tMaximum; }
};

} // namespace embree
} // namespace hrt
