// The judge judged: identities that hold only without rounding, cases where plain doubles are known
// to be wrong, and the extremes of the number range.
#include "Testing/Cxx/Reference/ExactPredicates.h"

#include "Testing/Cxx/Core/Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace hrt;
using namespace hrt::reference;

namespace
{

// Any finite double at all, subnormal numbers included.
double anyFinite(scenes::Random& random)
{
  const double size = std::ldexp(random(0.5, 1.0), static_cast<int>(random(-1073.0, 1024.0)));
  return random(-1.0, 1.0) < 0.0 ? -size : size;
}

bool equal(const ExactNumber& a, const ExactNumber& b)
{
  return compare(a, b) == 0;
}

} // namespace

TEST(ExactNumber, KeepsEveryDouble)
{
  scenes::Random random(1);
  for (int i = 0; i < 10000; ++i)
  {
    const double x = anyFinite(random);
    ASSERT_EQ(ExactNumber(x).approximate(), x);
  }
  for (double x : { 0.0, 1.0, -1.0, 0x1p-1074, -0x1p-1074, 0x1.fffffffffffffp1023 })
  {
    EXPECT_EQ(ExactNumber(x).approximate(), x);
    EXPECT_EQ(ExactNumber(x).sign(), (x > 0) - (x < 0));
  }
}

TEST(ExactNumber, RefusesWhatIsNoNumber)
{
  EXPECT_THROW(ExactNumber(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(ExactNumber(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(ExactNumber, ObeysTheLawsThatRoundingBreaks)
{
  scenes::Random random(2);
  int brokenByDoubles = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const double a = anyFinite(random), b = anyFinite(random), c = anyFinite(random);
    const ExactNumber x(a), y(b), z(c);
    ASSERT_TRUE(equal((x + y) + z, x + (y + z)));
    ASSERT_TRUE(equal((x * y) * z, x * (y * z)));
    ASSERT_TRUE(equal(x * (y + z), x * y + x * z));
    ASSERT_TRUE(equal((x - y) * (x + y), x * x - y * y));
    ASSERT_TRUE(equal((x + y) - y, x));
    ASSERT_EQ(compare(x, y), (a > b) - (a < b));
    brokenByDoubles += (a + b) - b != a ? 1 : 0;
  }
  EXPECT_GT(brokenByDoubles, 500) << "the numbers are too tame to show anything";
}

// Products and sums of small whole numbers, where doubles are exact themselves.
TEST(ExactNumber, AgreesWithDoublesWhereTheyAreExact)
{
  scenes::Random random(3);
  for (int i = 0; i < 10000; ++i)
  {
    const double a = std::floor(random(-9e7, 9e7)), b = std::floor(random(-9e7, 9e7));
    ASSERT_EQ((ExactNumber(a) * ExactNumber(b)).approximate(), a * b);
    ASSERT_EQ((ExactNumber(a) - ExactNumber(b)).approximate(), a - b);
    // Limbs that are full of ones carry all the way.
    const ExactNumber ones(0x1p64 - 0x1p11);
    ASSERT_TRUE(equal(ones * ones,
      ExactNumber(0x1p128) - ExactNumber(0x1p76) + ExactNumber(0x1p22)));
  }
}

TEST(Orientation, HasTheSignItsHeaderPromises)
{
  const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(orientation(a, b, c, { 0, 0, -1 }), 1);
  EXPECT_EQ(orientation(a, b, c, { 0, 0, 1 }), -1);
  EXPECT_EQ(orientation(a, b, c, { 5, -7, 0 }), 0);
}

// Points on a plane by construction, then off it by the least that a double can be: the volume in
// doubles is noise there.
TEST(Orientation, SeesTheLastBit)
{
  scenes::Random random(4);
  int wrongInDoubles = 0;
  for (int i = 0; i < 2000; ++i)
  {
    // Twelve-bit fractions: every sum below is exact.
    const auto coarse = [&] { return std::floor(random(-4096, 4096)) / 4096.0; };
    const glm::dvec3 a(coarse(), coarse(), coarse()), b(coarse(), coarse(), coarse()),
      c(coarse(), coarse(), coarse());
    glm::dvec3 d = a + (b - a) * 3.0 - (c - a) * 5.0;
    if (d.z == 0.0)
    {
      continue;
    }
    ASSERT_EQ(orientation(a, b, c, d), 0);
    const double nz = glm::cross(b - a, c - a).z;
    const int expected = (nz < 0) - (nz > 0);
    d.z = std::nextafter(d.z, 1e300);
    ASSERT_EQ(orientation(a, b, c, d), expected);
    ASSERT_EQ(orientation(b, a, c, d), -expected);
    const double plain = glm::dot(a - d, glm::cross(b - d, c - d));
    wrongInDoubles += ((plain > 0) - (plain < 0)) != expected ? 1 : 0;
  }
  EXPECT_GT(wrongInDoubles, 100) << "the points are too easy to show anything";
}

TEST(Orientation, HoldsAtTheEndsOfTheRange)
{
  const double tiny = 0x1p-1074, huge = 0x1p1000;
  EXPECT_EQ(orientation({ 0, 0, 0 }, { tiny, 0, 0 }, { 0, tiny, 0 }, { 0, 0, -tiny }), 1);
  EXPECT_EQ(orientation({ 0, 0, 0 }, { huge, 0, 0 }, { 0, huge, 0 }, { 0, 0, -huge }), 1);
  EXPECT_EQ(orientation({ 0, 0, 0 }, { huge, 0, 0 }, { 0, huge, 0 }, { 0, 0, -tiny }), 1);
}

TEST(Meeting, InsideBorderAndOutside)
{
  const glm::dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0), down(0, 0, -2);
  const auto from = [&](double x, double y) { return meet({ x, y, 3 }, down, a, b, c); };
  EXPECT_TRUE(from(1, 1).inside());
  EXPECT_FALSE(from(1, 1).onBorder());
  for (const glm::dvec2 p : { glm::dvec2(2, 2), { 0, 0 }, { 4, 0 }, { 0, 4 }, { 1, 0 } })
  {
    EXPECT_TRUE(from(p.x, p.y).onBorder());
  }
  EXPECT_FALSE(from(2, std::nextafter(2.0, 3.0)).inside());
  EXPECT_TRUE(from(2, std::nextafter(2.0, 1.0)).inside());
  EXPECT_FALSE(from(2, std::nextafter(2.0, 1.0)).onBorder());
  EXPECT_TRUE(isWithin(1.5, from(1, 1).depth, from(1, 1).determinant, 0.0));
  EXPECT_FALSE(isWithin(std::nextafter(1.5, 2.0), from(1, 1).depth, from(1, 1).determinant, 0.0));
  EXPECT_TRUE(isWithin(0.25, from(1, 1).weightB, from(1, 1).determinant, 0.0));
  EXPECT_TRUE(hits(from(1, 1)));
  EXPECT_FALSE(hits(meet({ 1, 1, -3 }, down, a, b, c))) << "behind the origin";
  EXPECT_FALSE(hits(meet({ 1, 1, 0 }, down, a, b, c))) << "at the origin";
  EXPECT_FALSE(hits(meet({ 1, 1, 0 }, { 1, 0, 0 }, a, b, c))) << "within the plane";
}

TEST(Meeting, DepthsCompareExactly)
{
  const glm::dvec3 origin(0.1, 0.2, 5), direction(0.01, 0.02, -0.7);
  const auto plane = [&](double height, bool turned) {
    const glm::dvec3 a(-9, -9, height), b(9, -9, height), c(0, 9, height);
    return turned ? meet(origin, direction, a, c, b) : meet(origin, direction, a, b, c);
  };
  const double below = std::nextafter(1.0, 0.0);
  for (const bool first : { false, true })
  {
    for (const bool second : { false, true })
    {
      EXPECT_EQ(compareDepths(plane(1.0, first), plane(1.0, second)), 0);
      EXPECT_EQ(compareDepths(plane(1.0, first), plane(below, second)), -1);
      EXPECT_EQ(compareDepths(plane(below, first), plane(1.0, second)), 1);
    }
  }
}
