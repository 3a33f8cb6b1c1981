// The ways of rays through both levels, for each instruction set that they are compiled for.
#pragma once

#include "Rendering/Core/Structures/BvhTopLevel.h"
#include "Rendering/Core/Structures/InstructionSet.h"

namespace hrt
{
namespace bvh
{

// Rays that are traversed together at most.
inline constexpr unsigned int kPacket = 16;

struct Kernels
{
  void (*nearest)(const TopLevel& scene, Search& search);
  void (*any)(const TopLevel& scene, Search& search);
  // The same for one to kPacket rays: hits[i], or occluded[i], is what rays[i] finds.
  void (*nearestOfPacket)(const TopLevel& scene, const Ray* rays, Hit* hits, unsigned int count);
  void (*anyOfPacket)(
    const TopLevel& scene, const Ray* rays, std::uint8_t* occluded, unsigned int count);
};

// One that the processor has.
const Kernels& kernelsFor(InstructionSet set);

} // namespace bvh
} // namespace hrt
