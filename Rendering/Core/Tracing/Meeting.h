// What a ray meets where several surfaces lie in one place (Geometry/Coincidence.h): the members of the
// set, and the order in which a ray goes through them, as if the gaps between them were small but not
// zero.
#pragma once

#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Tracing/Surface.h"

#include <vector>

namespace hrt
{

class Meetings
{
public:
  // The first three must outlive it. `glassRefracts`: else it is a surface like others.
  Meetings(const Snapshot& snapshot, const Surfaces& surfaces, const Structure& structure,
    bool glassRefracts)
    : Scene(snapshot)
    , Points(surfaces)
    , Rays(structure)
    , GlassRefracts(glassRefracts)
  {
  }

  // The nearest hit of the ray, which is shared, and all that lie in one place with it, in no order.
  void gather(const Ray& ray, const Hit& nearest, std::vector<Hit>& members) const;

  // All that lie in one place with a hit that the rasteriser has named, itself among them.
  void gatherAround(const Ray& ray, const Hit& hit, std::vector<Hit>& members) const;

  // Puts them into the order in which the ray goes through them:
  //   - `first`, where it is a member.
  //   - glass that it leaves, for it can only be within: of the part that it comes from first, which it
  //     entered last. So does what stands on the glass' outside, or is painted on it, lie behind.
  //   - what is translucent, which VTK draws over all that is opaque.
  //   - the others.
  // Of equals what is drawn last lies over the other. Those of one part that face the same way are one
  // surface, met on an edge between them: the first stands for all. `from`: the triangle that the
  // ray has left.
  void order(const glm::dvec3& direction, TriangleId from, std::vector<Hit>& members,
    TriangleId first = kNoTriangle) const;

private:
  void keepThoseAt(const Hit& hit, std::vector<Hit>& members) const;

  const Snapshot& Scene;
  const Surfaces& Points;
  const Structure& Rays;
  bool GlassRefracts;
};

} // namespace hrt
