// Chooses the kernels.
#include "Rendering/Core/Surface/SurfaceKernels.h"

namespace hrt
{

extern const SurfaceKernels kSurfaceKernelsBase;
#if defined(HRT_WIDE_KERNELS)
extern const SurfaceKernels kSurfaceKernelsAvx2;
extern const SurfaceKernels kSurfaceKernelsAvx512;
#endif

const SurfaceKernels& surfaceKernelsFor(InstructionSet set)
{
#if defined(HRT_WIDE_KERNELS)
  switch (set)
  {
    case InstructionSet::Avx512:
      return kSurfaceKernelsAvx512;
    case InstructionSet::Avx2:
      return kSurfaceKernelsAvx2;
    case InstructionSet::Base:
      break;
  }
#endif
  (void)set;
  return kSurfaceKernelsBase;
}

InstructionSet bestInstructionSet()
{
#if defined(HRT_WIDE_KERNELS)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
  {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq")
      ? InstructionSet::Avx512
      : InstructionSet::Avx2;
  }
#endif
  return InstructionSet::Base;
}

} // namespace hrt
