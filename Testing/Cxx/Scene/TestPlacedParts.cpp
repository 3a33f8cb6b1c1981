// Whether a matrix can be used, and the numbering of triangles up to its limit, which no real mesh
// could test.
#include "Rendering/Scene/PlacedParts.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <limits>

using namespace hrt::scene;

namespace
{

glm::dmat4 rotation()
{
  return glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
}

TEST(PlacedParts, AcceptsEveryInvertibleAffineMatrix)
{
  const glm::dmat4 unit(1.0);
  for (const glm::dvec3& scale : { glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1),
         glm::dvec3(1e-9, 1, 1e9), glm::dvec3(1e-90), glm::dvec3(1e90) })
  {
    glm::dmat4 m =
      glm::translate(unit, glm::dvec3(5e5, -3, 0)) * rotation() * glm::scale(unit, scale);
    const glm::dmat4 before = m;
    EXPECT_EQ(normaliseMatrix(m), MatrixState::Good) << scale.x;
    EXPECT_EQ(m, before);
  }
}

TEST(PlacedParts, RefusesFlatMatricesAlsoWhenRotated)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec3 scale(1.0);
    scale[axis] = 0.0;
    // The product's determinant is a rounding error, not zero.
    glm::dmat4 m = rotation() * glm::scale(glm::dmat4(1.0), scale) * rotation();
    EXPECT_EQ(normaliseMatrix(m), MatrixState::Singular) << axis;
  }
}

TEST(PlacedParts, AcceptsAThinButRealShape)
{
  glm::dmat4 m = rotation() * glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, 1e-9)) * rotation();
  EXPECT_EQ(normaliseMatrix(m), MatrixState::Good);
}

TEST(PlacedParts, RefusesWhatIsNotFinite)
{
  for (double bad :
    { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
  {
    for (int i = 0; i < 16; ++i)
    {
      glm::dmat4 m(1.0);
      m[i / 4][i % 4] = bad;
      EXPECT_EQ(normaliseMatrix(m), MatrixState::Singular) << i;
    }
  }
}

TEST(PlacedParts, DividesByWAndLeavesProjectionsAlone)
{
  glm::dmat4 m = 2.0 * glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3));
  EXPECT_EQ(normaliseMatrix(m), MatrixState::Good);
  EXPECT_EQ(m, glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3)));
  glm::dmat4 projective(1.0);
  projective[0][3] = 0.1;
  EXPECT_EQ(normaliseMatrix(projective), MatrixState::Projective);
  glm::dmat4 vanishing(1.0);
  vanishing[3][3] = 0.0;
  EXPECT_EQ(normaliseMatrix(vanishing), MatrixState::Singular);
}

TEST(PlacedParts, NumbersTrianglesUpToTheLimit)
{
  TriangleNumbers numbers(10);
  EXPECT_TRUE(numbers.take(7));
  EXPECT_FALSE(numbers.take(4));
  EXPECT_TRUE(numbers.take(3)) << "a refusal takes nothing";
  EXPECT_FALSE(numbers.take(1));
  EXPECT_FALSE(numbers.take(std::numeric_limits<std::uint64_t>::max()));
}

TEST(PlacedParts, TheLimitLeavesRoomForNoTriangle)
{
  TriangleNumbers numbers;
  EXPECT_TRUE(numbers.take(hrt::kMaximumTriangles));
  EXPECT_FALSE(numbers.take(1));
}

} // anonymous namespace
