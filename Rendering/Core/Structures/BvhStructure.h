// The default ray structure: Embree's hierarchies over the exact kernel.
//
// Embree's own triangles are tested in single precision and, aimed at vertices of a closed mesh, up
// to two rays in a hundred slip through even in its robust mode; a filter could reject its wrong
// hits but never bring back its misses. Embree therefore builds the hierarchies, and the rest is
// done here: trees of eight boxes a node, grown by a derived bound (WideTree.h, TraversalRay.h), over
// blocks of up to eight neighbouring triangles; a sieve in single precision drops what surely is not
// hit (TriangleBlock.h); and every triangle that is left is decided by the kernel of
// Geometry/TriangleIntersection.h in double. The result is, bit by bit, that of a loop over all triangles,
// for any instruction set, packet and grouping.
//
// Which parts share a hierarchy is the policy of Grouping.h. A moved part costs the hierarchy over
// the parts' boxes only; a mesh that deforms is refitted.
#pragma once

#include "Rendering/Core/Structures/Structure.h"

#include <memory>
#include <string>

namespace hrt
{

class BvhStructure final : public Structure
{
public:
  // `configuration` goes to rtcNewDevice, e.g. "isa=sse2"; empty: Embree's choice. Every error that
  // Embree reports, here or in update, is thrown as std::runtime_error with Embree's own words.
  // After an error in update the structure is empty until the next one.
  //
  // Embree recommends flush-to-zero; it is not set here, and must not be set by a host's threads:
  // the exact kernel needs gradual underflow, and the mode would leak into all code of the thread.
  explicit BvhStructure(const std::string& configuration = {});
  ~BvhStructure() override;

  BvhStructure(const BvhStructure&) = delete;
  BvhStructure& operator=(const BvhStructure&) = delete;

  StructureReport update(const Snapshot& snapshot) override;
  Hit intersect(const Ray& ray) const override;
  void intersectAll(const Ray& ray, std::vector<Hit>& hits) const override;
  bool occluded(const Ray& ray) const override;
  // Coherent rays are traversed in packets of 16.
  void intersect(const Ray* rays, Hit* hits, std::size_t count, RayOrder order) const override;
  void occluded(
    const Ray* rays, std::uint8_t* occluded, std::size_t count, RayOrder order) const override;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl;
};

} // namespace hrt
