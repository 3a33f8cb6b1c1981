// Derives what rounding can do to a placed tree.
#include "Rendering/Core/Structures/KdTreeInstance.h"

namespace hrt
{
namespace kdtree
{

namespace
{

// The largest sum of a row's absolute values: how much the matrix can stretch `largest`.
double stretch(const glm::dmat3& m)
{
  return largest(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

// With A the matrix, T its translation, X the computed inverse, R the tree's reach, o the ray's origin,
// S = |A| R + |T|, D = |o| + S and u half an ulp, the distances that matter, in the tree's coordinates:
//   corners in the scene, A p + T                                |X| 4 u S
//   the exact kernel's differences and shear                     |X| 8 u D
//   the origin here, X (o - T), and the direction over a way D   |X| (4 u + 3 u + 2 d) D
//   where the tree's box is entered, and parameters from there   |X| 6 u D
// where d bounds the relative error of X. From X A = I - E follows |A^-1 - X| <= |E| |A^-1|; E is computed
// with an error of 4 u |X| |A|, and while |E| <= 1/2, |A^-1| <= 2 |X|. Together below
// |X| (32 u + 4 (|E| + 4 u |X| |A|)) D. A matrix that is worse gets infinite slack: then every triangle is
// asked.
double slackPerUnit(const glm::dmat3& matrix, const glm::dmat3& inverse)
{
  const double residual = stretch(glm::dmat3(1.0) - inverse * matrix) +
    4.0 * kRounding * stretch(inverse) * stretch(matrix);
  return residual <= 0.5 ? stretch(inverse) * (32.0 * kRounding + 4.0 * residual)
                         : std::numeric_limits<double>::infinity();
}

} // namespace

Instance makeInstance(
  const Part& part, std::shared_ptr<const TriangleTree> triangles, const glm::dvec3& sceneOrigin)
{
  Instance instance;
  instance.placed = { positionsToScene(part, sceneOrigin), part.firstTriangle };
  instance.triangles = std::move(triangles);
  instance.visibleToRays = part.visibleToRays;
  instance.castsShadow = part.castsShadow;
  const glm::dmat4& toScene = instance.placed.toScene;
  const glm::dmat3 matrix(toScene);
  instance.inverse = glm::inverse(matrix);
  instance.slackPerUnit = slackPerUnit(matrix, instance.inverse);
  const KdTree& tree = *instance.triangles->tree;
  instance.sceneReach = stretch(matrix) * tree.reach() + largest(glm::dvec3(toScene[3]));
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
