// Spreads the tiles over the threads, and makes the second passes once all samples are there. A tile's
// result depends on nothing but its pixels, and the counters are whole numbers: the picture is the
// same, bit by bit, for any number of threads.
#include "Rendering/Core/Tracing/ImageTracer.h"

#include "Rendering/Core/Tracing/Interleaving.h"
#include "Rendering/Core/Tracing/TileTracer.h"
#include "Rendering/Core/Tracing/Tiles.h"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cstdlib>
#include <unordered_set>

namespace hrt
{

namespace
{

// A thread's own queues and counters.
struct Local
{
  explicit Local(const TracedFrame& frame)
    : tracer(frame)
  {
  }
  TileTracer tracer;
  std::vector<std::uint32_t> pixels;
  std::vector<std::uint32_t> missed; // pixels, see FirstHits
  SecondaryResult result;
};

} // namespace

class ImageTracer::Work
{
public:
  Work(const Snapshot& snapshot, const Structure& structure, const TracerSettings& settings,
    Wanted wanted, const std::uint32_t* ids, SecondaryImage& image)
    : Frame(snapshot, structure, settings)
    , Light(wanted)
    , Ids(ids)
    , Image(image)
    , Samples(snapshot.camera, settings.interleave)
    , Locals([this] { return Local(this->Frame); })
  {
    const Camera& camera = snapshot.camera;
    image.width = camera.width;
    image.height = camera.height;
    if (wanted == Wanted::Everything || settings.maximumDepth > 0)
    {
      this->Bounds = settings.bounds.within(camera.width, camera.height);
      this->SampleBounds = this->Samples.samplesWithin(this->Bounds);
    }
    const std::size_t size = std::size_t(camera.width) * camera.height;
    if (settings.interleave > 1 || this->Bounds.pixels() != size)
    {
      image.pixels.assign(size, noLight(wanted));
    }
    image.pixels.resize(size); // all of them are traced, on all threads
    if (!this->SampleBounds.empty())
    {
      this->Started = this->SampleBounds.y0 / kTile;
      this->TileRows = tilesAlong(this->SampleBounds.y1);
    }
    if (settings.interleave > 1)
    {
      this->Notes.resize(std::size_t(this->Samples.columns()) * this->Samples.rows());
    }
  }

  ~Work()
  {
    this->Tasks.cancel();
    try
    {
      this->Tasks.wait();
    }
    catch (...) // finish() was not called, so nobody asks
    {
    }
  }

  void idsReady(int rows)
  {
    for (; this->Started < this->TileRows && this->rowsLookedAt(this->Started) <= rows;
         ++this->Started)
    {
      this->Tasks.run([this, row = this->Started] { this->traceTileRow(row); });
    }
  }

  SecondaryResult finish()
  {
    this->idsReady(this->Frame.snapshot.camera.height);
    this->Tasks.wait();
    if (!this->Bounds.empty() && this->Frame.settings.interleave > 1)
    {
      this->traceBetweenSamples();
    }
    SecondaryResult sum;
    std::vector<std::uint32_t> missed;
    for (const Local& local : this->Locals)
    {
      sum += local.result;
      missed.insert(missed.end(), local.missed.begin(), local.missed.end());
    }
    this->interpolateMissed(missed, sum.multisampling);
    return sum;
  }

private:
  // The rows of ids, counted from the bottom, that a row of tiles depends on.
  int rowsLookedAt(int tileRow) const
  {
    const TileSpan rows(tileRow, this->SampleBounds.y0, this->SampleBounds.y1);
    return std::min(this->Samples.pixelRow(rows.first + rows.count - 1) + 1 +
        reachOf(this->Frame.settings.multisampling),
      this->Frame.snapshot.camera.height);
  }

  void traceTileRow(int row)
  {
    tbb::parallel_for(this->SampleBounds.x0 / kTile, tilesAlong(this->SampleBounds.x1),
      [this, row](int column) { this->traceSamples(column, row); });
  }

  void traceSamples(int tileColumn, int tileRow)
  {
    Local& local = this->Locals.local();
    const PixelBounds& bounds = this->SampleBounds;
    const TileSpan columns(tileColumn, bounds.x0, bounds.x1), rows(tileRow, bounds.y0, bounds.y1);
    local.pixels.clear();
    forEachInBlocks(columns.count, rows.count, [&](int x, int y) {
      local.pixels.push_back(this->Samples.pixel(columns.first + x, rows.first + y));
    });
    this->tracePixels(local);
    if (this->Notes.empty())
    {
      return;
    }
    std::size_t next = 0;
    forEachInBlocks(columns.count, rows.count, [&](int x, int y) {
      const std::size_t sample =
        std::size_t(rows.first + y) * this->Samples.columns() + columns.first + x;
      this->Notes[sample] = local.tracer.note(next++);
    });
  }

  void tracePixels(Local& local)
  {
    local.tracer.trace(local.pixels, this->Light, this->Ids, this->Image, local.result);
    for (std::size_t i = 0; i < local.pixels.size(); ++i)
    {
      if (local.tracer.note(i).missed)
      {
        local.missed.push_back(local.pixels[i]);
      }
    }
  }

  void traceBetweenSamples()
  {
    const PixelBounds& bounds = this->Bounds;
    using Range = tbb::blocked_range2d<int>;
    tbb::parallel_for(Range(bounds.y0 / kTile, tilesAlong(bounds.y1), 1, bounds.x0 / kTile,
                        tilesAlong(bounds.x1), 1),
      [this](const Range& range) {
        for (int row = range.rows().begin(); row < range.rows().end(); ++row)
        {
          for (int column = range.cols().begin(); column < range.cols().end(); ++column)
          {
            this->traceBetween(column, row);
          }
        }
      });
  }

  // Writes to no sample, reads samples only: in whatever order the tiles come.
  void traceBetween(int tileColumn, int tileRow)
  {
    Local& local = this->Locals.local();
    const Camera& camera = this->Frame.snapshot.camera;
    const PixelBounds& bounds = this->Bounds;
    const TileSpan columns(tileColumn, bounds.x0, bounds.x1), rows(tileRow, bounds.y0, bounds.y1);
    const Interpolation interpolation(this->Frame, this->Samples, this->Light);
    local.pixels.clear();
    forEachInBlocks(columns.count, rows.count, [&](int x, int y) {
      const int column = columns.first + x, row = rows.first + y;
      if (this->Samples.isSample(column, row))
      {
        return;
      }
      const std::size_t pixel = std::size_t(row) * camera.width + column;
      glm::vec4 color;
      switch (interpolation.at(column, row, this->Ids, this->Notes, this->Image.pixels, color))
      {
        case Interpolation::Answer::Interpolated:
          this->Image.pixels[pixel] = color;
          ++local.result.interleave.interpolated;
          break;
        case Interpolation::Answer::Trace:
          local.pixels.push_back(static_cast<std::uint32_t>(pixel));
          break;
        case Interpolation::Answer::Leave:
          break;
      }
    });
    this->tracePixels(local);
  }

  // Colours what no triangle was found for from the pixels around it that show one. Reads none of what
  // it writes.
  void interpolateMissed(
    const std::vector<std::uint32_t>& missed, MultisamplingCounts& counts) const
  {
    const int reach = reachOf(this->Frame.settings.multisampling);
    const std::unordered_set<std::uint32_t> all(missed.begin(), missed.end());
    for (const std::uint32_t pixel : missed)
    {
      bool done = false;
      for (int ring = 1; ring <= reach && !done; ++ring)
      {
        done = this->meanOfRing(pixel, ring, all);
      }
      ++(done ? counts.interpolated : counts.unresolved);
    }
  }

  // The mean over the pixels that are `ring` columns or rows away and show a triangle; false when none
  // does.
  bool meanOfRing(
    std::uint32_t pixel, int ring, const std::unordered_set<std::uint32_t>& missed) const
  {
    const Camera& camera = this->Frame.snapshot.camera;
    const int column = static_cast<int>(pixel) % camera.width;
    const int row = static_cast<int>(pixel) / camera.width;
    glm::vec4 sum(0.0f);
    float count = 0.0f;
    for (int y = std::max(row - ring, 0); y <= std::min(row + ring, camera.height - 1); ++y)
    {
      for (int x = std::max(column - ring, 0); x <= std::min(column + ring, camera.width - 1); ++x)
      {
        const auto other = static_cast<std::uint32_t>(y * camera.width + x);
        const bool onRing = std::max(std::abs(x - column), std::abs(y - row)) == ring;
        const bool shown =
          this->Ids[other] != 0 && this->Ids[other] <= this->Frame.snapshot.triangleCount;
        if (onRing && shown && missed.count(other) == 0)
        {
          sum += this->Image.pixels[other];
          count += 1.0f;
        }
      }
    }
    if (count > 0.0f)
    {
      this->Image.pixels[pixel] = sum / count;
    }
    return count > 0.0f;
  }

  const TracedFrame Frame;
  const Wanted Light;
  const std::uint32_t* Ids;
  SecondaryImage& Image;
  const Lattice Samples; // all pixels without interleaving
  std::vector<TileTracer::Note> Notes; // of the samples, for the second pass
  tbb::enumerable_thread_specific<Local> Locals;
  PixelBounds Bounds{ 0, 0, 0, 0 };       // of the pixels to trace, within the picture
  PixelBounds SampleBounds{ 0, 0, 0, 0 }; // of the samples among them
  int TileRows = 0;   // up to the last row of tiles
  int Started = 0;    // rows of tiles, from the bottom
  tbb::task_group Tasks;
};

ImageTracer::ImageTracer(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, Wanted wanted, const std::uint32_t* ids, SecondaryImage& image)
  : TheWork(std::make_unique<Work>(snapshot, structure, settings, wanted, ids, image))
{
}

ImageTracer::~ImageTracer() = default;

void ImageTracer::idsReady(int rows)
{
  this->TheWork->idsReady(rows);
}

SecondaryResult ImageTracer::finish()
{
  return this->TheWork->finish();
}

} // namespace hrt
