// Fresnel's equations at the angles where their values are known in closed form.
#include "Rendering/Core/Tracing/Fresnel.h"

#include <gtest/gtest.h>

namespace
{

using namespace hrt;

// About ten roundings of numbers up to 2.
constexpr double kTolerance = 4e-15;

TEST(Fresnel, NormalIncidence)
{
  EXPECT_NEAR(fresnelReflectance(1.0, 1.0 / 1.5), 0.04, kTolerance); // ((n - 1) / (n + 1))^2
  EXPECT_NEAR(fresnelReflectance(1.0, 1.5), 0.04, kTolerance);
  EXPECT_NEAR(fresnelReflectance(1.0, 1.0 / 2.4), std::pow(1.4 / 3.4, 2), kTolerance);
}

TEST(Fresnel, BrewsterAngle)
{
  // tan = n: the parallel share vanishes, the other is ((n^2 - 1) / (n^2 + 1))^2.
  const double n = 1.5, cosine = 1.0 / std::sqrt(1.0 + n * n);
  const double across = (n * n - 1) / (n * n + 1);
  EXPECT_NEAR(fresnelReflectance(cosine, 1.0 / n), 0.5 * across * across, kTolerance);
}

TEST(Fresnel, LimitsAndTotalReflection)
{
  EXPECT_NEAR(fresnelReflectance(0.0, 1.0 / 1.5), 1.0, kTolerance); // grazing
  EXPECT_EQ(fresnelReflectance(0.6, 1.0), 0.0);                     // no boundary at all
  const double critical = std::sqrt(1.0 - 1.0 / (1.5 * 1.5));
  EXPECT_EQ(fresnelReflectance(critical - 1e-9, 1.5), 1.0);
  EXPECT_LT(fresnelReflectance(critical + 1e-9, 1.5), 1.0);
}

TEST(Fresnel, SameFromBothSides)
{
  for (double cosine : { 0.1, 0.5, 0.9 })
  {
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (1.5 * 1.5));
    EXPECT_NEAR(
      fresnelReflectance(cosine, 1.0 / 1.5), fresnelReflectance(inside, 1.5), kTolerance);
  }
}

TEST(Fresnel, DirectionsObeyTheLaws)
{
  const glm::dvec3 normal(0, 0, 1);
  for (double sine : { 0.0, 0.3, 0.6 })
  {
    const glm::dvec3 in(sine, 0, -std::sqrt(1 - sine * sine));
    EXPECT_EQ(reflected(in, normal), glm::dvec3(in.x, in.y, -in.z));
    glm::dvec3 out;
    ASSERT_TRUE(refracted(in, normal, 1.0 / 1.5, out));
    EXPECT_NEAR(glm::length(out), 1.0, kTolerance);
    EXPECT_NEAR(out.x, sine / 1.5, kTolerance); // Snell
    EXPECT_LT(out.z, 0.0);
  }
  glm::dvec3 out;
  EXPECT_FALSE(refracted({ 0.8, 0, -0.6 }, normal, 1.5, out)); // 0.8 * 1.5 > 1
}

} // namespace
