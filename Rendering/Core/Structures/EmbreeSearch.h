// What rays carry through Embree's hierarchies and back into our callbacks: the true ray and its
// best hit (one a ray), and the stand-in that Embree traverses (one a ray and hierarchy).
#pragma once

#include "Rendering/Core/Geometry/TriangleTest.h"
#include "Rendering/Core/Structures/EmbreeShim.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Structures/TraversalRay.h"
#include "Rendering/Core/Structures/TriangleBlock.h"

#include <cstdint>
#include <limits>
#include <optional>

namespace hrt
{
namespace embree
{

// A part as the callbacks see it; renewed with every update.
struct Member
{
  glm::dmat4 toScene{ 1.0 }; // from the geometry's positions
  TriangleId firstTriangle = 0;
  bool visibleToRays = false; // neither: also when the part has left the hierarchy
  bool castsShadow = false;
};

// Which triangle a lane of a block holds: number in the hierarchy's members, number in the
// geometry.
struct Source
{
  std::uint32_t member = 0;
  std::uint32_t triangle = 0;
};
inline constexpr std::uint32_t kNoMember = 0xffffffffu; // an unused lane

// What one ray looks for, shared by all levels of its traversal.
struct Search
{
  const Ray& ray;
  std::optional<ShearedRay> exact; // made when the first triangle needs it
  Hit best;
  bool found = false; // for occlusion: some hit

  explicit Search(const Ray& r)
    : ray(r)
  {
  }
  double end() const { return this->best.valid() ? this->best.t : this->ray.tMaximum; }
};

// A search's passage through one hierarchy.
struct Passage
{
  Search* search;
  TraversalRay traversal;

  // The parameter where the search now ends, rounded outward.
  float end() const { return this->traversal.end(this->search->end()); }
};

// The passages of one call to Embree. Embree hands the context back to the callbacks, which know
// that it belongs to a query; it may split a packet, so that a ray tells its passage by its id.
struct Query : QueryContext
{
  Passage* passages = nullptr;
  const Member* members = nullptr; // on the lower level

  explicit Query(Passage* p)
    : passages(p)
  {
    initialize(*this);
  }
};

template <class Arguments>
Query& queryOf(const Arguments* arguments)
{
  return *static_cast<Query*>(arguments->context);
}

inline RTCRayN* raysOf(const RTCIntersectFunctionNArguments* arguments)
{
  return RTCRayHitN_RayN(arguments->rayhit, arguments->N);
}

inline RTCRayN* raysOf(const RTCOccludedFunctionNArguments* arguments)
{
  return arguments->ray;
}

// The passage of a callback's i-th ray.
template <class Arguments>
Passage& passageOf(const Arguments* arguments, unsigned int i)
{
  return queryOf(arguments).passages[RTCRayN_id(raysOf(arguments), arguments->N, i)];
}

// A callback's i-th ray for the sieve.
HRT_ALWAYS_INLINE SieveRay sieveRay(RTCRayN* rays, unsigned int count, unsigned int i)
{
  return { { RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i),
             RTCRayN_org_z(rays, count, i) },
    { RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i), RTCRayN_dir_z(rays, count, i) },
    RTCRayN_tfar(rays, count, i) };
}

// Tells Embree that the search of a callback's i-th ray now ends earlier.
inline void shorten(const RTCIntersectFunctionNArguments* arguments, unsigned int i, float end)
{
  RTCRayN_tfar(raysOf(arguments), arguments->N, i) = end;
  RTCHitN_geomID(RTCRayHitN_HitN(arguments->rayhit, arguments->N), arguments->N, i) =
    arguments->geomID;
}

// Tells Embree that nothing more is wanted for it.
inline void finish(const RTCOccludedFunctionNArguments* arguments, unsigned int i)
{
  RTCRayN_tfar(arguments->ray, arguments->N, i) = -std::numeric_limits<float>::infinity();
}

// A box for Embree, grown.
inline void setBounds(RTCBounds& bounds, const TraversalBox& box, double padding)
{
  bounds.lower_x = static_cast<float>(box.lower.x - padding);
  bounds.lower_y = static_cast<float>(box.lower.y - padding);
  bounds.lower_z = static_cast<float>(box.lower.z - padding);
  bounds.upper_x = static_cast<float>(box.upper.x + padding);
  bounds.upper_y = static_cast<float>(box.upper.y + padding);
  bounds.upper_z = static_cast<float>(box.upper.z + padding);
}

} // namespace embree
} // namespace hrt
