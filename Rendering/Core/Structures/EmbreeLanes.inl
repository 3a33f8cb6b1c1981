// Eight floats as one value: a register of AVX2, or two of any vector unit that the compiler knows.
// Included once for each instruction set (EmbreeKernels.cpp).

#define HRT_LANES HRT_TARGET inline __attribute__((always_inline))

#if HRT_AVX2

struct Floats
{
  __m256 v;
};
HRT_LANES Floats load(const float* p) { return { _mm256_load_ps(p) }; }
HRT_LANES void store(float* p, Floats a) { _mm256_store_ps(p, a.v); }
HRT_LANES Floats all(float a) { return { _mm256_set1_ps(a) }; }
HRT_LANES Floats operator+(Floats a, Floats b) { return { _mm256_add_ps(a.v, b.v) }; }
HRT_LANES Floats operator-(Floats a, Floats b) { return { _mm256_sub_ps(a.v, b.v) }; }
HRT_LANES Floats operator*(Floats a, Floats b) { return { _mm256_mul_ps(a.v, b.v) }; }
// a * b - c, c - a * b and a * b + c, rounded once or twice
HRT_LANES Floats mulSub(Floats a, Floats b, Floats c) { return { _mm256_fmsub_ps(a.v, b.v, c.v) }; }
HRT_LANES Floats subMul(Floats c, Floats a, Floats b) { return { _mm256_fnmadd_ps(a.v, b.v, c.v) }; }
HRT_LANES Floats mulAdd(Floats a, Floats b, Floats c) { return { _mm256_fmadd_ps(a.v, b.v, c.v) }; }
HRT_LANES Floats least(Floats a, Floats b) { return { _mm256_min_ps(a.v, b.v) }; }
HRT_LANES Floats most(Floats a, Floats b) { return { _mm256_max_ps(a.v, b.v) }; }
HRT_LANES Floats size(Floats a) { return { _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v) }; }
// The lanes, as bits, where a < b (a <= b); a NaN is neither.
HRT_LANES unsigned int less(Floats a, Floats b)
{
  return static_cast<unsigned int>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
}
HRT_LANES unsigned int lessEqual(Floats a, Floats b)
{
  return static_cast<unsigned int>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}

#else

using Quad = float __attribute__((vector_size(16)));
using QuadMask = std::int32_t __attribute__((vector_size(16)));
struct Floats
{
  Quad v[2];
};
HRT_LANES Floats load(const float* p)
{
  Floats a;
  std::memcpy(&a, p, sizeof(a));
  return a;
}
HRT_LANES void store(float* p, Floats a) { std::memcpy(p, &a, sizeof(a)); }
HRT_LANES Floats all(float a)
{
  const Quad quad = { a, a, a, a };
  return { { quad, quad } };
}
HRT_LANES Floats operator+(Floats a, Floats b) { return { { a.v[0] + b.v[0], a.v[1] + b.v[1] } }; }
HRT_LANES Floats operator-(Floats a, Floats b) { return { { a.v[0] - b.v[0], a.v[1] - b.v[1] } }; }
HRT_LANES Floats operator*(Floats a, Floats b) { return { { a.v[0] * b.v[0], a.v[1] * b.v[1] } }; }
// a * b - c, c - a * b and a * b + c, rounded once or twice
HRT_LANES Floats mulSub(Floats a, Floats b, Floats c) { return a * b - c; }
HRT_LANES Floats subMul(Floats c, Floats a, Floats b) { return c - a * b; }
HRT_LANES Floats mulAdd(Floats a, Floats b, Floats c) { return a * b + c; }
HRT_LANES Quad least(Quad a, Quad b) { return a < b ? a : b; }
HRT_LANES Quad most(Quad a, Quad b) { return a > b ? a : b; }
HRT_LANES Floats least(Floats a, Floats b)
{
  return { { least(a.v[0], b.v[0]), least(a.v[1], b.v[1]) } };
}
HRT_LANES Floats most(Floats a, Floats b)
{
  return { { most(a.v[0], b.v[0]), most(a.v[1], b.v[1]) } };
}
HRT_LANES Floats size(Floats a) { return most(a, all(0.0f) - a); }
HRT_LANES unsigned int bits(QuadMask a, QuadMask b)
{
  const QuadMask ones = { 1, 2, 4, 8 };
  const QuadMask m = (a & ones) | (b & (ones << 4));
  return static_cast<unsigned int>((m[0] | m[1]) | (m[2] | m[3]));
}
// The lanes, as bits, where a < b (a <= b); a NaN is neither.
HRT_LANES unsigned int less(Floats a, Floats b) { return bits(a.v[0] < b.v[0], a.v[1] < b.v[1]); }
HRT_LANES unsigned int lessEqual(Floats a, Floats b)
{
  return bits(a.v[0] <= b.v[0], a.v[1] <= b.v[1]);
}

#endif
