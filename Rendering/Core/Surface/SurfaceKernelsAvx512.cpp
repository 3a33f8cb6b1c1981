// The kernels for one instruction set: see CMakeLists.txt for the compiler's options.
#define HRT_LANES_NAMESPACE lanes_avx512
#define HRT_KERNEL_TABLE kSurfaceKernelsAvx512
#include "Rendering/Core/Surface/SurfaceLanes.h"
