// A kd-tree placed in the scene: whose triangles it is, and how far rounding can move a ray on the way from
// the scene's coordinates into the tree's.
#pragma once

#include "Rendering/Core/Structures/ExactSearch.h"
#include "Rendering/Core/Structures/KdTree.h"
#include "Rendering/Core/Structures/KdTreeParts.h"

#include <memory>

namespace hrt
{
namespace kdtree
{

// Half an ulp of 1.
inline constexpr double kRounding = 0x1p-53;

inline double largest(const glm::dvec3& v)
{
  const glm::dvec3 a = glm::abs(v);
  return std::max({ a.x, a.y, a.z });
}

// A geometry's tree. The geometry is kept alive with it, as Structure promises.
struct TriangleTree
{
  std::shared_ptr<const Geometry> geometry;
  std::unique_ptr<const KdTree> tree;
};

// A placed tree.
struct Instance
{
  std::shared_ptr<const TriangleTree> triangles;
  PlacedTriangles placed;
  glm::dmat3 inverse{ 1.0 };
  // Of `slack`, for each unit of `sceneReach` and of the ray's origin.
  double slackPerUnit = 0.0;
  double sceneReach = 0.0;
  PartBox box;
  bool visibleToRays = true;
  bool castsShadow = true;

  // How far, in the tree's coordinates, rounding and clipping can part triangles from a ray whose origin
  // lies within `originReach` of the scene's.
  double slack(double originReach) const
  {
    return triangles->tree->padding() + slackPerUnit * (originReach + sceneReach);
  }

  bool operator==(const Instance& o) const
  {
    return triangles == o.triangles && placed.toScene == o.placed.toScene &&
      placed.firstTriangle == o.placed.firstTriangle && visibleToRays == o.visibleToRays &&
      castsShadow == o.castsShadow;
  }
};

Instance makeInstance(
  const Part& part, std::shared_ptr<const TriangleTree> triangles, const glm::dvec3& sceneOrigin);

} // namespace kdtree
} // namespace hrt
