// How a picture is cut into tiles, and in which order a tile's rays go through the structure: in blocks of
// neighbours, which packets gain from.
#pragma once

#include <algorithm>

namespace hrt
{

// Samples along a tile's side: a few hundred rays of a kind, enough to fill packets, little enough for
// a tile's queues to stay in the cache.
constexpr int kTile = 32;

// Pixels along a side of the blocks whose rays are neighbours in a stream: 16 rays, one packet.
constexpr int kBlock = 4;

// The range of samples of one tile along one axis, of those in [begin, end). The grid of tiles is that
// of the whole picture whatever the range.
struct TileSpan
{
  TileSpan(int tile, int begin, int end)
    : first(std::max(tile * kTile, begin))
    , count(std::min((tile + 1) * kTile, end) - first)
  {
  }
  int first;
  int count;
};

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

} // namespace hrt
