// Interleaved rendering (paper, section 3.1): only every n-th column and row of pixels is traced, the rest
// is interpolated between these samples in a second pass. The paper's plain interpolation blurs whatever
// lies between two samples; with error control a pixel is interpolated only where nothing speaks against
// it, and traced otherwise.
#pragma once

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Tracing/TileTracer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace hrt
{

// The pixels whose column and row are multiples of n, and those of the last column and row, so that
// every other pixel lies between samples.
class Lattice
{
public:
  Lattice(const Camera& camera, int n);

  int columns() const { return static_cast<int>(this->X.samples.size()); }
  int rows() const { return static_cast<int>(this->Y.samples.size()); }
  int pixelRow(int row) const { return this->Y.samples[row]; }
  std::uint32_t pixel(int column, int row) const
  {
    return static_cast<std::uint32_t>(this->Y.samples[row]) * this->Width +
      static_cast<std::uint32_t>(this->X.samples[column]);
  }
  bool isSample(int pixelColumn, int pixelRow) const
  {
    return this->X.places[pixelColumn].count == 1 && this->Y.places[pixelRow].count == 1;
  }

  // Columns and rows of the samples among those pixels.
  PixelBounds samplesWithin(const PixelBounds& pixels) const;

  // The samples around a pixel, one to four of them, with bilinear weights that sum to 1. One: the
  // pixel is that sample.
  struct Around
  {
    struct Neighbour
    {
      std::uint32_t sample; // row * columns() + column
      std::uint32_t pixel;
      float weight;
    };
    std::array<Neighbour, 4> neighbours;
    int count;
    int nearest; // the first of those with the largest weight
  };
  Around around(int pixelColumn, int pixelRow) const
  {
    const Place &x = this->X.places[pixelColumn], &y = this->Y.places[pixelRow];
    Around result;
    result.count = 0;
    for (int j = 0; j < y.count; ++j)
    {
      const float wy = j == 0 ? 1.0f - y.second : y.second;
      for (int i = 0; i < x.count; ++i)
      {
        const int column = x.first + i, row = y.first + j;
        result.neighbours[result.count++] = {
          static_cast<std::uint32_t>(row * this->columns() + column), this->pixel(column, row),
          wy * (i == 0 ? 1.0f - x.second : x.second)
        };
      }
    }
    result.nearest = (y.second > 0.5f ? x.count : 0) + (x.second > 0.5f ? 1 : 0);
    return result;
  }

private:
  // One axis, by tables: every pixel asks, and divisions take longer than the rest.
  struct Place
  {
    int first = 0;       // sample at or before the pixel
    int count = 1;       // 1: the pixel is that sample, 2: the next one is on its other side
    float second = 0.0f; // weight of the next one
  };
  struct Axis
  {
    Axis(int pixels, int n);
    // The first sample at or behind a pixel; their number where there is none.
    int from(int pixel) const;
    std::vector<int> samples;  // their pixels
    std::vector<Place> places; // of the pixels
  };

  std::uint32_t Width;
  Axis X, Y;
};

// The second pass over one pixel between samples. `notes`: of the samples, row by row.
class Interpolation
{
public:
  Interpolation(const TracedFrame& frame, const Lattice& lattice, Wanted wanted);

  enum class Answer
  {
    Leave,        // nothing wanted is there
    Interpolated, // `color` is the pixel's
    Trace
  };
  Answer at(int column, int row, const std::uint32_t* ids,
    const std::vector<TileTracer::Note>& notes, const std::vector<glm::vec4>& colors,
    glm::vec4& color) const;

private:
  const TracedFrame& Frame;
  const Lattice& Samples;
  Wanted Light;
};

} // namespace hrt
