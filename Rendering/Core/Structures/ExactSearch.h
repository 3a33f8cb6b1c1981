// What every structure does with the triangles that its hierarchy proposes: the exact test, the origin
// triangle and its twins left out, and of equal hits the largest number, so that the order of proposals
// does not show.
#pragma once

#include "Rendering/Core/Geometry/TriangleIntersection.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Structures/TraversalRay.h"

#include <cmath>
#include <optional>
#include <vector>

namespace hrt
{

// A geometry's triangles as they stand in the scene.
struct PlacedTriangles
{
  glm::dmat4 toScene{ 1.0 }; // from the geometry's positions
  TriangleId firstTriangle = 0;
};

class ExactSearch
{
public:
  // Both must outlive it. `all`: where every hit goes, when it is not the nearest that is looked for.
  ExactSearch(const Ray& ray, const Coincidence& surfaces, std::vector<Hit>* all = nullptr)
    : TheRay(ray)
    , Surfaces(surfaces)
    , All(all)
  {
  }

  const Ray& ray() const { return this->TheRay; }
  // False when the ray can hit nothing. Compared quietly: NaN must not trap.
  bool valid() const
  {
    return isUsable(this->TheRay.origin, this->TheRay.direction) &&
      this->TheRay.hasLength();
  }
  const Hit& best() const { return this->Best; }
  // Up to here, inclusive, hits still count.
  double end() const
  {
    return this->Best.valid() ? this->Window.end(this->Best.t) : this->TheRay.tMaximum;
  }

  // Whether the ray leaves from the triangle, which it then does not hit.
  bool isOrigin(const PlacedTriangles& placed, std::uint32_t triangle) const
  {
    return placed.firstTriangle + triangle == this->TheRay.originTriangle;
  }

  // True when the ray hits the geometry's triangle, which is then the best hit if it is, or one of all.
  // `positions`: the triangle's, three.
  bool test(
    const PlacedTriangles& placed, std::uint32_t triangle, const glm::vec3 (&positions)[3])
  {
    if (this->isOrigin(placed, triangle))
    {
      return false;
    }
    if (!this->Exact)
    {
      this->Exact.emplace(this->TheRay.origin, this->TheRay.direction);
      this->Window = this->Surfaces.windowOf(this->TheRay.direction);
    }
    TriangleHit hit;
    if (!this->Exact->hitsTriangle(
          sceneCorners(positions, placed.toScene), this->TheRay.tMaximum, hit))
    {
      return false;
    }
    const TriangleId id = placed.firstTriangle + triangle;
    if (this->TheRay.passesOver(id, hit.t, this->Surfaces))
    {
      return false;
    }
    if (this->All)
    {
      this->All->emplace_back(id, hit.t, hit.u, hit.v);
    }
    else
    {
      this->Best.offer(id, hit.t, hit.u, hit.v, this->Window);
    }
    return true;
  }

private:
  const Ray& TheRay;
  const Coincidence& Surfaces;
  std::vector<Hit>* All;
  std::optional<ShearedRay> Exact; // made when the first triangle needs it, and the window too
  HitWindow Window;
  Hit Best;
};

} // namespace hrt
