// Eight floats as one value: a register of AVX2, or two of any vector unit that the compiler knows.
// And what a packet's rays are taken in, RayFloats: the same, or the sixteen of an AVX-512
// register. Included once for each instruction set (BvhKernels.cpp).

#define HRT_LANES HRT_TARGET inline __attribute__((always_inline))

#if HRT_AVX2

struct Floats
{
  static constexpr unsigned int kLanes = 8;
  __m256 v;

  HRT_LANES static Floats broadcast(float a) { return { _mm256_set1_ps(a) }; }
};
HRT_LANES Floats load(const float* p)
{
  return { _mm256_load_ps(p) };
}
HRT_LANES void store(float* p, Floats a)
{
  _mm256_store_ps(p, a.v);
}
HRT_LANES Floats operator+(Floats a, Floats b)
{
  return { _mm256_add_ps(a.v, b.v) };
}
HRT_LANES Floats operator-(Floats a, Floats b)
{
  return { _mm256_sub_ps(a.v, b.v) };
}
HRT_LANES Floats operator*(Floats a, Floats b)
{
  return { _mm256_mul_ps(a.v, b.v) };
}
// a * b - c, c - a * b and a * b + c, rounded once or twice
HRT_LANES Floats mulSub(Floats a, Floats b, Floats c)
{
  return { _mm256_fmsub_ps(a.v, b.v, c.v) };
}
HRT_LANES Floats subMul(Floats c, Floats a, Floats b)
{
  return { _mm256_fnmadd_ps(a.v, b.v, c.v) };
}
HRT_LANES Floats mulAdd(Floats a, Floats b, Floats c)
{
  return { _mm256_fmadd_ps(a.v, b.v, c.v) };
}
HRT_LANES Floats min(Floats a, Floats b)
{
  return { _mm256_min_ps(a.v, b.v) };
}
HRT_LANES Floats max(Floats a, Floats b)
{
  return { _mm256_max_ps(a.v, b.v) };
}
HRT_LANES Floats size(Floats a)
{
  return { _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v) };
}
// The lanes, as bits, where a < b (a <= b); a NaN is neither.
HRT_LANES unsigned int less(Floats a, Floats b)
{
  return static_cast<unsigned int>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
}
HRT_LANES unsigned int lessEqual(Floats a, Floats b)
{
  return static_cast<unsigned int>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
// The lanes, as bits, of eight whole numbers that are `a`; at an address aligned as Floats are.
HRT_LANES unsigned int equal(const std::uint32_t* p, std::uint32_t a)
{
  const __m256i same = _mm256_cmpeq_epi32(
    _mm256_load_si256(reinterpret_cast<const __m256i*>(p)), _mm256_set1_epi32(static_cast<int>(a)));
  return static_cast<unsigned int>(_mm256_movemask_ps(_mm256_castsi256_ps(same)));
}
// The lanes from eight places, `offset` from each.
HRT_LANES Floats gather(const float* const (&from)[Floats::kLanes], std::ptrdiff_t offset)
{
  return { _mm256_setr_ps(from[0][offset], from[1][offset], from[2][offset], from[3][offset],
    from[4][offset], from[5][offset], from[6][offset], from[7][offset]) };
}
// `a` in the lanes of the bits, in the others `b`.
HRT_LANES Floats where(unsigned int bits, Floats a, Floats b)
{
  const __m256i ones = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i chosen =
    _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), ones), ones);
  return { _mm256_blendv_ps(b.v, a.v, _mm256_castsi256_ps(chosen)) };
}
// The smallest lane.
HRT_LANES float minLane(Floats a)
{
  __m128 half = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  half = _mm_min_ps(half, _mm_movehl_ps(half, half));
  return _mm_cvtss_f32(_mm_min_ss(half, _mm_movehdup_ps(half)));
}

#else

using Quad = float __attribute__((vector_size(16)));
using QuadMask = std::int32_t __attribute__((vector_size(16)));
struct Floats
{
  static constexpr unsigned int kLanes = 8;
  Quad v[2];

  HRT_LANES static Floats broadcast(float a)
  {
    const Quad quad = { a, a, a, a };
    return { { quad, quad } };
  }
};
HRT_LANES Floats load(const float* p)
{
  Floats a;
  std::memcpy(&a, p, sizeof(a));
  return a;
}
HRT_LANES void store(float* p, Floats a)
{
  std::memcpy(p, &a, sizeof(a));
}
HRT_LANES Floats operator+(Floats a, Floats b)
{
  return { { a.v[0] + b.v[0], a.v[1] + b.v[1] } };
}
HRT_LANES Floats operator-(Floats a, Floats b)
{
  return { { a.v[0] - b.v[0], a.v[1] - b.v[1] } };
}
HRT_LANES Floats operator*(Floats a, Floats b)
{
  return { { a.v[0] * b.v[0], a.v[1] * b.v[1] } };
}
// a * b - c, c - a * b and a * b + c, rounded once or twice
HRT_LANES Floats mulSub(Floats a, Floats b, Floats c)
{
  return a * b - c;
}
HRT_LANES Floats subMul(Floats c, Floats a, Floats b)
{
  return c - a * b;
}
HRT_LANES Floats mulAdd(Floats a, Floats b, Floats c)
{
  return a * b + c;
}
HRT_LANES Quad min(Quad a, Quad b)
{
  return a < b ? a : b;
}
HRT_LANES Quad max(Quad a, Quad b)
{
  return a > b ? a : b;
}
HRT_LANES Floats min(Floats a, Floats b)
{
  return { { min(a.v[0], b.v[0]), min(a.v[1], b.v[1]) } };
}
HRT_LANES Floats max(Floats a, Floats b)
{
  return { { max(a.v[0], b.v[0]), max(a.v[1], b.v[1]) } };
}
HRT_LANES Floats size(Floats a)
{
  return max(a, Floats::broadcast(0.0f) - a);
}
HRT_LANES unsigned int bits(QuadMask a, QuadMask b)
{
  const QuadMask ones = { 1, 2, 4, 8 };
  const QuadMask m = (a & ones) | (b & (ones << 4));
  return static_cast<unsigned int>((m[0] | m[1]) | (m[2] | m[3]));
}
// The lanes, as bits, where a < b (a <= b); a NaN is neither.
HRT_LANES unsigned int less(Floats a, Floats b)
{
  return bits(a.v[0] < b.v[0], a.v[1] < b.v[1]);
}
HRT_LANES unsigned int lessEqual(Floats a, Floats b)
{
  return bits(a.v[0] <= b.v[0], a.v[1] <= b.v[1]);
}
// The lanes, as bits, of eight whole numbers that are `a`.
HRT_LANES unsigned int equal(const std::uint32_t* p, std::uint32_t a)
{
  unsigned int same = 0;
  for (unsigned int i = 0; i < Floats::kLanes; ++i)
  {
    same |= p[i] == a ? 1u << i : 0u;
  }
  return same;
}
// The lanes from eight places, `offset` from each.
HRT_LANES Floats gather(const float* const (&from)[Floats::kLanes], std::ptrdiff_t offset)
{
  const Quad lower = { from[0][offset], from[1][offset], from[2][offset], from[3][offset] };
  const Quad upper = { from[4][offset], from[5][offset], from[6][offset], from[7][offset] };
  return { { lower, upper } };
}
// `a` in the lanes of the bits, in the others `b`.
HRT_LANES Floats where(unsigned int chosen, Floats a, Floats b)
{
  const QuadMask ones = { 1, 2, 4, 8 };
  const QuadMask every = ones - ones + static_cast<std::int32_t>(chosen);
  return { { (every & ones) != 0 ? a.v[0] : b.v[0],
    (every & (ones << 4)) != 0 ? a.v[1] : b.v[1] } };
}
// The smallest lane.
HRT_LANES float minLane(Floats a)
{
  const Quad four = min(a.v[0], a.v[1]);
  return std::min(std::min(four[0], four[1]), std::min(four[2], four[3]));
}

#endif

#if HRT_AVX512

struct RayFloats
{
  static constexpr unsigned int kLanes = 16;
  __m512 v;

  HRT_LANES static RayFloats broadcast(float a) { return { _mm512_set1_ps(a) }; }
};
HRT_LANES RayFloats loadRays(const float* p)
{
  return { _mm512_load_ps(p) };
}
HRT_LANES void store(float* p, RayFloats a)
{
  _mm512_store_ps(p, a.v);
}
HRT_LANES RayFloats operator+(RayFloats a, RayFloats b)
{
  return { _mm512_add_ps(a.v, b.v) };
}
HRT_LANES RayFloats operator-(RayFloats a, RayFloats b)
{
  return { _mm512_sub_ps(a.v, b.v) };
}
HRT_LANES RayFloats operator*(RayFloats a, RayFloats b)
{
  return { _mm512_mul_ps(a.v, b.v) };
}
HRT_LANES RayFloats mulSub(RayFloats a, RayFloats b, RayFloats c)
{
  return { _mm512_fmsub_ps(a.v, b.v, c.v) };
}
HRT_LANES RayFloats subMul(RayFloats c, RayFloats a, RayFloats b)
{
  return { _mm512_fnmadd_ps(a.v, b.v, c.v) };
}
HRT_LANES RayFloats mulAdd(RayFloats a, RayFloats b, RayFloats c)
{
  return { _mm512_fmadd_ps(a.v, b.v, c.v) };
}
// GCC 12 warns of the unmasked ones that their own header leaves something uninitialised.
HRT_LANES RayFloats min(RayFloats a, RayFloats b)
{
  return { _mm512_maskz_min_ps(0xffff, a.v, b.v) };
}
HRT_LANES RayFloats max(RayFloats a, RayFloats b)
{
  return { _mm512_maskz_max_ps(0xffff, a.v, b.v) };
}
HRT_LANES RayFloats size(RayFloats a)
{
  return { _mm512_abs_ps(a.v) };
}
HRT_LANES unsigned int less(RayFloats a, RayFloats b)
{
  return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ);
}
HRT_LANES unsigned int lessEqual(RayFloats a, RayFloats b)
{
  return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ);
}
HRT_LANES RayFloats where(unsigned int bits, RayFloats a, RayFloats b)
{
  return { _mm512_mask_blend_ps(static_cast<__mmask16>(bits), b.v, a.v) };
}
HRT_LANES float minLane(RayFloats a)
{
  return minLane(min(Floats{ _mm512_maskz_extractf32x8_ps(0xff, a.v, 0) },
    Floats{ _mm512_maskz_extractf32x8_ps(0xff, a.v, 1) }));
}

#else
using RayFloats = Floats;
HRT_LANES RayFloats loadRays(const float* p)
{
  return load(p);
}
#endif

HRT_LANES Floats broadcast(float a)
{
  return Floats::broadcast(a);
}
HRT_LANES RayFloats broadcastRays(float a)
{
  return RayFloats::broadcast(a);
}

HRT_LANES float maxLane(RayFloats a)
{
  return -minLane(broadcastRays(0.0f) - a);
}

// The numbers of the bits, in order. Up to kPacket of them are written whatever their count.
HRT_LANES void appendBits(unsigned int bits, std::uint32_t* to)
{
#if HRT_AVX512
  const __m512i numbers = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), numbers));
#else
  for (; bits != 0; bits &= bits - 1)
  {
    *to++ = static_cast<std::uint32_t>(__builtin_ctz(bits));
  }
#endif
}
