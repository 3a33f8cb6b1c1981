// Compiles the kernels for the compiler's own target and, where that is x86-64, for AVX2.
#include "Rendering/Core/Structures/EmbreeKernels.h"

#include "Rendering/Core/Structures/Candidates.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#define HRT_KERNELS narrow
#define HRT_AVX2 0
#define HRT_TARGET
#include "Rendering/Core/Structures/EmbreeKernels.inl"
#undef HRT_KERNELS
#undef HRT_AVX2
#undef HRT_TARGET

#if defined(__GNUC__) && defined(__x86_64__)
#include <immintrin.h>
#define HRT_KERNELS wide
#define HRT_AVX2 1
#define HRT_TARGET __attribute__((target("avx2,fma")))
#include "Rendering/Core/Structures/EmbreeKernels.inl"
#else
namespace hrt
{
namespace embree
{
namespace wide = narrow;
}
}
#endif

namespace hrt
{
namespace embree
{

const Kernels& kernelsFor(bool wide)
{
  static const Kernels both[] = { { &narrow::nearest, &narrow::any, &narrow::nearestOfPacket,
                                    &narrow::anyOfPacket },
    { &wide::nearest, &wide::any, &wide::nearestOfPacket, &wide::anyOfPacket } };
  return both[wide ? 1 : 0];
}

} // namespace embree
} // namespace hrt
