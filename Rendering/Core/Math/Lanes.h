// Eight numbers as one value, in the widest registers of the instruction set that the including file is
// compiled for, and vectors of them. Each operation is that of a single number, eight times: with
// -ffp-contract=off a lane has the same bits as the plain computation, whatever the set.
//
// Internal to the files of one instruction set (see Surface/SurfaceKernels.h), each of which includes it
// in a namespace of its own, HRT_LANES_NAMESPACE: the same names never mean two things in one program.
// Of the standard library only what needs no code of its own may be used here.
#pragma once

#include <cstdint>
#include <cstring>

// The sets that are used as a whole or not at all.
#if defined(__AVX2__) && defined(__FMA__)
#define HRT_LANES_256 1
#else
#define HRT_LANES_256 0
#endif
#if HRT_LANES_256 && defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define HRT_LANES_512 1
#else
#define HRT_LANES_512 0
#endif

#if HRT_LANES_256
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

#define HRT_INLINE inline __attribute__((always_inline))
#define HRT_INLINED __attribute__((always_inline)) // of a lambda

namespace hrt
{
namespace HRT_LANES_NAMESPACE
{

constexpr int kLanes = 8;

#if HRT_LANES_512
constexpr int kDoubleBytes = 64;
#elif HRT_LANES_256
constexpr int kDoubleBytes = 32;
#else
constexpr int kDoubleBytes = 16;
#endif
constexpr int kFloatBytes = kDoubleBytes == 64 ? 32 : kDoubleBytes;

using DoubleRegister = double __attribute__((vector_size(kDoubleBytes)));
using LongRegister = std::int64_t __attribute__((vector_size(kDoubleBytes)));
using FloatRegister = float __attribute__((vector_size(kFloatBytes)));
using IntRegister = std::int32_t __attribute__((vector_size(kFloatBytes)));

// True or false, eight times: all bits of a lane are set, or none.
template <class Register>
struct MaskLanes
{
  static constexpr int kRegisters = kLanes * int(sizeof(Register{}[0])) / int(sizeof(Register));
  Register v[kRegisters];
};
template <class R>
HRT_INLINE MaskLanes<R> operator&(MaskLanes<R> a, const MaskLanes<R>& b)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] & b.v[i];
  }
  return a;
}
template <class R>
HRT_INLINE MaskLanes<R> operator|(MaskLanes<R> a, const MaskLanes<R>& b)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] | b.v[i];
  }
  return a;
}
template <class R>
HRT_INLINE MaskLanes<R> operator!(MaskLanes<R> a)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = ~a.v[i];
  }
  return a;
}
// The lanes that are true, as bits.
template <class R>
HRT_INLINE unsigned int bitsOf(const MaskLanes<R>& a)
{
  constexpr int perRegister = kLanes / MaskLanes<R>::kRegisters;
  unsigned int bits = 0;
  for (int i = 0; i < a.kRegisters; ++i)
  {
#if HRT_LANES_512
    if constexpr (sizeof(R) == 64)
    {
      bits |= _cvtmask8_u32(_mm512_movepi64_mask((__m512i)a.v[i]));
      continue;
    }
#endif
#if HRT_LANES_256
    if constexpr (sizeof(R) == 32 && perRegister == 8)
    {
      bits |= static_cast<unsigned int>(_mm256_movemask_ps((__m256)a.v[i]));
      continue;
    }
    if constexpr (sizeof(R) == 32 && perRegister == 4)
    {
      bits |= static_cast<unsigned int>(_mm256_movemask_pd((__m256d)a.v[i])) << (4 * i);
      continue;
    }
#endif
    for (int k = 0; k < perRegister && sizeof(R) == 16; ++k)
    {
      bits |= a.v[i][k] != 0 ? 1u << (i * perRegister + k) : 0u;
    }
  }
  return bits;
}
template <class R>
HRT_INLINE bool any(const MaskLanes<R>& a)
{
  return bitsOf(a) != 0;
}

// `Register`: of numbers of type T; `Bits`: of as many whole numbers of the same size.
template <class T, class Register, class Bits>
struct NumberLanes
{
  using Number = T;
  using Mask = MaskLanes<Bits>;
  static constexpr int kRegisters = Mask::kRegisters;
  Register v[kRegisters];

  NumberLanes() = default;
  HRT_INLINE explicit NumberLanes(T a)
  {
    for (int i = 0; i < kRegisters; ++i)
    {
      this->v[i] = a - Register{}; // a - 0 is a, its sign included
    }
  }
  // At an address that is aligned to the size of all lanes.
  HRT_INLINE static NumberLanes load(const T* from)
  {
    NumberLanes a;
    std::memcpy(&a, __builtin_assume_aligned(from, kLanes * sizeof(T)), sizeof(a));
    return a;
  }
  HRT_INLINE void store(T* to) const
  {
    std::memcpy(__builtin_assume_aligned(to, kLanes * sizeof(T)), this, sizeof(*this));
  }
};

using Doubles = NumberLanes<double, DoubleRegister, LongRegister>;
using Floats = NumberLanes<float, FloatRegister, IntRegister>;

#define HRT_LANE_OPERATION(op)                                                                     \
  template <class T, class R, class B>                                                             \
  HRT_INLINE NumberLanes<T, R, B> operator op(                                                     \
    NumberLanes<T, R, B> a, const NumberLanes<T, R, B>& b)                                         \
  {                                                                                                \
    for (int i = 0; i < a.kRegisters; ++i)                                                         \
    {                                                                                              \
      a.v[i] = a.v[i] op b.v[i];                                                                   \
    }                                                                                              \
    return a;                                                                                      \
  }
HRT_LANE_OPERATION(+)
HRT_LANE_OPERATION(-)
HRT_LANE_OPERATION(*)
HRT_LANE_OPERATION(/)
#undef HRT_LANE_OPERATION

template <class T, class R, class B>
HRT_INLINE NumberLanes<T, R, B> operator-(NumberLanes<T, R, B> a)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = -a.v[i];
  }
  return a;
}

// False where one of them is not a number.
#define HRT_LANE_COMPARISON(op)                                                                    \
  template <class T, class R, class B>                                                             \
  HRT_INLINE MaskLanes<B> operator op(                                                             \
    const NumberLanes<T, R, B>& a, const NumberLanes<T, R, B>& b)                                  \
  {                                                                                                \
    MaskLanes<B> m;                                                                                \
    for (int i = 0; i < a.kRegisters; ++i)                                                         \
    {                                                                                              \
      m.v[i] = a.v[i] op b.v[i];                                                                   \
    }                                                                                              \
    return m;                                                                                      \
  }
HRT_LANE_COMPARISON(<)
HRT_LANE_COMPARISON(<=)
HRT_LANE_COMPARISON(>)
HRT_LANE_COMPARISON(>=)
HRT_LANE_COMPARISON(==)
#undef HRT_LANE_COMPARISON

// `a` where the mask is true, elsewhere `b`.
template <class T, class R, class B>
HRT_INLINE NumberLanes<T, R, B> select(
  const MaskLanes<B>& mask, NumberLanes<T, R, B> a, const NumberLanes<T, R, B>& b)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = (R)(((B)a.v[i] & mask.v[i]) | ((B)b.v[i] & ~mask.v[i]));
  }
  return a;
}

// Of equal numbers, and where one is not a number, as std::min and std::max.
template <class T, class R, class B>
HRT_INLINE NumberLanes<T, R, B> min(const NumberLanes<T, R, B>& a, const NumberLanes<T, R, B>& b)
{
  NumberLanes<T, R, B> m;
  for (int i = 0; i < a.kRegisters; ++i)
  {
    m.v[i] = b.v[i] < a.v[i] ? b.v[i] : a.v[i];
  }
  return m;
}
template <class T, class R, class B>
HRT_INLINE NumberLanes<T, R, B> max(const NumberLanes<T, R, B>& a, const NumberLanes<T, R, B>& b)
{
  NumberLanes<T, R, B> m;
  for (int i = 0; i < a.kRegisters; ++i)
  {
    m.v[i] = a.v[i] < b.v[i] ? b.v[i] : a.v[i];
  }
  return m;
}
template <class L>
HRT_INLINE L clamp(const L& a, const L& least, const L& most)
{
  return min(max(a, least), most);
}
template <class T, class R, class B>
HRT_INLINE NumberLanes<T, R, B> abs(NumberLanes<T, R, B> a)
{
  using Whole = decltype(B{}[0] + 0);
  constexpr Whole sign = Whole(1) << (8 * sizeof(T) - 1);
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = (R)((B)a.v[i] & ~sign);
  }
  return a;
}
// 1, 0 or -1 as the number is.
template <class T, class R, class B>
HRT_INLINE NumberLanes<T, R, B> sign(const NumberLanes<T, R, B>& a)
{
  using L = NumberLanes<T, R, B>;
  const L zero(T(0));
  return select(zero < a, L(T(1)), select(a < zero, L(T(-1)), zero));
}
// Of a number from 0 to 2^51.
HRT_INLINE Doubles floorOfCount(const Doubles& a)
{
  const Doubles shift(0x1p52), nearest = (a + shift) - shift;
  return select(nearest > a, nearest - Doubles(1.0), nearest);
}

HRT_INLINE Doubles sqrt(Doubles a)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
#if HRT_LANES_512
    a.v[i] = (DoubleRegister)_mm512_maskz_sqrt_pd(0xff, (__m512d)a.v[i]);
#elif HRT_LANES_256
    a.v[i] = (DoubleRegister)_mm256_sqrt_pd((__m256d)a.v[i]);
#elif defined(__SSE2__)
    a.v[i] = (DoubleRegister)_mm_sqrt_pd((__m128d)a.v[i]);
#else
    for (int k = 0; k < kDoubleBytes / 8; ++k)
    {
      a.v[i][k] = __builtin_sqrt(a.v[i][k]);
    }
#endif
  }
  return a;
}
HRT_INLINE Floats sqrt(Floats a)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
#if HRT_LANES_256
    a.v[i] = (FloatRegister)_mm256_sqrt_ps((__m256)a.v[i]);
#elif defined(__SSE2__)
    a.v[i] = (FloatRegister)_mm_sqrt_ps((__m128)a.v[i]);
#else
    for (int k = 0; k < kFloatBytes / 4; ++k)
    {
      a.v[i][k] = __builtin_sqrtf(a.v[i][k]);
    }
#endif
  }
  return a;
}

// a * b + c, rounded once.
HRT_INLINE Doubles fused(Doubles a, const Doubles& b, const Doubles& c)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
#if HRT_LANES_512
    a.v[i] = (DoubleRegister)_mm512_fmadd_pd((__m512d)a.v[i], (__m512d)b.v[i], (__m512d)c.v[i]);
#elif HRT_LANES_256
    a.v[i] = (DoubleRegister)_mm256_fmadd_pd((__m256d)a.v[i], (__m256d)b.v[i], (__m256d)c.v[i]);
#else
    for (int k = 0; k < kDoubleBytes / 8; ++k)
    {
      a.v[i][k] = __builtin_fma(a.v[i][k], b.v[i][k], c.v[i][k]);
    }
#endif
  }
  return a;
}

HRT_INLINE Floats toFloats(const Doubles& a)
{
#if HRT_LANES_512
  Floats f;
  f.v[0] = (FloatRegister)_mm512_maskz_cvtpd_ps(0xff, (__m512d)a.v[0]);
  return f;
#else
  alignas(64) double from[kLanes];
  alignas(64) float to[kLanes];
  a.store(from);
  for (int i = 0; i < kLanes; ++i)
  {
    to[i] = static_cast<float>(from[i]);
  }
  return Floats::load(to);
#endif
}
HRT_INLINE Doubles toDoubles(const Floats& a)
{
#if HRT_LANES_512
  Doubles d;
  d.v[0] = (DoubleRegister)_mm512_maskz_cvtps_pd(0xff, (__m256)a.v[0]);
  return d;
#else
  alignas(64) float from[kLanes];
  alignas(64) double to[kLanes];
  a.store(from);
  for (int i = 0; i < kLanes; ++i)
  {
    to[i] = static_cast<double>(from[i]);
  }
  return Doubles::load(to);
#endif
}

// The bits of doubles as whole numbers, for what takes numbers apart.
using Wholes = MaskLanes<LongRegister>;
HRT_INLINE Wholes wholeBits(const Doubles& a)
{
  Wholes w;
  std::memcpy(&w, &a, sizeof(w));
  return w;
}
HRT_INLINE Doubles fromWholeBits(const Wholes& w)
{
  Doubles a;
  std::memcpy(&a, &w, sizeof(a));
  return a;
}
HRT_INLINE Wholes operator+(Wholes a, std::int64_t b)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] + b;
  }
  return a;
}
HRT_INLINE Wholes operator&(Wholes a, std::int64_t b)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] & b;
  }
  return a;
}
HRT_INLINE Wholes operator|(Wholes a, std::int64_t b)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] | b;
  }
  return a;
}
// Of numbers that are not negative.
HRT_INLINE Wholes operator>>(Wholes a, int bits)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] >> bits;
  }
  return a;
}
HRT_INLINE Wholes raised(Wholes a, int bits)
{
  for (int i = 0; i < a.kRegisters; ++i)
  {
    a.v[i] = a.v[i] << bits;
  }
  return a;
}

// A vector of three, as GLSL and GLM have it; sums in GLM's order.
template <class L>
struct VectorLanes
{
  L x, y, z;

  VectorLanes() = default;
  HRT_INLINE explicit VectorLanes(const L& all)
    : x(all)
    , y(all)
    , z(all)
  {
  }
  HRT_INLINE VectorLanes(const L& a, const L& b, const L& c)
    : x(a)
    , y(b)
    , z(c)
  {
  }
  using Number = typename L::Number;
  HRT_INLINE static VectorLanes load(const Number (&from)[3][kLanes])
  {
    return { L::load(from[0]), L::load(from[1]), L::load(from[2]) };
  }
  HRT_INLINE static VectorLanes broadcast(const Number* from)
  {
    return { L(from[0]), L(from[1]), L(from[2]) };
  }
  HRT_INLINE void store(Number (&to)[3][kLanes]) const
  {
    this->x.store(to[0]);
    this->y.store(to[1]);
    this->z.store(to[2]);
  }
};
#define HRT_VECTOR_OPERATION(op)                                                                   \
  template <class L>                                                                               \
  HRT_INLINE VectorLanes<L> operator op(const VectorLanes<L>& a, const VectorLanes<L>& b)          \
  {                                                                                                \
    return { a.x op b.x, a.y op b.y, a.z op b.z };                                                 \
  }
HRT_VECTOR_OPERATION(+)
HRT_VECTOR_OPERATION(-)
HRT_VECTOR_OPERATION(*)
#undef HRT_VECTOR_OPERATION
template <class L>
HRT_INLINE VectorLanes<L> operator-(const VectorLanes<L>& a)
{
  return { -a.x, -a.y, -a.z };
}
template <class L>
HRT_INLINE VectorLanes<L> operator*(const VectorLanes<L>& a, const L& b)
{
  return { a.x * b, a.y * b, a.z * b };
}
template <class L>
HRT_INLINE VectorLanes<L> operator*(const L& a, const VectorLanes<L>& b)
{
  return { a * b.x, a * b.y, a * b.z };
}
template <class L>
HRT_INLINE VectorLanes<L> operator/(const VectorLanes<L>& a, const L& b)
{
  return { a.x / b, a.y / b, a.z / b };
}
template <class L>
HRT_INLINE L dot(const VectorLanes<L>& a, const VectorLanes<L>& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class L>
HRT_INLINE VectorLanes<L> cross(const VectorLanes<L>& a, const VectorLanes<L>& b)
{
  return { a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y };
}
template <class L>
HRT_INLINE L length(const VectorLanes<L>& a)
{
  return sqrt(dot(a, a));
}
template <class L>
HRT_INLINE VectorLanes<L> normalize(const VectorLanes<L>& a)
{
  return a * (L(typename L::Number(1)) / sqrt(dot(a, a)));
}
template <class L>
HRT_INLINE VectorLanes<L> reflect(const VectorLanes<L>& incident, const VectorLanes<L>& normal)
{
  return incident - normal * dot(normal, incident) * L(typename L::Number(2));
}
template <class Mask, class L>
HRT_INLINE VectorLanes<L> select(
  const Mask& mask, const VectorLanes<L>& a, const VectorLanes<L>& b)
{
  return { select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z) };
}
HRT_INLINE VectorLanes<Floats> toFloats(const VectorLanes<Doubles>& a)
{
  return { toFloats(a.x), toFloats(a.y), toFloats(a.z) };
}
HRT_INLINE VectorLanes<Doubles> toDoubles(const VectorLanes<Floats>& a)
{
  return { toDoubles(a.x), toDoubles(a.y), toDoubles(a.z) };
}

} // namespace HRT_LANES_NAMESPACE
} // namespace hrt
