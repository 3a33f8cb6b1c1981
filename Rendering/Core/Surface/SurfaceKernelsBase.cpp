// The kernels for one instruction set: see CMakeLists.txt for the compiler's options.
#define HRT_LANES_NAMESPACE lanes_base
#define HRT_KERNEL_TABLE kSurfaceKernelsBase
#include "Rendering/Core/Surface/SurfaceLanes.h"
