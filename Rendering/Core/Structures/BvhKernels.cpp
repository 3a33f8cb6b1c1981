// Compiles the kernels for the compiler's own target and, where that is x86-64, for AVX2 and
// AVX-512.
#include "Rendering/Core/Structures/BvhKernels.h"

#include "Rendering/Core/Structures/ExactLanes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#define HRT_KERNELS base
#define HRT_SET InstructionSet::Base
#define HRT_AVX2 0
#define HRT_AVX512 0
#define HRT_TARGET
#include "Rendering/Core/Structures/BvhKernels.inl"
#undef HRT_KERNELS
#undef HRT_SET
#undef HRT_AVX2
#undef HRT_AVX512
#undef HRT_TARGET

#if defined(__GNUC__) && defined(__x86_64__)
#include <immintrin.h>

#define HRT_KERNELS avx2
#define HRT_SET InstructionSet::Avx2
#define HRT_AVX2 1
#define HRT_AVX512 0
#define HRT_TARGET __attribute__((target("avx2,fma")))
#include "Rendering/Core/Structures/BvhKernels.inl"
#undef HRT_KERNELS
#undef HRT_SET
#undef HRT_AVX512
#undef HRT_TARGET

#define HRT_KERNELS avx512
#define HRT_SET InstructionSet::Avx512
#define HRT_AVX512 1
#define HRT_TARGET __attribute__((target("avx512f,avx512vl,avx512dq,avx2,fma")))
#include "Rendering/Core/Structures/BvhKernels.inl"
#else
namespace hrt
{
namespace bvh
{
namespace avx2 = base;
namespace avx512 = base;
}
}
#endif

namespace hrt
{
namespace bvh
{

const Kernels& kernelsFor(InstructionSet set)
{
  static const Kernels all[] = {
    { &base::nearest, &base::any, &base::nearestOfPacket, &base::anyOfPacket },
    { &avx2::nearest, &avx2::any, &avx2::nearestOfPacket, &avx2::anyOfPacket },
    { &avx512::nearest, &avx512::any, &avx512::nearestOfPacket, &avx512::anyOfPacket },
  };
  return all[static_cast<std::size_t>(set)];
}

} // namespace bvh
} // namespace hrt
