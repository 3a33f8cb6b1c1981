// The interface of a ray acceleration structure. Rays and hits are in double precision and in world
// coordinates relative to Snapshot::origin; whatever an implementation does inside, a hit's
// (t, u, v) is that of the double-precision test of Geometry/TriangleIntersection.h.
#pragma once

#include "Rendering/Core/Geometry/Coincidence.h"
#include "Rendering/Core/Snapshot.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace hrt
{

struct Ray
{
  glm::dvec3 origin{ 0.0 };     // relative to Snapshot::origin
  glm::dvec3 direction{ 0, 0, -1 }; // need not be normalised; t counts in its length
  double tMaximum = std::numeric_limits<double>::infinity();
  // The triangle the ray leaves from: never reported as hit. Replaces a scene epsilon.
  TriangleId originTriangle = kNoTriangle;
  // Hits up to here on twins of that triangle, Coincidence::passesOver, are passed over too. Zero:
  // none are.
  float twinEnd = 0.0f;

  // Whether the ray passes over a triangle that it hits at t. `surfaces`: of the scene that it is in.
  bool passesOver(TriangleId triangle, double t, const Coincidence& surfaces) const
  {
    return t <= static_cast<double>(this->twinEnd) &&
      surfaces.passesOver(this->originTriangle, triangle, this->origin, this->direction);
  }

  // False when tMaximum is not a number or leaves no room for a hit. A quiet comparison: it raises no
  // floating-point exception in hosts that trap them.
  bool hasLength() const { return std::isgreater(this->tMaximum, 0.0); }
};

struct Hit
{
  TriangleId triangle = kNoTriangle;
  // Another hit is so near behind that the two may be in one place: within Coincidence::windowOf.
  bool shared = false;
  double t = std::numeric_limits<double>::infinity();
  double u = 0.0, v = 0.0; // of the second and third corner

  Hit() = default;
  Hit(TriangleId id, double parameter, double ofSecond, double ofThird)
    : triangle(id)
    , t(parameter)
    , u(ofSecond)
    , v(ofThird)
  {
  }
  bool valid() const { return triangle != kNoTriangle; }

  // The order of hits on one ray. Of equal ones that of the larger number, which is drawn last, is first.
  bool before(const Hit& other) const
  {
    return this->t < other.t || (this->t == other.t && this->triangle > other.triangle);
  }

  // Becomes the other one where that is nearer, and is true then. In whatever order the hits of a
  // ray are offered, if only all are that lie within the ray's window behind the nearest.
  template <class Window> // HitWindow, or what knows another way to `holds`
  bool offer(TriangleId id, double parameter, double ofSecond, double ofThird, const Window& window)
  {
    if (parameter < this->t || (parameter == this->t && id > this->triangle))
    {
      this->shared = window.holds(parameter, this->t); // never none, at infinity
      this->triangle = id;
      this->t = parameter;
      this->u = ofSecond;
      this->v = ofThird;
      return true;
    }
    if (window.holds(this->t, parameter) && id != this->triangle)
    {
      this->shared = true;
    }
    return false;
  }
};

// What the last update cost and did, for the statistics.
struct StructureReport
{
  std::uint64_t built = 0;  // geometries built anew
  std::uint64_t refitted = 0;
  std::uint64_t reused = 0; // geometries taken over from the last update
  bool partsRebuilt = false;// the placement of the parts was new
  double milliseconds = 0.0;
};

// How the rays of a stream lie to each other: what an implementation may gain from, never what it
// answers.
enum class RayOrder : std::uint8_t
{
  Coherent,  // neighbours start or end close together: primary, shadow, first mirror rays
  Incoherent
};

class Structure
{
public:
  virtual ~Structure() = default;

  // Brings the structure up to date with a snapshot; builds only what is new. Only parts that are
  // visible to rays or cast shadows take part. The snapshot's geometries are kept alive by it.
  virtual StructureReport update(const Snapshot& snapshot) = 0;

  // The nearest hit with 0 < t < tMaximum among the parts visible to rays, of equal ones that of the
  // largest number. Rays with a non-finite or zero direction, a non-finite origin or a tMaximum that
  // is not a number are misses. Safe to call from several threads at once.
  virtual Hit intersect(const Ray& ray) const = 0;

  // All hits with 0 < t < tMaximum among the parts visible to rays: the nearest first, of equal ones
  // that of the largest number. Same rules.
  virtual void intersectAll(const Ray& ray, std::vector<Hit>& hits) const = 0;

  // True when a part that casts shadows lies at 0 < t < tMaximum. Same rules.
  virtual bool occluded(const Ray& ray) const = 0;

  // The same for a stream of rays: for every ray the very result of the single call.
  virtual void intersect(const Ray* rays, Hit* hits, std::size_t count, RayOrder order) const;
  virtual void occluded(
    const Ray* rays, std::uint8_t* occluded, std::size_t count, RayOrder order) const;
};

} // namespace hrt
