// Derives what rounding can do to a placed structure.
#include "Rendering/Core/Structures/Placement.h"

#include <limits>

namespace hrt
{

namespace
{

// The largest sum of a row's absolute values: how much the matrix can stretch `largest`.
double stretch(const glm::dmat3& m)
{
  return largest(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

// With A the matrix, T its translation, X the computed inverse, R the structure's reach, o the ray's
// origin, S = |A| R + |T|, D = |o| + S and u half an ulp, the distances that matter, in the structure's
// coordinates:
//   corners in the scene, A p + T                                |X| 4 u S
//   the exact kernel's differences and shear                     |X| 8 u D
//   the origin here, X (o - T), and the direction over a way D   |X| (5 u + 3 u + 2 d) D
//   where the outer box is entered, and parameters from there    |X| 6 u D
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

Placement::Placement(const glm::dmat4& toScene, const glm::dmat3& inverse, double reach)
  : perUnit(slackPerUnit(glm::dmat3(toScene), inverse))
  , sceneReach(stretch(glm::dmat3(toScene)) * reach + largest(glm::dvec3(toScene[3])))
{
}

} // namespace hrt
