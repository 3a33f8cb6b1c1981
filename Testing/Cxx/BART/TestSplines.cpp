// The key curves against values computed by hand from the formulas of Kochanek and Bartels.
#include "BARTTest.h"

#include "IO/BART/AFF/Spline.h"

#include <cmath>

using namespace hrt::bart;

namespace
{

VectorKey key(double time, double x, KeyShape shape = {})
{
  return { time, glm::dvec3(x, 0.0, 0.0), shape };
}

double valueAt(const VectorSpline& spline, double time)
{
  return spline.at(time).x;
}

// The speed just before (side -1) or after (side +1) a time. For a cubic the error is of the order
// of h.
double speedAt(const VectorSpline& spline, double time, double side)
{
  const double h = 1e-6 * side;
  return (valueAt(spline, time + h) - valueAt(spline, time)) / h;
}
constexpr double kSpeedError = 1e-4;

RotationKey turnKey(double time, const glm::dvec3& axis, double degrees)
{
  return { time, rotationAbout(axis, degrees), {} };
}

// The angle in degrees by which two rotations differ.
double angleBetween(const glm::dquat& a, const glm::dquat& b)
{
  return glm::degrees(2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))));
}
// An angle from an arc cosine near 1 is known to the root of the last place.
constexpr double kAngleError = 1e-5;

} // anonymous namespace

TEST(Splines, PassThroughTheirKeysExactly)
{
  const VectorSpline spline({ key(0, 7), key(1, -3), key(2.5, 0.1), key(3, 11), key(4, 5) });
  EXPECT_EQ(valueAt(spline, 1.0), -3.0);
  EXPECT_EQ(valueAt(spline, 2.5), 0.1);
  EXPECT_EQ(valueAt(spline, 3.0), 11.0);
}

TEST(Splines, StandStillOutsideTheUsableKeys)
{
  const VectorSpline spline({ key(0, 7), key(1, -3), key(2, 4), key(3, 11) });
  EXPECT_EQ(valueAt(spline, 0.0), -3.0);
  EXPECT_EQ(valueAt(spline, -100.0), -3.0);
  EXPECT_EQ(valueAt(spline, 3.0), 4.0);
  EXPECT_EQ(valueAt(spline, 100.0), 4.0);
}

TEST(Splines, WithoutParametersAreCatmullRom)
{
  // Tangents (1 - 0) / 2 and (3 - 0) / 2; Hermite at one half: (0 + 1) / 2 + (0.5 - 1.5) / 8.
  const VectorSpline spline({ key(0, 0), key(1, 0), key(2, 1), key(3, 3) });
  EXPECT_DOUBLE_EQ(valueAt(spline, 1.5), 0.375);
  EXPECT_NEAR(speedAt(spline, 1.0, +1), 0.5, kSpeedError);
  EXPECT_NEAR(speedAt(spline, 2.0, -1), 1.5, kSpeedError);
}

TEST(Splines, TensionOneStopsAtTheKey)
{
  const KeyShape tight{ 1.0, 0.0, 0.0 };
  const VectorSpline spline({ key(0, -5), key(1, 0, tight), key(2, 1, tight), key(3, 9) });
  EXPECT_DOUBLE_EQ(valueAt(spline, 1.25), 0.15625) << "3 u^2 - 2 u^3";
  EXPECT_NEAR(speedAt(spline, 1.0, +1), 0.0, kSpeedError);
  EXPECT_NEAR(speedAt(spline, 2.0, -1), 0.0, kSpeedError);
}

TEST(Splines, ContinuityBreaksTheSpeedAtTheKey)
{
  // At time 2 the differences are 1 before and 4 after. Continuity 1 swaps them, -1 keeps each.
  for (double c : { 1.0, -1.0 })
  {
    const KeyShape shape{ 0.0, c, 0.0 };
    const VectorSpline spline({ key(0, 0), key(1, 1), key(2, 2, shape), key(3, 6), key(4, 6) });
    EXPECT_NEAR(speedAt(spline, 2.0, -1), c > 0.0 ? 4.0 : 1.0, kSpeedError);
    EXPECT_NEAR(speedAt(spline, 2.0, +1), c > 0.0 ? 1.0 : 4.0, kSpeedError);
  }
}

TEST(Splines, BiasFollowsOneNeighbour)
{
  for (double b : { 1.0, -1.0 })
  {
    const KeyShape shape{ 0.0, 0.0, b };
    const VectorSpline spline({ key(0, 0), key(1, 1), key(2, 2, shape), key(3, 6), key(4, 6) });
    const double expected = b > 0.0 ? 1.0 : 4.0;
    EXPECT_NEAR(speedAt(spline, 2.0, -1), expected, kSpeedError);
    EXPECT_NEAR(speedAt(spline, 2.0, +1), expected, kSpeedError);
  }
}

TEST(Splines, KeepTheirSpeedBetweenSegmentsOfUnequalLength)
{
  // Half the sum of the differences, scaled to time: (P2 - P0) / (t2 - t0) around the key at 1.
  const VectorSpline spline({ key(-1, 0), key(0, 0), key(1, 2), key(4, 3), key(5, 3) });
  EXPECT_NEAR(speedAt(spline, 1.0, -1), 3.0 / 4.0, kSpeedError);
  EXPECT_NEAR(speedAt(spline, 1.0, +1), 3.0 / 4.0, kSpeedError);
}

TEST(Splines, RepeatedFirstAndLastKeysLeaveStraightTangents)
{
  // The usual ends in BART's files: a neighbour at the same time has no say.
  const VectorSpline spline({ key(0, 1), key(0, 1), key(2, 5), key(2, 5) });
  for (double t : { 0.0, 0.5, 1.0, 1.7, 2.0 })
  {
    EXPECT_NEAR(valueAt(spline, t), 1.0 + 2.0 * t, 1e-12);
  }
}

TEST(Splines, AllKeysAtOneTimeAreThatMoment)
{
  const VectorSpline spline({ key(3, 1), key(3, 2), key(3, 4), key(3, 8) });
  EXPECT_EQ(valueAt(spline, 2.0), 2.0);
  EXPECT_EQ(valueAt(spline, 4.0), 4.0);
}

TEST(Splines, ATableThatJumpsBackGoesOnWithTheFirstSegmentThatEndsLater)
{
  // Two tables in one, as in BART's Robot1.aff: 0 ... 4, then 2 ... 6.
  const VectorSpline spline({ key(0, 0), key(0, 0), key(2, 2), key(4, 4), key(2, 102), key(5, 105),
    key(6, 106), key(6, 106) });
  EXPECT_EQ(valueAt(spline, 2.0), 2.0);
  EXPECT_GT(valueAt(spline, 4.5), 100.0);
  EXPECT_EQ(valueAt(spline, 5.0), 105.0);
  EXPECT_EQ(valueAt(spline, 7.0), 106.0);
}

TEST(Splines, RotationsAboutOneAxisAreTheSplineOfTheAngle)
{
  const glm::dvec3 axis(0.0, 0.0, 2.0); // need not be of unit length
  const std::vector<double> times = { 0, 1, 3, 4 }, angles = { 10, 20, 80, 170 };
  std::vector<RotationKey> turns;
  std::vector<VectorKey> values;
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const KeyShape shape{ 0.2, 0.3, -0.4 };
    turns.push_back({ times[i], rotationAbout(axis, angles[i]), shape });
    values.push_back(key(times[i], angles[i], shape));
  }
  const RotationSpline rotation(turns);
  const VectorSpline angle(values);
  for (double t : { 0.5, 1.0, 1.3, 2.0, 2.9, 3.0, 3.5 })
  {
    EXPECT_NEAR(
      angleBetween(rotation.at(t), rotationAbout(axis, valueAt(angle, t))), 0.0, kAngleError)
      << t;
  }
}

TEST(Splines, RotationsPassThroughKeysAboutDifferentAxes)
{
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), d(1, 1, 1);
  const std::vector<RotationKey> keys = { turnKey(0, x, 5), turnKey(1, x, 50), turnKey(2, y, 70),
    turnKey(3, d, -100), turnKey(4, d, 0) };
  const RotationSpline spline(keys);
  for (std::size_t i = 1; i + 1 < keys.size(); ++i)
  {
    EXPECT_NEAR(angleBetween(spline.at(keys[i].time), keys[i].value), 0.0, kAngleError);
  }
  EXPECT_NEAR(glm::length(spline.at(1.37)), 1.0, 1e-12);
}

TEST(Splines, RotationsTakeTheShorterWayWhateverTheSignsOfTheirQuaternions)
{
  // 350 and -10 degrees are one rotation; 180 degrees of whole turns are none.
  const glm::dvec3 z(0, 0, 1);
  const RotationSpline spline(
    { turnKey(0, z, 350), turnKey(0, z, -10), turnKey(1, z, 730), turnKey(1, z, 10) });
  EXPECT_NEAR(angleBetween(spline.at(0.5), rotationAbout(z, 0)), 0.0, kAngleError);
}

TEST(Splines, QuarterTurnsAddUpToWholeOnes)
{
  const glm::dvec3 z(0, 0, 1);
  std::vector<RotationKey> keys;
  for (int i = 0; i < 20; ++i)
  {
    keys.push_back(turnKey(i, z, 90.0 * i));
  }
  const RotationSpline spline(keys);
  for (double t : { 1.5, 3.25, 7.75, 17.5 })
  {
    EXPECT_NEAR(angleBetween(spline.at(t), rotationAbout(z, 90.0 * t)), 0.0, kAngleError) << t;
  }
}

TEST(Splines, ARotationWithoutAxisIsNone)
{
  EXPECT_EQ(rotationAbout(glm::dvec3(0.0), 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(Splines, RotationsAreRightHanded)
{
  expectNear(rotationAbout(glm::dvec3(0, 0, 1), 90.0) * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0));
}

TEST(Splines, VisibilityStepsAtItsKeysAndStartsVisible)
{
  const VisibilityTrack track({ { 2.0, false }, { 4.0, true } });
  EXPECT_TRUE(track.at(1.99));
  EXPECT_FALSE(track.at(2.0));
  EXPECT_FALSE(track.at(3.99));
  EXPECT_TRUE(track.at(4.0));
  EXPECT_TRUE(track.at(100.0));
}
