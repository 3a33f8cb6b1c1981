// x to the power of y, for shading: the same bits wherever it runs. The C library's function is chosen for
// the processor when the program is loaded, and no vector library promises its bits.
//
// x is taken apart into 2^e m, m in [sqrt(1/2), sqrt(2)), and log2 m = 2 / ln 2 * artanh s with
// s = (m - 1) / (m + 1), |s| < 0.1716, by its series up to s^13: the rest is below 2 / ln 2 / 15 *
// 0.1716^15 / (1 - 0.1716^2) = 6.5e-13. 2^r of the rest |r| <= 1/2 by the exponential series up to r^9:
// what is left is below (ln 2 / 2)^10 / 10! = 7e-12. A result that is a float at all has |y log2 x| < 150,
// so that it is off by at most 150 * 6.5e-13 * ln 2 + 7e-12 < 1e-10 of itself, 1/600 of half a float's
// step: after rounding it is the true power's float but for one in several hundred, where it is the one
// beside it.
#pragma once

#include <cstdint>
#include <cstring>

namespace hrt
{

// The parts that numbers and lanes of numbers do in ways of their own; for lanes see Math/Lanes.h.
inline std::int64_t wholeBits(double a)
{
  std::int64_t bits;
  std::memcpy(&bits, &a, sizeof(bits));
  return bits;
}
inline double fromWholeBits(std::int64_t bits)
{
  double a;
  std::memcpy(&a, &bits, sizeof(a));
  return a;
}
inline std::int64_t raised(std::int64_t a, int bits)
{
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) << bits);
}
inline double select(bool mask, double a, double b)
{
  return mask ? a : b;
}

// `D`: double, or lanes of it. x: finite and not negative, a float's value; y likewise, of either sign.
// Of x = 0 the power is 0 where y is 0.2 or more.
template <class D>
inline __attribute__((always_inline)) D powerOf(const D& x, const D& y)
{
  constexpr std::int64_t fraction = (std::int64_t(1) << 52) - 1;
  constexpr std::int64_t one = std::int64_t(1023) << 52;
  constexpr std::int64_t exponentOf52 = std::int64_t(1023 + 52) << 52;
  const D shift(0x1p52);

  // x = 2^e m.
  const auto bits = wholeBits(x);
  const D m = fromWholeBits((bits & fraction) | one);
  const D e = fromWholeBits((bits >> 52) | exponentOf52) - D(0x1p52 + 1023.0);
  const auto large = m > D(1.4142135623730951);
  const D mantissa = select(large, m * D(0.5), m);
  const D exponent = select(large, e + D(1.0), e);

  constexpr double k = 2.8853900817779268; // 2 / ln 2
  const D s = (mantissa - D(1.0)) / (mantissa + D(1.0));
  const D s2 = s * s;
  D series(k / 13);
  series = series * s2 + D(k / 11);
  series = series * s2 + D(k / 9);
  series = series * s2 + D(k / 7);
  series = series * s2 + D(k / 5);
  series = series * s2 + D(k / 3);
  series = series * s2 + D(k);
  const D logarithm = exponent + s * series;

  // 2^p = 2^n 2^r. Beyond the bounds the float is 0 or infinity anyway.
  const D most(1000.0), least(-1000.0);
  D p = y * logarithm;
  p = select(p < least, least, p);
  p = select(p > most, most, p);
  const D nearest = D(1.5) * shift;
  const D n = p + nearest;
  const D r = p - (n - nearest);
  D power(1.0178086009239696e-07);
  power = power * r + D(1.3215486790144305e-06);
  power = power * r + D(1.5252733804059838e-05);
  power = power * r + D(1.5403530393381606e-04);
  power = power * r + D(1.3333558146428441e-03);
  power = power * r + D(9.618129107628477e-03);
  power = power * r + D(5.5504108664821576e-02);
  power = power * r + D(2.402265069591007e-01);
  power = power * r + D(6.9314718055994531e-01);
  power = power * r + D(1.0);
  // The low bits of n are the whole number itself.
  return power * fromWholeBits(raised(wholeBits(n), 52) + one);
}

inline float power(float x, float y)
{
  return static_cast<float>(powerOf(static_cast<double>(x), static_cast<double>(y)));
}

} // namespace hrt
