// The exact kernel: what it hits, what it refuses, that nothing slips through, and how exact it is.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace hrt;
using scenes::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Corners kTriangle{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };

bool triangleHit(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& corners,
  double tMaximum, TriangleHit& hit)
{
  return ShearedRay(origin, direction).hitsTriangle(corners, tMaximum, hit);
}

bool hits(glm::dvec3 origin, glm::dvec3 direction, double tMaximum = kInfinity)
{
  TriangleHit hit;
  return triangleHit(origin, direction, kTriangle, tMaximum, hit);
}

TEST(TriangleIntersection, ReportsWhereItHits)
{
  // All numbers are exact in binary, and so are their products: no tolerance.
  TriangleHit hit;
  ASSERT_TRUE(triangleHit({ 0.25, 0.5, 2 }, { 0, 0, -0.5 }, kTriangle, kInfinity, hit));
  EXPECT_EQ(hit.t, 4.0);
  EXPECT_EQ(hit.u, 0.25);
  EXPECT_EQ(hit.v, 0.5);
}

TEST(TriangleIntersection, BothSidesCount)
{
  EXPECT_TRUE(hits({ 0.25, 0.25, 1 }, { 0, 0, -1 }));
  EXPECT_TRUE(hits({ 0.25, 0.25, -1 }, { 0, 0, 1 }));
}

TEST(TriangleIntersection, EdgesAndVerticesCount)
{
  for (const glm::dvec2& p : { glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1),
         glm::dvec2(0.5, 0), glm::dvec2(0, 0.5), glm::dvec2(0.5, 0.5) })
  {
    EXPECT_TRUE(hits({ p, 1 }, { 0, 0, -1 })) << p.x << " " << p.y;
  }
  const double outside = 0x1p-50; // one step of the coordinates beyond an edge is outside
  EXPECT_FALSE(hits({ -outside, 0.5, 1 }, { 0, 0, -1 }));
  EXPECT_FALSE(hits({ 0.5, -outside, 1 }, { 0, 0, -1 }));
  EXPECT_FALSE(hits({ 0.5, 0.5 + outside, 1 }, { 0, 0, -1 }));
}

TEST(TriangleIntersection, RespectsTheRange)
{
  const glm::dvec3 above(0.25, 0.25, 1), down(0, 0, -1);
  EXPECT_FALSE(hits(above, -down));
  EXPECT_FALSE(hits(above, down, 1.0)); // t < tMaximum, not equal
  EXPECT_TRUE(hits(above, down, std::nextafter(1.0, 2.0)));
  EXPECT_FALSE(hits({ 0.25, 0.25, 0 }, down)); // t == 0
}

TEST(TriangleIntersection, EdgeOnIsAMiss)
{
  TriangleHit hit;
  EXPECT_FALSE(hits({ -1, 0.25, 0 }, { 1, 0, 0 }));
  EXPECT_FALSE(planeHit({ -1, 0.25, 1 }, { 1, 0, 0 }, kTriangle, hit));
}

TEST(TriangleIntersection, GrazingRaysHitWhereTheyShould)
{
  // Slope 2^-20: the ray meets the plane 2^20 heights away, at an exactly representable point.
  TriangleHit hit;
  ASSERT_TRUE(triangleHit(
    { -0.5, 0.25, 0x1p-20 }, { 1, 0, -0x1p-20 }, kTriangle, kInfinity, hit));
  EXPECT_EQ(hit.t, 1.0);
  EXPECT_EQ(hit.u, 0.5);
  EXPECT_EQ(hit.v, 0.25);
}

TEST(TriangleIntersection, UnusableRaysAndTrianglesAreMisses)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const glm::dvec3 above(0.25, 0.25, 1), down(0, 0, -1);
  for (double bad : { nan, kInfinity, -kInfinity })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      glm::dvec3 origin = above, direction = down;
      origin[axis] = bad;
      EXPECT_FALSE(hits(origin, down));
      direction[axis] = bad;
      EXPECT_FALSE(hits(above, direction));
      Corners corners = kTriangle;
      corners.b[axis] = bad;
      TriangleHit hit;
      EXPECT_FALSE(triangleHit(above, down, corners, kInfinity, hit));
      EXPECT_FALSE(planeHit(above, down, corners, hit));
    }
  }
  EXPECT_FALSE(hits(above, { 0, 0, 0 }));
  EXPECT_FALSE(hits(above, down, nan));
  EXPECT_TRUE(hits(above, { 0, 0, -std::numeric_limits<double>::min() })); // short is not zero
}

TEST(TriangleIntersection, PlaneHitAgreesBitByBit)
{
  Random random(1);
  int found = 0;
  for (int i = 0; i < 100000; ++i)
  {
    const Corners corners{ random.inBox(1), random.inBox(1), random.inBox(1) };
    const glm::dvec3 origin = random.inBox(2), direction = random.inBox(1) - origin;
    TriangleHit a, b;
    if (triangleHit(origin, direction, corners, kInfinity, a))
    {
      ++found;
      ASSERT_TRUE(planeHit(origin, direction, corners, b));
      ASSERT_TRUE(a.t == b.t && a.u == b.u && a.v == b.v);
    }
  }
  EXPECT_GT(found, 1000);
}

// A fan of triangles around a vertex, its rim a polygon around the ray's target. Every ray aimed
// at the middle, at a spoke or anywhere inside must hit at least one of them.
TEST(TriangleIntersection, NothingSlipsThroughAFan)
{
  Random random(2);
  int leaks = 0, aimed = 0;
  for (int fan = 0; fan < 4000; ++fan)
  {
    const double scale = std::pow(10.0, random(-6, 6));
    const int spokes = 3 + static_cast<int>(random.below(12));
    const glm::dvec3 middle = random.inBox(scale);
    std::vector<glm::dvec3> rim;
    for (int s = 0; s < spokes; ++s)
    {
      const double a = 2 * scenes::kPi * (s + random(-0.2, 0.2)) / spokes, r = random(0.5, 1.5);
      rim.push_back(middle + scale * glm::dvec3(r * std::cos(a), r * std::sin(a), 0));
    }
    const glm::dvec3 eye = middle + scale * glm::dvec3(random(-2, 2), random(-2, 2), 3);
    for (int ray = 0; ray < 50; ++ray)
    {
      const glm::dvec3 end = rim[random.below(rim.size())];
      const double share = ray % 2 ? 0.0 : random(0.0, 0.9);
      const ShearedRay exact(eye, middle + share * (end - middle) - eye);
      bool hit = false;
      for (int s = 0; s < spokes; ++s)
      {
        TriangleHit h;
        hit = hit || exact.hitsTriangle({ middle, rim[s], rim[(s + 1) % spokes] }, kInfinity, h);
      }
      ++aimed;
      leaks += !hit;
    }
  }
  EXPECT_EQ(aimed, 200000);
  EXPECT_EQ(leaks, 0);
}

// Edges that pass the ray within less than the rounding of their corners, on either side. The ray
// is the z axis, so that no shear blurs the aim. A kernel that fuses one of an edge function's two
// products loses many of these rays between the neighbours; this one must lose none.
TEST(TriangleIntersection, NothingSlipsThroughAnEdge)
{
  Random random(10);
  int leaks = 0;
  for (int i = 0; i < 200000; ++i)
  {
    const glm::dvec3 one(random(0.1, 1), random(-1, 1), 0);
    const glm::dvec3 other = -random(0.1, 1) * one; // opposite the axis, up to rounding
    const glm::dvec3 left(-one.y, one.x, 0), right = -left;
    const ShearedRay axis({ 0, 0, 1 }, { 0, 0, -1 });
    TriangleHit hit;
    leaks += !axis.hitsTriangle({ one, other, left }, kInfinity, hit) &&
      !axis.hitsTriangle({ other, one, right }, kInfinity, hit);
  }
  EXPECT_EQ(leaks, 0);
}

// Triangles of a few steps of their coordinates, a million million of their own sizes away from the
// ray: their edge functions are what rounding has left of differences of equals, and for some the
// signs agree.
TEST(TriangleIntersection, NothingFarFromATinyTriangleIsAHit)
{
  Random random(12);
  int phantoms = 0;
  const ShearedRay axis({ 0, 0, 1 }, { 0, 0, -1 });
  for (int i = 0; i < 500000; ++i)
  {
    const glm::dvec3 place(random(0.5, 1.0), random(0.5, 1.0), random(-1.0, 0.0));
    const auto corner = [&] { return place + random.inBox(4 * scenes::kDoubleRounding); };
    const Corners c{ corner(), corner(), corner() };
    TriangleHit hit;
    phantoms += axis.hitsTriangle(c, kInfinity, hit);
  }
  EXPECT_EQ(phantoms, 0);
}

// Corners and rays on a lattice so fine that every number and product is exact: the kernel must say
// just what whole numbers say, on edges, at corners and on the border of the triangle's box too, many
// of which coincide here.
TEST(TriangleIntersection, OnALatticeItEqualsWholeNumbers)
{
  Random random(13);
  const double step = 0x1p-52;
  int hits = 0, borders = 0, wrong = 0;
  for (int i = 0; i < 500000; ++i)
  {
    int x[4], y[4]; // three corners and the ray
    for (int k = 0; k < 4; ++k)
    {
      x[k] = static_cast<int>(random.below(9));
      y[k] = static_cast<int>(random.below(9));
    }
    const auto at = [&](int k, double z) {
      return glm::dvec3(1.0 + step * x[k], 1.0 + step * y[k], z);
    };
    const auto side = [&](int j, int k) {
      return (x[j] - x[3]) * (y[k] - y[3]) - (y[j] - y[3]) * (x[k] - x[3]);
    };
    const int ab = side(0, 1), bc = side(1, 2), ca = side(2, 0);
    const bool agree = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    const bool expected = agree && ab + bc + ca != 0;
    TriangleHit hit;
    const bool found = triangleHit(
      at(3, 2.0), { 0, 0, -1 }, { at(0, 0.0), at(1, 0.0), at(2, 0.0) }, kInfinity, hit);
    wrong += found != expected;
    hits += expected;
    borders += expected && (ab == 0 || bc == 0 || ca == 0);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(hits, 20000);
  EXPECT_GT(borders, 5000);
}

// Needles across the ray, their two near corners a few roundings apart: what is hit must be where u and
// v say, up to roundings of the needle's length, and not at some corner far from the ray.
TEST(TriangleIntersection, NeedlesAreHitWhereTheRayIs)
{
  Random random(14);
  const ShearedRay axis({ 0, 0, 1 }, { 0, 0, -1 });
  int hits = 0;
  double worst = 0.0;
  for (int i = 0; i < 500000; ++i)
  {
    const glm::dvec3 tip(random(0.1, 1.0), random(0.1, 1.0), random(-1.0, 0.0));
    const glm::dvec3 far = -random(0.1, 10.0) * tip; // opposite the ray's foot, up to rounding
    const auto about = [&](const glm::dvec3& p) {
      return glm::dvec3(p.x * (1.0 + random(-3, 3) * scenes::kDoubleRounding),
        p.y * (1.0 + random(-3, 3) * scenes::kDoubleRounding), random(-1.0, 0.0));
    };
    const Corners c{ about(tip), about(tip), about(far) };
    TriangleHit hit;
    if (axis.hitsTriangle(c, kInfinity, hit))
    {
      const glm::dvec3 at = c.a + hit.u * (c.b - c.a) + hit.v * (c.c - c.a);
      const double length = std::max(glm::length(glm::dvec2(tip)), glm::length(glm::dvec2(far)));
      worst = std::max(worst, std::max(std::abs(at.x), std::abs(at.y)) / length);
      ++hits;
    }
  }
  EXPECT_LE(worst, 8 * scenes::kDoubleRounding);
  EXPECT_GT(hits, 1000);
}

// Rays through a known point of a triangle. Sheared corners are off by a few roundings of the
// largest distance M, edge functions by a few of M * M, and the quotients by that over the
// determinant: 32 roundings are counted for all of it.
TEST(TriangleIntersection, HitsAreExactWithinTheirBound)
{
  Random random(3);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i)
  {
    const Corners c{ random.inBox(1), random.inBox(1), random.inBox(1) };
    double u = random(0.01, 0.98), v = random(0.01, 0.98);
    if (u + v > 0.99)
    {
      u = (1 - u) * 0.99;
      v = (1 - v) * 0.99;
    }
    const glm::dvec3 origin = random.inBox(3);
    const glm::dvec3 target = c.a + u * (c.b - c.a) + v * (c.c - c.a);
    const glm::dvec3 direction = target - origin;
    const double m = std::max({ glm::length(c.a - origin), glm::length(c.b - origin),
      glm::length(c.c - origin) });
    const double det = std::abs(
      glm::dot(glm::cross(c.b - c.a, c.c - c.a), glm::normalize(direction)));
    const double bound = 32 * scenes::kDoubleRounding * m * m / det;
    if (bound > 0.001)
    {
      continue; // edge-on
    }
    TriangleHit hit;
    ASSERT_TRUE(triangleHit(origin, direction, c, kInfinity, hit));
    // t counts in the direction's length; a depth error of m bounds is one of m / length in t.
    const double length = glm::length(direction);
    worst = std::max({ worst, std::abs(hit.u - u) / bound, std::abs(hit.v - v) / bound,
      std::abs(hit.t - 1) * length / (m * bound) });
  }
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 1e-3); // the bound says something
}

} // namespace
