// Spreads the tiles over the threads. A tile's result depends on nothing but its pixels, and the
// counters are whole numbers: the picture is the same, bit by bit, for any number of threads.
#include "Rendering/Core/Tracing/ImageTracer.h"

#include "Rendering/Core/Tracing/TileTracer.h"
#include "Rendering/Core/Tracing/Tiles.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>

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
    , Locals([this] { return Local(this->Frame); })
  {
    const Camera& camera = snapshot.camera;
    image.width = camera.width;
    image.height = camera.height;
    const bool everything = wanted == Wanted::Everything;
    image.pixels.assign(std::size_t(camera.width) * camera.height,
      glm::vec4(0.0f, 0.0f, 0.0f, everything ? 0.0f : 1.0f));
    this->TileRows = everything || settings.maximumDepth > 0 ? tilesAlong(camera.height) : 0;
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
    SecondaryResult sum;
    for (const Local& local : this->Locals)
    {
      sum += local.result;
    }
    return sum;
  }

private:
  // The rows of ids, counted from the bottom, that a row of tiles depends on.
  int rowsLookedAt(int tileRow) const
  {
    return std::min((tileRow + 1) * kTile, this->Frame.snapshot.camera.height);
  }

  void traceTileRow(int row)
  {
    const Camera& camera = this->Frame.snapshot.camera;
    tbb::parallel_for(0, tilesAlong(camera.width), [&](int column) {
      Local& local = this->Locals.local();
      tilePixels(camera, column, row, local.pixels);
      local.tracer.trace(local.pixels, this->Light, this->Ids, this->Image, local.result);
    });
  }

  const TracedFrame Frame;
  const Wanted Light;
  const std::uint32_t* Ids;
  SecondaryImage& Image;
  tbb::enumerable_thread_specific<Local> Locals;
  int TileRows = 0;
  int Started = 0; // rows of tiles
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
