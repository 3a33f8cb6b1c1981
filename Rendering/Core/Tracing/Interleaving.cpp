// Implements the lattice of samples and what is allowed between them.
#include "Rendering/Core/Tracing/Interleaving.h"

#include <algorithm>

namespace hrt
{

namespace
{

// By how much samples may differ for error control to interpolate between them, in each component. What
// is interpolated lies within the range of the samples. Where they saw the same surfaces and lights and
// nothing unseen stands between, so does, for colours without an extremum inside of the cell, the true
// colour: the error is below the range of the samples, here 8 steps of an 8-bit picture, and in the
// middle of a linear ramp it is 0.
constexpr float kLargestSpread = 8.0f / 255.0f;

// A sample's place along one axis and its weight there.
struct Along
{
  int first;
  int count;
  float second; // weight of the second one
};

Along along(int at, int n, int last)
{
  const int first = at / n;
  const int from = first * n;
  if (at == from)
  {
    return { first, 1, 0.0f };
  }
  const int to = std::min(from + n, last);
  return at == to ? Along{ first + 1, 1, 0.0f }
                  : Along{ first, 2, static_cast<float>(at - from) / static_cast<float>(to - from) };
}

} // namespace

Lattice::Lattice(const Camera& camera, int n)
  : N(n)
  , Width(camera.width)
  , Height(camera.height)
  , Columns(camera.width > 0 ? (camera.width - 1 + n - 1) / n + 1 : 0)
  , Rows(camera.height > 0 ? (camera.height - 1 + n - 1) / n + 1 : 0)
{
}

Lattice::Around Lattice::around(int pixelColumn, int pixelRow) const
{
  const Along x = along(pixelColumn, this->N, this->Width - 1);
  const Along y = along(pixelRow, this->N, this->Height - 1);
  Around result;
  for (int j = 0; j < y.count; ++j)
  {
    for (int i = 0; i < x.count; ++i)
    {
      const int column = x.first + i, row = y.first + j;
      const float weight =
        (i == 0 ? 1.0f - x.second : x.second) * (j == 0 ? 1.0f - y.second : y.second);
      result.neighbours[result.count] = { static_cast<std::uint32_t>(row * this->Columns + column),
        this->pixel(column, row), weight };
      result.nearest =
        weight > result.neighbours[result.nearest].weight ? result.count : result.nearest;
      ++result.count;
    }
  }
  return result;
}

Interpolation::Interpolation(const TracedFrame& frame, const Lattice& lattice, Wanted wanted)
  : Frame(frame)
  , Samples(lattice)
  , Light(wanted)
{
}

Interpolation::Answer Interpolation::at(int column, int row, const std::uint32_t* ids,
  const std::vector<TileTracer::Note>& notes, const std::vector<glm::vec4>& colors,
  glm::vec4& color) const
{
  const Snapshot& snapshot = this->Frame.snapshot;
  const TracerSettings& settings = this->Frame.settings;
  const std::uint32_t id = ids[std::size_t(row) * snapshot.camera.width + column];
  if (id == 0 || id > snapshot.triangleCount)
  {
    return id == 0 ? Answer::Leave : Answer::Trace; // which counts it as invalid
  }
  const std::size_t part = snapshot.partOf(id - 1);
  if (this->Light == Wanted::SecondaryOnly && !this->Frame.hasOptics(part))
  {
    // Multisampling may find that the pixel shows something else.
    return settings.multisampling == Multisampling::Clamp ? Answer::Leave : Answer::Trace;
  }
  const Lattice::Around around = this->Samples.around(column, row);
  glm::vec4 sum(0.0f), least(0.0f), most(0.0f);
  float weights = 0.0f;
  for (int i = 0; i < around.count; ++i)
  {
    const Lattice::Around::Neighbour& neighbour = around.neighbours[i];
    const TileTracer::Note& note = notes[neighbour.sample];
    if (settings.interleaveErrorControl &&
      (note.part != part || note.signature != notes[around.neighbours[0].sample].signature))
    {
      return Answer::Trace;
    }
    if (note.part == TileTracer::kNoPart)
    {
      continue;
    }
    const glm::vec4& sample = colors[neighbour.pixel];
    least = weights == 0.0f ? sample : glm::min(least, sample);
    most = weights == 0.0f ? sample : glm::max(most, sample);
    sum += neighbour.weight * sample;
    weights += neighbour.weight;
  }
  if (weights == 0.0f ||
    (settings.interleaveErrorControl &&
      glm::any(glm::greaterThan(most - least, glm::vec4(kLargestSpread)))))
  {
    return Answer::Trace;
  }
  color = sum / weights;
  return Answer::Interpolated;
}

} // namespace hrt
