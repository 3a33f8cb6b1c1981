// The judge of the references: ray against triangle without any rounding. Every finite double is a
// whole number times a power of two, and so are all sums and products of such numbers; kept whole,
// the sign of a determinant is a fact and not an estimate. Where a reference in plain doubles is not
// sure of its answer, and wherever a test counts ulps, the question comes here.
//
// Correct over fast, and over clever: whole numbers of any length instead of the floating-point
// expansions of Shewchuk (1997), which lose bits when a product underflows.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace hrt
{
namespace reference
{

// sign * (limbs as a whole number, the least first) * 2^exponent. Not for NaN or infinity.
class ExactNumber
{
public:
  ExactNumber() = default;
  explicit ExactNumber(double value);

  int sign() const { return this->Sign; }
  ExactNumber operator-() const;
  ExactNumber abs() const { return this->Sign < 0 ? -*this : *this; }

  // Within one ulp of the value; infinite beyond the largest double.
  double approximate() const;

  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b);
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) { return a + -b; }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b);

private:
  using Limbs = std::vector<std::uint32_t>;
  ExactNumber(int sign, int exponent, Limbs limbs);
  Limbs shiftedTo(int exponent) const;

  int Sign = 0;
  int Exponent = 0;
  Limbs Digits;
};

// -1, 0 or 1 as a < b, a == b or a > b.
inline int compare(const ExactNumber& a, const ExactNumber& b)
{
  return (a - b).sign();
}

struct ExactVector
{
  ExactNumber x, y, z;

  ExactVector() = default;
  explicit ExactVector(const glm::dvec3& v)
    : x(v.x)
    , y(v.y)
    , z(v.z)
  {
  }
};
ExactVector operator-(const ExactVector& a, const ExactVector& b);
ExactNumber dot(const ExactVector& a, const ExactVector& b);
ExactVector cross(const ExactVector& a, const ExactVector& b);

// Sign of the volume of the tetrahedron a b c d: positive when a, b and c appear counter-clockwise
// seen from the side of their plane that d does not lie on.
int orientation(
  const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

// Where the line origin + t * direction meets the triangle's plane, as quotients that are never
// divided: t = depth / determinant, and the corners' weights over the determinant sum to 1.
struct ExactMeeting
{
  ExactNumber weightA, weightB, weightC;
  ExactNumber determinant; // 0: the line runs parallel to the plane, or there is no plane
  ExactNumber depth;

  // The line meets the closed triangle.
  bool inside() const;
  // It does so on an edge or at a corner.
  bool onBorder() const;
  // Sign of t.
  int side() const { return this->depth.sign() * this->determinant.sign(); }
};
ExactMeeting meet(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a,
  const glm::dvec3& b, const glm::dvec3& c);

// The triangle is hit in front of the origin, its border included.
bool hits(const ExactMeeting& meeting);

// Sign of (first's t - second's t).
int compareDepths(const ExactMeeting& first, const ExactMeeting& second);

// |value - numerator / denominator| <= tolerance, decided without rounding.
bool isWithin(double value, const ExactNumber& numerator, const ExactNumber& denominator,
  double tolerance);

} // namespace reference
} // namespace hrt
