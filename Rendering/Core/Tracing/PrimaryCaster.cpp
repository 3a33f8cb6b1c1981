// Primary visibility by rays: what the rasteriser's item buffer holds, found by the tracer's own means.
#include "Rendering/Core/Tracing/TileTracer.h"
#include "Rendering/Core/Tracing/Tiles.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace hrt
{

namespace
{

// A ray that meets parts hidden from the camera, or culled sides, goes on behind them; not for ever.
constexpr int kMostHidden = 1024;

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

  void cast(const std::vector<std::uint32_t>& pixels, RayCount& count)
  {
    this->Rays.clear();
    this->Pixels.clear();
    for (const std::uint32_t pixel : pixels)
    {
      this->add(pixel, count);
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
  void add(std::uint32_t pixel, RayCount& count)
  {
    ++count.asked;
    Ray ray = this->Frame.primaryRay(pixel);
    if (this->clip(ray))
    {
      ++count.traced;
      this->Rays.push_back(ray);
      this->Pixels.push_back(pixel);
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

  void store(std::uint32_t pixel, Ray ray, Hit hit, RayCount& count)
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
  std::vector<std::uint32_t> Pixels;
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
    std::vector<std::uint32_t> pixels;
  };
  tbb::enumerable_thread_specific<Local> locals(
    [&] { return Local{ PrimaryCaster(frame, hits), {}, {} }; });
  const Camera& camera = snapshot.camera;
  using TileRange = tbb::blocked_range2d<int>;
  tbb::parallel_for(TileRange(0, tilesAlong(camera.height), 1, 0, tilesAlong(camera.width), 1),
    [&](const TileRange& range) {
      Local& local = locals.local();
      for (int row = range.rows().begin(); row < range.rows().end(); ++row)
      {
        for (int column = range.cols().begin(); column < range.cols().end(); ++column)
        {
          tilePixels(camera, column, row, local.pixels);
          local.caster.cast(local.pixels, local.count);
        }
      }
    });
  RayCounters sum;
  for (const Local& local : locals)
  {
    sum.primary += local.count;
  }
  return sum;
}

} // namespace hrt
