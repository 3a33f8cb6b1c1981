// Spreads the tiles over the threads. A tile's result depends on nothing but its pixels, and the
// counters are whole numbers: the picture is the same, bit by bit, for any number of threads.
#include "Rendering/Core/Tracing/Tracer.h"

#include "Rendering/Core/Tracing/TileTracer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace hrt
{

namespace
{

// Pixels along a tile's side: a few hundred rays of a kind, enough to fill packets, little enough for
// a tile's queues to stay in the cache.
constexpr int kTile = 32;

// Pixels along a side of the blocks whose rays are neighbours in a stream: 16 rays, one packet.
constexpr int kBlock = 4;

// A ray that meets parts hidden from the camera, or culled sides, goes on behind them; not for ever.
constexpr int kMostHidden = 1024;

using TileRange = tbb::blocked_range2d<int>;

// Calls work(left, bottom, width, height, local) for every tile; `local` is the thread's own.
template <class Local, class Work>
void forEachTile(const Camera& camera, Local& locals, Work work)
{
  const int columns = (camera.width + kTile - 1) / kTile;
  const int rows = (camera.height + kTile - 1) / kTile;
  tbb::parallel_for(TileRange(0, rows, 1, 0, columns, 1), [&](const TileRange& range) {
    auto& local = locals.local();
    for (int row = range.rows().begin(); row < range.rows().end(); ++row)
    {
      for (int column = range.cols().begin(); column < range.cols().end(); ++column)
      {
        const int left = column * kTile, bottom = row * kTile;
        work(left, bottom, std::min(kTile, camera.width - left),
          std::min(kTile, camera.height - bottom), local);
      }
    }
  });
}

SecondaryResult traceTiles(const TracedFrame& frame, TileTracer::Wanted wanted,
  const std::uint32_t* ids, SecondaryImage& image)
{
  struct Local
  {
    explicit Local(const TracedFrame& f)
      : tracer(f)
    {
    }
    TileTracer tracer;
    SecondaryResult result;
  };
  tbb::enumerable_thread_specific<Local> locals([&frame] { return Local(frame); });
  forEachTile(frame.snapshot.camera, locals,
    [&](int left, int bottom, int width, int height, Local& local) {
      local.tracer.trace(left, bottom, width, height, wanted, ids, image, local.result);
    });
  SecondaryResult sum;
  for (const Local& local : locals)
  {
    sum.rays += local.result.rays;
    sum.pixels += local.result.pixels;
    sum.invalidIds += local.result.invalidIds;
  }
  return sum;
}

void resize(SecondaryImage& image, const Camera& camera, const glm::vec4& value)
{
  image.width = camera.width;
  image.height = camera.height;
  image.pixels.assign(std::size_t(camera.width) * camera.height, value);
}

// Primary rays between the clip planes.
class PrimaryCaster
{
public:
  PrimaryCaster(const TracedFrame& frame, PrimaryHits& hits)
    : Frame(frame)
    , Hits(hits)
    , ToClip(frame.snapshot.camera.viewToClip * frame.snapshot.camera.worldToView)
  {
    this->ToClip[3] = this->ToClip * glm::dvec4(frame.snapshot.origin, 1.0);
  }

  // A ray cut by the near and the far plane; false when nothing is left of it.
  bool clip(Ray& ray) const
  {
    const glm::dvec4 from = this->ToClip * glm::dvec4(ray.origin, 1.0);
    const glm::dvec4 along = this->ToClip * glm::dvec4(ray.direction, 0.0);
    double first = 0.0, last = ray.tMaximum;
    // Inside, w + z and w - z are positive; each is linear along the ray.
    for (const double sign : { 1.0, -1.0 })
    {
      const double start = from.w + sign * from.z;
      const double slope = along.w + sign * along.z;
      if (slope > 0.0)
      {
        first = std::max(first, -start / slope);
      }
      else if (slope < 0.0)
      {
        last = std::min(last, -start / slope);
      }
      else if (start < 0.0)
      {
        return false;
      }
    }
    ray.origin += first * ray.direction;
    ray.tMaximum = last - first;
    return first < last;
  }

  void cast(int left, int bottom, int width, int height, RayCount& count)
  {
    this->Rays.clear();
    this->Pixels.clear();
    for (int by = 0; by < height; by += kBlock)
    {
      for (int bx = 0; bx < width; bx += kBlock)
      {
        for (int y = by; y < std::min(by + kBlock, height); ++y)
        {
          for (int x = bx; x < std::min(bx + kBlock, width); ++x)
          {
            this->add(left + x, bottom + y, count);
          }
        }
      }
    }
    this->Found.resize(this->Rays.size());
    this->Frame.structure.intersect(
      this->Rays.data(), this->Found.data(), this->Rays.size(), RayOrder::Coherent);
    for (std::size_t i = 0; i < this->Rays.size(); ++i)
    {
      this->store(this->Pixels[i], this->Rays[i], this->Found[i], count);
    }
  }

private:
  void add(int column, int row, RayCount& count)
  {
    ++count.asked;
    Ray ray = this->Frame.primaryRay(column, row);
    if (this->clip(ray))
    {
      ++count.traced;
      this->Rays.push_back(ray);
      this->Pixels.push_back(std::size_t(row) * this->Frame.snapshot.camera.width + column);
    }
    else
    {
      ++count.answered;
    }
  }

  bool shown(const SurfacePoint& point) const
  {
    const Part& part = this->Frame.snapshot.parts[point.part];
    const bool culled = point.frontSide ? part.material.cullFront : part.material.cullBack;
    return part.visibleToCamera && !culled;
  }

  void store(std::size_t pixel, Ray ray, Hit hit, RayCount& count)
  {
    for (int passed = 0; hit.valid() && passed < kMostHidden; ++passed)
    {
      const SurfacePoint point = this->Frame.surfaces.at(hit, ray.direction);
      if (this->shown(point))
      {
        const glm::dvec4 clip = this->ToClip * glm::dvec4(point.position, 1.0);
        this->Hits.ids[pixel] = hit.triangle + 1;
        this->Hits.clipDepths[pixel] = glm::clamp(clip.z / clip.w, -1.0, 1.0);
        return;
      }
      const double left = ray.tMaximum - hit.t;
      ray = leave(point, ray.direction);
      ray.tMaximum = left;
      ++count.asked;
      ++count.traced;
      hit = this->Frame.structure.intersect(ray);
    }
  }

  const TracedFrame& Frame;
  PrimaryHits& Hits;
  glm::dmat4 ToClip; // from coordinates relative to the snapshot's origin
  std::vector<Ray> Rays;
  std::vector<std::size_t> Pixels;
  std::vector<Hit> Found;
};

} // namespace

RayCounters castPrimaryRays(
  const Snapshot& snapshot, const Structure& structure, PrimaryHits& hits)
{
  const std::size_t pixels = std::size_t(snapshot.camera.width) * snapshot.camera.height;
  hits.ids.assign(pixels, 0);
  hits.clipDepths.assign(pixels, 1.0);
  const TracerSettings settings;
  const TracedFrame frame(snapshot, structure, settings);
  struct Local
  {
    PrimaryCaster caster;
    RayCount count;
  };
  tbb::enumerable_thread_specific<Local> locals(
    [&] { return Local{ PrimaryCaster(frame, hits), {} }; });
  forEachTile(snapshot.camera, locals,
    [](int left, int bottom, int width, int height, Local& local) {
      local.caster.cast(left, bottom, width, height, local.count);
    });
  RayCounters sum;
  for (const Local& local : locals)
  {
    sum.primary += local.count;
  }
  return sum;
}

SecondaryResult traceSecondary(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, SecondaryImage& image)
{
  resize(image, snapshot.camera, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  return settings.maximumDepth <= 0
    ? SecondaryResult()
    : traceTiles(TracedFrame(snapshot, structure, settings), TileTracer::Wanted::SecondaryOnly,
        ids, image);
}

std::vector<float> castShadowRays(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, std::size_t light)
{
  const Camera& camera = snapshot.camera;
  std::vector<float> shares(std::size_t(camera.width) * camera.height,
    std::numeric_limits<float>::quiet_NaN());
  const TracedFrame frame(snapshot, structure, settings);
  tbb::parallel_for(0, camera.height, [&](int row) {
    for (int column = 0; column < camera.width; ++column)
    {
      const std::size_t pixel = std::size_t(row) * camera.width + column;
      const Ray ray = frame.primaryRay(column, row);
      Hit hit;
      if (ids[pixel] != 0 && ids[pixel] <= snapshot.triangleCount &&
        frame.surfaces.primaryHit(ids[pixel] - 1, ray, hit))
      {
        shares[pixel] =
          frame.lighting.visibleShare(frame.surfaces.at(hit, ray.direction), light);
      }
    }
  });
  return shares;
}

SecondaryResult traceImage(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, SecondaryImage& image)
{
  resize(image, snapshot.camera, glm::vec4(0.0f));
  return traceTiles(
    TracedFrame(snapshot, structure, settings), TileTracer::Wanted::Everything, ids, image);
}

} // namespace hrt
