// The ways of rays through both levels, for each instruction set that they are compiled for. Which
// one runs changes the time and nothing else.
#pragma once

#include "Rendering/Core/Structures/EmbreeTopLevel.h"

namespace hrt
{
namespace embree
{

// Rays that are traversed together at most.
inline constexpr unsigned int kPacket = 16;

struct Kernels
{
  void (*nearest)(const TopLevel& scene, Search& search);
  void (*any)(const TopLevel& scene, Search& search);
  // The same for up to kPacket rays.
  void (*nearestOfPacket)(const TopLevel& scene, Search* searches, unsigned int count);
  void (*anyOfPacket)(const TopLevel& scene, Search* searches, unsigned int count);
};

// `wide`: the processor has AVX2 and fused operations.
const Kernels& kernelsFor(bool wide);

} // namespace embree
} // namespace hrt
