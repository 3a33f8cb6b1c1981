// See PlacedParts.h.

#include "Rendering/Scene/PlacedParts.h"

#include <cmath>

namespace hrt
{
namespace scene
{
namespace
{

// The volume of the box that the matrix' columns span, relative to the product of their lengths, is
// 1 for any scaled rotation, however unequal the scales. Composing a matrix from a few others and
// taking its determinant costs some ten roundings of 2^-53 each; a flattened matrix comes out below
// 2^-49 and nothing that has a visible thickness comes near.
const double kFlatRatio = std::ldexp(1.0, -47);

//------------------------------------------------------------------------------
bool isFinite(const glm::dmat4& matrix)
{
  for (int column = 0; column < 4; ++column)
  {
    for (int row = 0; row < 4; ++row)
    {
      if (!std::isfinite(matrix[column][row]))
      {
        return false;
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
bool isFlat(const glm::dmat4& matrix)
{
  glm::dmat3 directions(matrix);
  for (int column = 0; column < 3; ++column)
  {
    // Scaled before the length is taken, which squares and could overflow.
    const glm::dvec3 magnitude = glm::abs(directions[column]);
    const double largest = glm::max(magnitude.x, glm::max(magnitude.y, magnitude.z));
    if (largest == 0.0)
    {
      return true;
    }
    directions[column] = glm::normalize(directions[column] / largest);
  }
  return std::abs(glm::determinant(directions)) < kFlatRatio;
}

} // anonymous namespace

//------------------------------------------------------------------------------
MatrixState normaliseMatrix(glm::dmat4& localToWorld)
{
  if (!isFinite(localToWorld))
  {
    return MatrixState::Singular;
  }
  if (localToWorld[0][3] != 0.0 || localToWorld[1][3] != 0.0 || localToWorld[2][3] != 0.0)
  {
    return MatrixState::Projective;
  }
  const double w = localToWorld[3][3];
  if (w == 0.0)
  {
    return MatrixState::Singular;
  }
  if (w != 1.0)
  {
    localToWorld /= w;
  }
  // Scales near the ends of the number range have an inverse, but none that a double can hold.
  return isFinite(localToWorld) && !isFlat(localToWorld) && isFinite(glm::inverse(localToWorld))
    ? MatrixState::Good
    : MatrixState::Singular;
}

} // namespace scene
} // namespace hrt
