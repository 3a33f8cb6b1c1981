// What every structure does with the triangles that its hierarchy proposes: the exact test, the origin
// triangle left out, and of equal hits the smallest number, so that the order of proposals does not show.
#pragma once

#include "Rendering/Core/Geometry/TriangleTest.h"
#include "Rendering/Core/Structures/Structure.h"

namespace hrt
{

// A geometry as it stands in the scene.
struct PlacedGeometry
{
  const Geometry* geometry = nullptr;
  glm::dmat4 toScene{ 1.0 }; // from the geometry's positions
  TriangleId firstTriangle = 0;
};

class ExactSearch
{
public:
  explicit ExactSearch(const Ray& ray)
    : TheRay(ray)
    , Exact(ray.origin, ray.direction)
  {
  }

  const Ray& ray() const { return this->TheRay; }
  bool valid() const { return this->Exact.valid(); }
  const Hit& best() const { return this->Best; }
  // Up to here, inclusive, a hit could still be better.
  double end() const { return this->Best.valid() ? this->Best.t : this->TheRay.tMaximum; }

  // True when the ray hits the geometry's triangle, which is then the best hit if it is.
  bool test(const PlacedGeometry& placed, std::size_t triangle)
  {
    const TriangleId id = placed.firstTriangle + static_cast<TriangleId>(triangle);
    TriangleHit hit;
    if (id == this->TheRay.originTriangle ||
      !this->Exact.hitsTriangle(sceneCorners(*placed.geometry, placed.toScene, triangle),
        this->TheRay.tMaximum, hit))
    {
      return false;
    }
    if (hit.t < this->Best.t || (hit.t == this->Best.t && id < this->Best.triangle))
    {
      this->Best = { id, hit.t, hit.u, hit.v };
    }
    return true;
  }

private:
  const Ray& TheRay;
  ShearedRay Exact;
  Hit Best;
};

} // namespace hrt
