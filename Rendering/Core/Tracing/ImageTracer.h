// Traces a picture while its ids still arrive: a graphics card hands an item buffer over in bands, and
// whoever waits for the last of them before the first ray wastes the time of the transfer. Rows of
// tiles start in the background as soon as the ids that they look at are there.
#pragma once

#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <memory>

namespace hrt
{

// The picture is the same, bit by bit, for any number of threads and any bands.
class ImageTracer
{
public:
  using Wanted = hrt::Wanted;

  // All must outlive it. `ids`: width x height of the snapshot's camera, row 0 at the bottom; what has
  // not been announced by idsReady() is not read. `image` gets its size here.
  ImageTracer(const Snapshot& snapshot, const Structure& structure, const TracerSettings& settings,
    Wanted wanted, const std::uint32_t* ids, SecondaryImage& image);
  // Waits for what runs; what has not begun is dropped.
  ~ImageTracer();
  ImageTracer(const ImageTracer&) = delete;
  ImageTracer& operator=(const ImageTracer&) = delete;

  // The ids of rows [0, rows) are valid now and stay so. Starts in the background what can be traced
  // with them and returns at once. To be called from one thread; fewer rows than before change
  // nothing.
  void idsReady(int rows);

  // The ids of all rows are valid: traces what is left and waits for it. Throws what a background task
  // threw. Once only.
  SecondaryResult finish();

private:
  class Work;
  std::unique_ptr<Work> TheWork;
};

} // namespace hrt
