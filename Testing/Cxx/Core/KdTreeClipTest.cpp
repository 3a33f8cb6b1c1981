// The clipping behind perfect splits, against rational arithmetic and at its awkward corners.
#include "KdTreeScenes.h"
#include "Rendering/Core/Structures/KdTreeClip.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace
{

using namespace hrt;

// --- An exact clipper for corners and planes at small integers --------------------------------------

// Reduced after each operation: every corner of a clipped triangle is where lines and planes with small
// integer coefficients meet, so 64 bits are plenty.
struct Fraction
{
  std::int64_t above = 0, below = 1;

  Fraction(std::int64_t a = 0, std::int64_t b = 1)
  {
    const std::int64_t divisor = std::max<std::int64_t>(1, std::gcd(a, b)) * (b < 0 ? -1 : 1);
    this->above = a / divisor;
    this->below = b / divisor;
  }
  friend Fraction operator+(Fraction x, Fraction y)
  {
    return { x.above * y.below + y.above * x.below, x.below * y.below };
  }
  friend Fraction operator-(Fraction x, Fraction y) { return x + Fraction(-y.above, y.below); }
  friend Fraction operator*(Fraction x, Fraction y)
  {
    return { x.above * y.above, x.below * y.below };
  }
  friend Fraction operator/(Fraction x, Fraction y)
  {
    return { x.above * y.below, x.below * y.above };
  }
  friend bool operator<(Fraction x, Fraction y) { return x.above * y.below < y.above * x.below; }
  double value() const { return double(this->above) / double(this->below); }
};
using ExactPoint = std::array<Fraction, 3>;

std::vector<ExactPoint> exactClip(
  const std::vector<ExactPoint>& polygon, int axis, std::int64_t plane, int sign)
{
  std::vector<ExactPoint> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const ExactPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Fraction da = Fraction(sign) * (a[axis] - Fraction(plane));
    const Fraction db = Fraction(sign) * (b[axis] - Fraction(plane));
    if (!(da < Fraction(0)))
    {
      kept.push_back(a);
    }
    if ((da < Fraction(0) && Fraction(0) < db) || (db < Fraction(0) && Fraction(0) < da))
    {
      const Fraction share = da / (da - db);
      ExactPoint point;
      for (int k = 0; k < 3; ++k)
      {
        point[k] = a[k] + share * (b[k] - a[k]);
      }
      kept.push_back(point);
    }
  }
  return kept;
}

std::vector<ExactPoint> exactPart(const glm::vec3* corners, const KdBox& cell)
{
  std::vector<ExactPoint> polygon;
  for (int i = 0; i < 3; ++i)
  {
    ExactPoint point;
    for (int k = 0; k < 3; ++k)
    {
      point[k] = Fraction(std::int64_t(corners[i][k]));
    }
    polygon.push_back(point);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    polygon = exactClip(polygon, axis, std::int64_t(cell.lower[axis]), 1);
    polygon = exactClip(polygon, axis, std::int64_t(cell.upper[axis]), -1);
  }
  return polygon;
}

// Whether the exact part has an area: less is what rounding may make vanish, and then the bounds are
// those of the whole triangle.
bool hasArea(const std::vector<ExactPoint>& exact)
{
  for (std::size_t i = 2; i < exact.size(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const Fraction left = (exact[1][u] - exact[0][u]) * (exact[i][v] - exact[0][v]);
      const Fraction right = (exact[1][v] - exact[0][v]) * (exact[i][u] - exact[0][u]);
      if (left < right || right < left)
      {
        return true;
      }
    }
  }
  return false;
}

// The computed bounds hold the exact ones, and are at most one float away from them.
void expectTight(const KdBox& box, const std::vector<ExactPoint>& exact)
{
  const double loose = hasArea(exact) ? 0.0 : std::numeric_limits<double>::infinity();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    Fraction lower = exact[0][axis], upper = exact[0][axis];
    for (const ExactPoint& point : exact)
    {
      lower = point[axis] < lower ? point[axis] : lower;
      upper = upper < point[axis] ? point[axis] : upper;
    }
    EXPECT_LE(double(box.lower[axis]), lower.value() + 1e-14);
    EXPECT_GE(double(std::nextafter(box.lower[axis], kInfinity)),
      lower.value() - 1e-14 - loose);
    EXPECT_GE(double(box.upper[axis]), upper.value() - 1e-14);
    EXPECT_LE(double(std::nextafter(box.upper[axis], -kInfinity)),
      upper.value() + 1e-14 + loose);
  }
}

TEST(KdTreeClip, EqualsRationalArithmetic)
{
  scenes::Random random(21);
  int compared = 0;
  for (int i = 0; i < 20000; ++i)
  {
    glm::vec3 corners[3];
    KdBox cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (glm::vec3& corner : corners)
      {
        corner[axis] = float(random.below(17)) - 8.0f;
      }
      cell.lower[axis] = float(random.below(12)) - 8.0f;
      cell.upper[axis] = cell.lower[axis] + 1.0f + float(random.below(6));
    }
    const int axis = int(random.below(3));
    const float plane = std::floor(0.5f * (cell.lower[axis] + cell.upper[axis]));
    KdBox lowerCell = cell, upperCell = cell;
    lowerCell.upper[axis] = upperCell.lower[axis] = plane;
    const auto lower = exactPart(corners, lowerCell), upper = exactPart(corners, upperCell);
    if (lower.empty() || upper.empty())
    {
      continue;
    }
    const KdSplitBounds bounds = splitTriangle(corners, cell, axis, plane);
    expectTight(bounds.lower, lower);
    expectTight(bounds.upper, upper);
    ++compared;
  }
  EXPECT_GT(compared, 2000);
}

// --- Corners of its own -----------------------------------------------------------------------------

const KdBox kUnit{ glm::vec3(0.0f), glm::vec3(1.0f) };

void expectBox(const KdBox& box, const glm::vec3& lower, const glm::vec3& upper)
{
  EXPECT_EQ(box.lower, lower);
  EXPECT_EQ(box.upper, upper);
}

TEST(KdTreeClip, ContainedTriangleKeepsItsBounds)
{
  const glm::vec3 corners[3] = { { 0.25f, 0.25f, 0.5f }, { 0.75f, 0.25f, 0.5f },
    { 0.25f, 0.75f, 0.5f } };
  const KdSplitBounds bounds = splitTriangle(corners, kUnit, 0, 0.5f);
  expectBox(bounds.lower, { 0.25f, 0.25f, 0.5f }, { 0.5f, 0.75f, 0.5f });
  expectBox(bounds.upper, { 0.5f, 0.25f, 0.5f }, { 0.75f, 0.5f, 0.5f });
}

TEST(KdTreeClip, FlatCellKeepsATriangleInItsPlane)
{
  const KdBox flat{ { 0, 0, 0.5f }, { 1, 1, 0.5f } };
  const glm::vec3 corners[3] = { { -1, -1, 0.5f }, { 3, -1, 0.5f }, { -1, 3, 0.5f } };
  const KdSplitBounds bounds = splitTriangle(corners, flat, 1, 0.25f);
  expectBox(bounds.lower, { 0, 0, 0.5f }, { 1, 0.25f, 0.5f });
  expectBox(bounds.upper, { 0, 0.25f, 0.5f }, { 1, 1, 0.5f });
}

TEST(KdTreeClip, FlatCellThatATriangleCrosses)
{
  const KdBox flat{ { 0, 0, 0.5f }, { 1, 1, 0.5f } };
  const glm::vec3 corners[3] = { { 0.5f, 0, 0 }, { 0.5f, 1, 0 }, { 0.5f, 0.5f, 1 } };
  const KdSplitBounds bounds = splitTriangle(corners, flat, 1, 0.5f);
  expectBox(bounds.lower, { 0.5f, 0.25f, 0.5f }, { 0.5f, 0.5f, 0.5f });
  expectBox(bounds.upper, { 0.5f, 0.5f, 0.5f }, { 0.5f, 0.75f, 0.5f });
}

// A triangle that meets the cell in one point only is not lost.
TEST(KdTreeClip, TouchingPointIsKept)
{
  const glm::vec3 corners[3] = { { 1, 0.5f, 0.5f }, { 2, 0, 0.5f }, { 2, 1, 0.5f } };
  const KdSplitBounds bounds = splitTriangle(corners, kUnit, 1, 0.5f);
  expectBox(bounds.lower, { 1, 0.5f, 0.5f }, { 1, 0.5f, 0.5f });
  expectBox(bounds.upper, { 1, 0.5f, 0.5f }, { 1, 0.5f, 0.5f });
}

// Away from the cell: a caller's mistake, but its triangle stays within the cell and is not lost.
TEST(KdTreeClip, TriangleAwayIsKeptAtTheNearestSide)
{
  const glm::vec3 corners[3] = { { 5, 0.25f, 0 }, { 6, 0.25f, 1 }, { 5, 0.75f, 0 } };
  const KdSplitBounds bounds = splitTriangle(corners, kUnit, 1, 0.5f);
  expectBox(bounds.lower, { 1, 0.25f, 0 }, { 1, 0.5f, 1 });
  expectBox(bounds.upper, { 1, 0.5f, 0 }, { 1, 0.75f, 1 });
}

// The numbers of Embree's regression TriangleSplitRegression, where its bins and its classifier differed.
TEST(KdTreeClip, EmbreesSplitRegression)
{
  const float a = -6.4000024f, b = 25.6f, c = 34.0f, d = 57.6000022f;
  const glm::vec3 corners[3] = { { a, a, c }, { b, d, a }, { d, b, d } };
  const KdBox cell{ { a, a, a }, { d, d, d } };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (float plane = a; plane <= d; plane = std::nextafter(plane, d) + 0.37f)
    {
      const KdSplitBounds bounds = splitTriangle(corners, cell, axis, plane);
      EXPECT_LE(bounds.lower.upper[axis], plane);
      EXPECT_GE(bounds.upper.lower[axis], plane);
      EXPECT_FALSE(bounds.lower.empty());
      EXPECT_FALSE(bounds.upper.empty());
    }
  }
}

} // namespace
