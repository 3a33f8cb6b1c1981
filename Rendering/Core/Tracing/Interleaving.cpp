// Implements the lattice of samples and what is allowed between them.
#include "Rendering/Core/Tracing/Interleaving.h"

namespace hrt
{

namespace
{

// The largest error of an interpolated pixel that error control puts up with where all goes well.
constexpr float kLargestError = 3.0f / 255.0f;

// By how much samples may differ, in each component, for error control to interpolate between them. What is
// interpolated lies within their range R. Along an axis a colour that rises or falls from one sample to
// the next with even curvature, R x^2 at worst, is off its chord by R (x - x^2): by R / 4 in the middle.
// Where it is linear the error is 0. What happens between the samples unseen by all four of them, no bound
// on their range can tell.
constexpr float kLargestSpread = 4.0f * kLargestError;

} // namespace

Lattice::Axis::Axis(int pixels, int n)
  : places(static_cast<std::size_t>(pixels))
{
  for (int pixel = 0; pixel < pixels; ++pixel)
  {
    if (pixel % n == 0 || pixel == pixels - 1)
    {
      this->samples.push_back(pixel);
    }
    this->places[pixel].first = static_cast<int>(this->samples.size()) - 1;
  }
  for (int pixel = 0; pixel < pixels; ++pixel)
  {
    Place& place = this->places[pixel];
    const int from = this->samples[place.first];
    if (pixel != from)
    {
      place.count = 2;
      place.second = static_cast<float>(pixel - from) /
        static_cast<float>(this->samples[place.first + 1] - from);
    }
  }
}

Lattice::Lattice(const Camera& camera, int n)
  : Width(static_cast<std::uint32_t>(camera.width))
  , X(camera.width, n)
  , Y(camera.height, n)
{
}

int Lattice::Axis::from(int pixel) const
{
  const auto found = std::lower_bound(this->samples.begin(), this->samples.end(), pixel);
  return static_cast<int>(found - this->samples.begin());
}

PixelBounds Lattice::samplesWithin(const PixelBounds& pixels) const
{
  return { this->X.from(pixels.x0), this->X.from(pixels.x1), this->Y.from(pixels.y0),
    this->Y.from(pixels.y1) };
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
      (note.part != part || note.detailed ||
        note.signature != notes[around.neighbours[0].sample].signature))
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
