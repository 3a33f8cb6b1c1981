// How a picture is cut into tiles, and in which order a tile's rays go through the structure: in blocks of
// neighbours, which packets gain from.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace hrt
{

// Samples along a tile's side: a few hundred rays of a kind, enough to fill packets, little enough for
// a tile's queues to stay in the cache.
constexpr int kTile = 32;

// Pixels along a side of the blocks whose rays are neighbours in a stream: 16 rays, one packet.
constexpr int kBlock = 4;

constexpr int tilesAlong(int samples)
{
  return (samples + kTile - 1) / kTile;
}

// Calls visit(x, y) for 0 <= x < width, 0 <= y < height, block by block.
template <class Visit>
void forEachInBlocks(int width, int height, Visit visit)
{
  for (int by = 0; by < height; by += kBlock)
  {
    for (int bx = 0; bx < width; bx += kBlock)
    {
      for (int y = by; y < std::min(by + kBlock, height); ++y)
      {
        for (int x = bx; x < std::min(bx + kBlock, width); ++x)
        {
          visit(x, y);
        }
      }
    }
  }
}

// Numbers of the pixels of one tile, row 0 at the bottom, in the order of their rays.
inline void tilePixels(
  const Camera& camera, int tileColumn, int tileRow, std::vector<std::uint32_t>& pixels)
{
  const int left = tileColumn * kTile, bottom = tileRow * kTile;
  pixels.clear();
  forEachInBlocks(std::min(kTile, camera.width - left), std::min(kTile, camera.height - bottom),
    [&](int x, int y) {
      pixels.push_back(static_cast<std::uint32_t>((bottom + y) * camera.width + left + x));
    });
}

} // namespace hrt
