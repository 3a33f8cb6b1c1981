// The instruction sets that the hottest code is compiled for, each time from the same source. Which
// one runs changes the time and nothing else.
#pragma once

#include <cstdint>

namespace hrt
{

// Of functions in headers that every such copy is to take in, compiled for its own set.
#if defined(__GNUC__)
#define HRT_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define HRT_ALWAYS_INLINE inline
#endif

enum class InstructionSet : std::uint8_t
{
  Base,  // the compiler's own target
  Avx2,  // with fused operations
  Avx512 // F, VL and DQ, and all of Avx2
};

} // namespace hrt
