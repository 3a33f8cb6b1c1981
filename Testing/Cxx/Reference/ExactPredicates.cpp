// Whole-number arithmetic as taught at school, in limbs of 32 bits: see the header for why.
#include "Testing/Cxx/Reference/ExactPredicates.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hrt
{
namespace reference
{

namespace
{

using Limbs = std::vector<std::uint32_t>;
constexpr int kLimbBits = 32;

// Bits of a double's significand.
constexpr int kSignificandBits = 53;

void trim(Limbs& limbs)
{
  while (!limbs.empty() && limbs.back() == 0)
  {
    limbs.pop_back();
  }
}

int compareMagnitudes(const Limbs& a, const Limbs& b)
{
  if (a.size() != b.size())
  {
    return a.size() < b.size() ? -1 : 1;
  }
  for (std::size_t i = a.size(); i-- > 0;)
  {
    if (a[i] != b[i])
    {
      return a[i] < b[i] ? -1 : 1;
    }
  }
  return 0;
}

Limbs addMagnitudes(const Limbs& a, const Limbs& b)
{
  Limbs sum(std::max(a.size(), b.size()) + 1);
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < sum.size(); ++i)
  {
    carry += (i < a.size() ? a[i] : 0ull) + (i < b.size() ? b[i] : 0ull);
    sum[i] = static_cast<std::uint32_t>(carry);
    carry >>= kLimbBits;
  }
  trim(sum);
  return sum;
}

// a must not be less than b.
Limbs subtractMagnitudes(const Limbs& a, const Limbs& b)
{
  Limbs difference(a.size());
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const std::uint64_t take = (i < b.size() ? b[i] : 0ull) + borrow;
    borrow = a[i] < take ? 1 : 0;
    difference[i] = static_cast<std::uint32_t>(a[i] - take);
  }
  trim(difference);
  return difference;
}

Limbs multiplyMagnitudes(const Limbs& a, const Limbs& b)
{
  Limbs product(a.size() + b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      carry += std::uint64_t(a[i]) * b[j] + product[i + j];
      product[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= kLimbBits;
    }
    product[i + b.size()] = static_cast<std::uint32_t>(carry);
  }
  trim(product);
  return product;
}

} // namespace

ExactNumber::ExactNumber(double value)
{
  if (!std::isfinite(value))
  {
    throw std::invalid_argument("NaN and infinity are no exact numbers");
  }
  if (value == 0.0)
  {
    return;
  }
  int exponent = 0;
  const double fraction = std::frexp(std::abs(value), &exponent);
  const auto whole = static_cast<std::uint64_t>(std::ldexp(fraction, kSignificandBits));
  this->Sign = value < 0.0 ? -1 : 1;
  this->Exponent = exponent - kSignificandBits;
  this->Digits = { static_cast<std::uint32_t>(whole),
    static_cast<std::uint32_t>(whole >> kLimbBits) };
  trim(this->Digits);
}

ExactNumber::ExactNumber(int sign, int exponent, Limbs limbs)
  : Sign(limbs.empty() ? 0 : sign)
  , Exponent(exponent)
  , Digits(std::move(limbs))
{
}

ExactNumber ExactNumber::operator-() const
{
  return ExactNumber(-this->Sign, this->Exponent, this->Digits);
}

// The magnitude in units of 2^exponent, which must not be above the number's own.
ExactNumber::Limbs ExactNumber::shiftedTo(int exponent) const
{
  const int by = this->Exponent - exponent;
  const int limbs = by / kLimbBits, bits = by % kLimbBits;
  Limbs shifted(static_cast<std::size_t>(limbs), 0u);
  std::uint64_t carry = 0;
  for (const std::uint32_t digit : this->Digits)
  {
    carry |= std::uint64_t(digit) << bits;
    shifted.push_back(static_cast<std::uint32_t>(carry));
    carry >>= kLimbBits;
  }
  shifted.push_back(static_cast<std::uint32_t>(carry));
  trim(shifted);
  return shifted;
}

double ExactNumber::approximate() const
{
  // Three limbs hold at least 65 significant bits, more than a double keeps.
  double sum = 0.0;
  const std::size_t size = this->Digits.size(), first = size > 3 ? size - 3 : 0;
  for (std::size_t i = size; i-- > first;)
  {
    sum = sum * 0x1p32 + this->Digits[i];
  }
  return std::ldexp(this->Sign * sum, this->Exponent + kLimbBits * static_cast<int>(first));
}

ExactNumber operator+(const ExactNumber& a, const ExactNumber& b)
{
  if (a.Sign == 0 || b.Sign == 0)
  {
    return a.Sign == 0 ? b : a;
  }
  const int exponent = std::min(a.Exponent, b.Exponent);
  const Limbs x = a.shiftedTo(exponent), y = b.shiftedTo(exponent);
  if (a.Sign == b.Sign)
  {
    return ExactNumber(a.Sign, exponent, addMagnitudes(x, y));
  }
  return compareMagnitudes(x, y) >= 0 ? ExactNumber(a.Sign, exponent, subtractMagnitudes(x, y))
                                      : ExactNumber(b.Sign, exponent, subtractMagnitudes(y, x));
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b)
{
  return a.Sign == 0 || b.Sign == 0 ? ExactNumber()
                                    : ExactNumber(a.Sign * b.Sign, a.Exponent + b.Exponent,
                                        multiplyMagnitudes(a.Digits, b.Digits));
}

ExactVector operator-(const ExactVector& a, const ExactVector& b)
{
  ExactVector v;
  v.x = a.x - b.x;
  v.y = a.y - b.y;
  v.z = a.z - b.z;
  return v;
}

ExactNumber dot(const ExactVector& a, const ExactVector& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

ExactVector cross(const ExactVector& a, const ExactVector& b)
{
  ExactVector v;
  v.x = a.y * b.z - a.z * b.y;
  v.y = a.z * b.x - a.x * b.z;
  v.z = a.x * b.y - a.y * b.x;
  return v;
}

int orientation(
  const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d)
{
  const ExactVector apex(d);
  const ExactVector u = ExactVector(a) - apex, v = ExactVector(b) - apex, w = ExactVector(c) - apex;
  return dot(u, cross(v, w)).sign();
}

bool ExactMeeting::inside() const
{
  const int a = this->weightA.sign(), b = this->weightB.sign(), c = this->weightC.sign();
  return this->determinant.sign() != 0 &&
    ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0));
}

bool ExactMeeting::onBorder() const
{
  return this->inside() &&
    (this->weightA.sign() == 0 || this->weightB.sign() == 0 || this->weightC.sign() == 0);
}

// With a, b, c counted from the origin the weights are the volumes det(d, b, c), det(d, c, a) and
// det(d, a, b); their sum is d . n, and t = n . a / n . d, where n = (b - a) x (c - a).
ExactMeeting meet(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a,
  const glm::dvec3& b, const glm::dvec3& c)
{
  const ExactVector o(origin), d(direction);
  const ExactVector oa = ExactVector(a) - o, ob = ExactVector(b) - o, oc = ExactVector(c) - o;
  const ExactVector bc = cross(ob, oc);
  ExactMeeting meeting;
  meeting.weightA = dot(d, bc);
  meeting.weightB = dot(d, cross(oc, oa));
  meeting.weightC = dot(d, cross(oa, ob));
  meeting.determinant = meeting.weightA + meeting.weightB + meeting.weightC;
  meeting.depth = dot(oa, bc); // n . a: the other two volumes contain a twice
  return meeting;
}

bool hits(const ExactMeeting& meeting)
{
  return meeting.inside() && meeting.side() > 0;
}

int compareDepths(const ExactMeeting& first, const ExactMeeting& second)
{
  return compare(first.depth * second.determinant, second.depth * first.determinant) *
    first.determinant.sign() * second.determinant.sign();
}

bool isWithin(double value, const ExactNumber& numerator, const ExactNumber& denominator,
  double tolerance)
{
  const ExactNumber error = ExactNumber(value) * denominator - numerator;
  return compare(error.abs(), ExactNumber(tolerance) * denominator.abs()) <= 0;
}

} // namespace reference
} // namespace hrt
