// The paper's multisampling (section 3.1): what becomes of a pixel whose own triangle, the one in the
// object intersection buffer, is not met by the pixel's ray. The rasteriser snaps corners to a grid and
// rounds depths, so along edges it may name a neighbour's triangle.
#pragma once

#include <cstdint>

namespace hrt
{

enum class Multisampling : std::uint8_t
{
  Off,     // the pixel stays without colour
  Clamp,   // the hit of the triangle's plane is moved onto the triangle
  Lazy3x3, // the triangles of the neighbouring pixels are tried, then their colours interpolated
  Lazy5x5,
  Full3x3, // as Lazy, but for every pixel, whether its own triangle is met or not: the nearest wins
  Full5x5
};

// Pixels to each side whose triangles are tried.
constexpr int reachOf(Multisampling mode)
{
  switch (mode)
  {
    case Multisampling::Lazy3x3:
    case Multisampling::Full3x3:
      return 1;
    case Multisampling::Lazy5x5:
    case Multisampling::Full5x5:
      return 2;
    case Multisampling::Off:
    case Multisampling::Clamp:
      break;
  }
  return 0;
}

// How far away the ids and samples may lie that a pixel's colour depends on. A pixel whose triangle is
// missed takes the mean of others within the reach; each of these is interpolated between samples up to
// interleave - 1 pixels away; and a sample tries the triangles within its reach.
constexpr int pixelsAround(Multisampling mode, int interleave)
{
  return 2 * reachOf(mode) + interleave - 1;
}

constexpr bool testsAlways(Multisampling mode)
{
  return mode == Multisampling::Full3x3 || mode == Multisampling::Full5x5;
}

} // namespace hrt
