// Places a kd-tree.
#include "Rendering/Core/Structures/KdTreeInstance.h"

namespace hrt
{
namespace kdtree
{

Instance makeInstance(const Part& part, const TriangleTree& triangles,
  const glm::dvec3& sceneOrigin, std::size_t copy)
{
  Instance instance;
  instance.placed = { positionsToScene(part, sceneOrigin, copy),
    part.firstTriangle + static_cast<TriangleId>(copy * part.geometry->triangleCount()) };
  instance.triangles = &triangles;
  instance.visibleToRays = part.visibleToRays;
  instance.castsShadow = part.castsShadow;
  const glm::dmat4& toScene = instance.placed.toScene;
  instance.inverse = glm::inverse(glm::dmat3(toScene));
  const KdTree& tree = *instance.triangles->tree;
  instance.placement = Placement(toScene, instance.inverse, tree.reach());
  const glm::dvec3 lower(tree.box().lower), upper(tree.box().upper);
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 point((corner & 1) ? upper.x : lower.x, (corner & 2) ? upper.y : lower.y,
      (corner & 4) ? upper.z : lower.z, 1.0);
    instance.box.include(glm::dvec3(toScene * point));
  }
  return instance;
}

} // namespace kdtree
} // namespace hrt
