// A kd-tree placed in the scene: whose triangles it is, and how far they can lie from a ray that is brought
// into its coordinates (Placement.h).
#pragma once

#include "Rendering/Core/Structures/ExactSearch.h"
#include "Rendering/Core/Structures/KdTree.h"
#include "Rendering/Core/Structures/KdTreeParts.h"
#include "Rendering/Core/Structures/Placement.h"

#include <cstddef>
#include <memory>

namespace hrt
{
namespace kdtree
{

// A geometry's tree. The geometry is kept alive with it, as Structure promises.
struct TriangleTree
{
  std::shared_ptr<const Geometry> geometry;
  std::unique_ptr<const KdTree> tree;
};

// A placed tree.
struct Instance
{
  const TriangleTree* triangles = nullptr;
  PlacedTriangles placed;
  glm::dmat3 inverse{ 1.0 };
  Placement placement;
  PartBox box;
  bool visibleToRays = true;
  bool castsShadow = true;

  // How far, in the tree's coordinates, rounding and clipping can part triangles from a ray whose origin
  // lies within `originReach` of the scene's.
  double slack(double originReach) const
  {
    return triangles->tree->padding() + placement.slack(originReach);
  }

  bool operator==(const Instance& o) const
  {
    return triangles == o.triangles && placed.toScene == o.placed.toScene &&
      placed.firstTriangle == o.placed.firstTriangle && visibleToRays == o.visibleToRays &&
      castsShadow == o.castsShadow;
  }
};

// Of the part's copy of that number. `triangles` must outlive it.
Instance makeInstance(const Part& part, const TriangleTree& triangles,
  const glm::dvec3& sceneOrigin, std::size_t copy = 0);

} // namespace kdtree
} // namespace hrt
