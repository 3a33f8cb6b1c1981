// A number that tells whether two pixels saw the same things: a sum of one mixed value for each event on a
// pixel's paths - a surface reached, the background, a light seen or hidden. The sum does not depend on
// the order of the events. Interleaved rendering interpolates between samples of one signature only.
#pragma once

#include <cstdint>

namespace hrt
{

using PathSignature = std::uint64_t;

enum class PathEvent : std::uint8_t
{
  SeenDirectly, // index: the part; outcome: 1 on its front side
  Reflected,    // likewise, the last bounce a reflection
  Refracted,
  Background,
  Light,        // index: the light; outcome: 1 it arrives, 0 it does not, 2 in part
  Veil          // a translucent part on a shadow ray; index: the part
};

// The finaliser of the generator SplitMix64 (Guy Steele, Doug Lea, Christine Flood: "Fast Splittable
// Pseudorandom Number Generators", OOPSLA 2014): every bit of the event reaches every bit of the value, so
// that different sums of events are equal by chance about once in 2^64.
inline PathSignature signatureOf(
  PathEvent event, int bounces, std::uint64_t index, unsigned outcome)
{
  std::uint64_t z = (index << 16 | std::uint64_t(outcome) << 12 | std::uint64_t(bounces) << 4 |
                      std::uint64_t(event)) +
    0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

} // namespace hrt
