// What a ray looks for on its way through the hierarchies, and the exact test of what they propose.
#pragma once

#include "Rendering/Core/Structures/ExactLanes.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Structures/TraversalRay.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace hrt
{
namespace bvh
{

// A part as its hierarchy sees it; renewed with every update.
struct Member
{
  glm::dmat4 toScene{ 1.0 }; // from the geometry's positions
  TriangleId firstTriangle = 0;
  bool visibleToRays = false; // neither: also when the part has left the hierarchy
  bool castsShadow = false;
};

// What one ray looks for, shared by all levels of its traversal.
struct Search
{
  const Ray* ray = nullptr;
  const Coincidence* surfaces = nullptr;
  ExactShear shear; // made when the first triangle needs it, and the window too
  HitWindow window;
  Hit best;
  std::vector<Hit>* all = nullptr; // where every hit goes, when it is not the nearest that is wanted
  bool found = false; // for occlusion: some hit

  Search() = default;
  Search(const Ray& r, const Coincidence& s)
    : ray(&r)
    , surfaces(&s)
  {
  }
  // Up to here, inclusive, hits still count.
  double end() const
  {
    return this->best.valid() ? this->window.end(this->best.t) : this->ray->tMaximum;
  }
};

} // namespace bvh
} // namespace hrt
