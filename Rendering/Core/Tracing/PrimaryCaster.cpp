// Primary visibility by rays: what the rasteriser's item buffer holds, found by the tracer's own means.
#include "Rendering/Core/Tracing/Interleaving.h"
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
    , Planes(ClipPlanes(frame.snapshot).rows())
  {
    const bool offsets = frame.cameraOrder.anyOffset();
    for (const Part& part : frame.snapshot.parts)
    {
      const Material& material = part.material;
      this->Plain.push_back(!offsets && part.visibleToCamera && !part.perforated &&
        !material.cullFront && !material.cullBack);
    }
  }

  void cast(const std::vector<std::uint32_t>& pixels, RayCount& count)
  {
    this->Rays.clear();
    this->Pixels.clear();
    for (const std::uint32_t pixel : pixels)
    {
      this->Hits.ids[pixel] = 0;
      this->Hits.clipDepths[pixel] = 1.0;
    }
    for (std::size_t i = 0; i < pixels.size(); i += kSurfaceLanes)
    {
      this->add(pixels.data() + i, std::min<std::size_t>(kSurfaceLanes, pixels.size() - i), count);
    }
    this->Found.resize(this->Rays.size());
    this->Frame.structure.intersect(
      this->Rays.data(), this->Found.data(), this->Rays.size(), RayOrder::Coherent);
    unsigned int lanes = 0;
    std::uint32_t shown[kSurfaceLanes];
    for (std::size_t i = 0; i < this->Rays.size(); ++i)
    {
      const Hit& hit = this->Found[i];
      if (!hit.valid())
      {
        continue;
      }
      if (hit.shared || !this->isPlain(hit.triangle))
      {
        this->store(this->Pixels[i], this->Rays[i], hit, count);
        continue;
      }
      this->Hits.ids[this->Pixels[i]] = hit.triangle + 1;
      shown[lanes] = this->Pixels[i];
      this->put(lanes++, this->Rays[i], hit);
      if (lanes == kSurfaceLanes)
      {
        this->storeDepths(shown, lanes);
        lanes = 0;
      }
    }
    this->storeDepths(shown, lanes);
  }

  // A pixel between samples from what they show; false when its own ray has to decide. A triangle is
  // convex: what lies between points of it belongs to it.
  bool infer(int column, int row, const Lattice& lattice, bool errorControl, RayCount& count)
  {
    const Lattice::Around around = lattice.around(column, row);
    const std::uint32_t nearest = around.neighbours[around.nearest].pixel;
    const std::uint32_t id = this->Hits.ids[nearest];
    bool agreed = true;
    double depth = 0.0;
    for (int i = 0; i < around.count; ++i)
    {
      const Lattice::Around::Neighbour& neighbour = around.neighbours[i];
      agreed = agreed && this->Hits.ids[neighbour.pixel] == id;
      depth += static_cast<double>(neighbour.weight) * this->Hits.clipDepths[neighbour.pixel];
    }
    if (errorControl && (!agreed || this->mayHaveHoles(id)))
    {
      return false;
    }
    ++count.asked;
    ++count.answered;
    const std::size_t pixel = std::size_t(row) * this->Frame.snapshot.camera.width + column;
    this->Hits.ids[pixel] = id;
    // In a plane's image z / w is linear: the samples' mean is the plane's depth here. Beyond the
    // triangle, where plain interleaving puts it, the plane may be anywhere: there the sample's stays.
    this->Hits.clipDepths[pixel] = agreed ? depth : this->Hits.clipDepths[nearest];
    return true;
  }

private:
  // Between the points of a triangle there may be a hole of its texture.
  bool mayHaveHoles(std::uint32_t id) const
  {
    const Snapshot& scene = this->Frame.snapshot;
    return id != 0 && scene.parts[scene.partOf(id - 1)].perforated;
  }

  // The rays of so many pixels, one to kSurfaceLanes.
  void add(const std::uint32_t* pixels, std::size_t given, RayCount& count)
  {
    for (std::size_t lane = 0; lane < kSurfaceLanes; ++lane)
    {
      this->Lanes.pixel[lane] = pixels[lane < given ? lane : 0];
    }
    this->Kernels.pixelRays(this->Frame.pixelRays, this->Lanes);
    const unsigned int open = this->Kernels.clip(this->Planes, this->Lanes);
    for (unsigned int lane = 0; lane < given; ++lane)
    {
      ++count.asked;
      if (((open >> lane) & 1u) == 0)
      {
        ++count.answered;
        continue;
      }
      ++count.traced;
      Ray ray;
      ray.origin = SurfaceBlock::vectorOf(this->Lanes.origin, lane);
      ray.direction = SurfaceBlock::vectorOf(this->Lanes.direction, lane);
      ray.tMaximum = this->Lanes.t[lane];
      this->Rays.push_back(ray);
      this->Pixels.push_back(pixels[lane]);
    }
  }

  // Whether a hit on it is what the camera is shown if it is the nearest, at the depth where it is.
  bool isPlain(TriangleId triangle)
  {
    this->Frame.surfaces.findPart(triangle, this->Site);
    return this->Plain[this->Site.index] != 0;
  }

  void put(unsigned int lane, const Ray& ray, const Hit& hit)
  {
    SurfaceBlock::setVector(this->Lanes.origin, lane, ray.origin);
    SurfaceBlock::setVector(this->Lanes.direction, lane, ray.direction);
    this->Lanes.t[lane] = hit.t;
  }

  void storeDepths(const std::uint32_t* pixels, unsigned int count)
  {
    if (count == 0)
    {
      return;
    }
    for (unsigned int lane = count; lane < kSurfaceLanes; ++lane)
    {
      SurfaceBlock::setVector(
        this->Lanes.origin, lane, SurfaceBlock::vectorOf(this->Lanes.origin, 0));
      SurfaceBlock::setVector(
        this->Lanes.direction, lane, SurfaceBlock::vectorOf(this->Lanes.direction, 0));
      this->Lanes.t[lane] = this->Lanes.t[0];
    }
    this->Kernels.depths(this->Planes, this->Lanes);
    for (unsigned int lane = 0; lane < count; ++lane)
    {
      this->Hits.clipDepths[pixels[lane]] = this->Lanes.t[lane];
    }
  }

  bool shown(const Ray& ray, const Hit& hit) const
  {
    const Part& part = this->Frame.snapshot.parts[this->Frame.snapshot.partOf(hit.triangle)];
    const bool front = part.material.cullFront, back = part.material.cullBack;
    if (!part.visibleToCamera || (front == back && !part.perforated))
    {
      return part.visibleToCamera && !front;
    }
    const SurfacePoint point = this->Frame.surfaces.at(hit, ray.direction);
    return (point.frontSide ? !front : !back) && point.opacity > 0.0f;
  }

  // What the camera is shown of the members; not valid where that is none of them.
  Hit frontOf(const Ray& ray, const std::vector<Hit>& members) const
  {
    Hit front;
    for (const Hit& member : members)
    {
      if ((!front.valid() || this->Frame.cameraOrder.hides(ray, member, front)) &&
        this->shown(ray, member))
      {
        front = member;
      }
    }
    return front;
  }

  // The same of what lies in one place with the hit.
  Hit frontOf(const Ray& ray, const Hit& hit)
  {
    if (!hit.shared)
    {
      return this->shown(ray, hit) ? hit : Hit();
    }
    this->Frame.meetings.gather(ray, hit, this->Members);
    return this->frontOf(ray, this->Members);
  }

  void show(std::uint32_t pixel, const Ray& ray, const Hit& hit)
  {
    this->Hits.ids[pixel] = hit.triangle + 1;
    this->Hits.clipDepths[pixel] = this->Frame.cameraOrder.clipDepth(ray, hit);
  }

  void store(std::uint32_t pixel, Ray ray, Hit hit, RayCount& count)
  {
    if (hit.valid() && this->Frame.cameraOrder.offsetsMatter())
    {
      // What lies far behind may be shown before the nearest.
      this->Frame.structure.intersectAll(ray, this->Members);
      const Hit front = this->frontOf(ray, this->Members);
      if (front.valid())
      {
        this->show(pixel, ray, front);
      }
      return;
    }
    for (int passed = 0; hit.valid() && passed < kMostHidden; ++passed)
    {
      const Hit front = this->frontOf(ray, hit);
      if (front.valid())
      {
        this->show(pixel, ray, front);
        return;
      }
      const double left = ray.tMaximum - hit.t;
      ray = leave(this->Frame.surfaces.at(hit, ray.direction), ray.direction);
      ray.tMaximum = left;
      ++count.asked;
      ++count.traced;
      hit = this->Frame.structure.intersect(ray);
    }
  }

  const TracedFrame& Frame;
  PrimaryHits& Hits;
  ClipRows Planes;
  const SurfaceKernels& Kernels = surfaceKernelsFor(bestInstructionSet());
  SurfaceLanes Lanes{};
  Surfaces::Site Site;
  std::vector<std::uint8_t> Plain; // of the parts: see isPlain
  std::vector<Ray> Rays;
  std::vector<std::uint32_t> Pixels;
  std::vector<Hit> Found;
  std::vector<Hit> Members; // of a set
};

// A thread's own.
struct Local
{
  Local(const TracedFrame& frame, PrimaryHits& hits)
    : caster(frame, hits)
  {
  }
  PrimaryCaster caster;
  RayCount count;
  std::vector<std::uint32_t> pixels;
};

// Calls visit(local, columns, rows) for every tile within the bounds in a picture or lattice, on all
// threads.
template <class Locals, class Visit>
void forEachTile(const PixelBounds& bounds, Locals& locals, Visit visit)
{
  if (bounds.empty())
  {
    return;
  }
  using Range = tbb::blocked_range2d<int>;
  tbb::parallel_for(
    Range(bounds.y0 / kTile, tilesAlong(bounds.y1), 1, bounds.x0 / kTile, tilesAlong(bounds.x1), 1),
    [&](const Range& range) {
      Local& local = locals.local();
      for (int row = range.rows().begin(); row < range.rows().end(); ++row)
      {
        for (int column = range.cols().begin(); column < range.cols().end(); ++column)
        {
          local.pixels.clear();
          visit(local, TileSpan(column, bounds.x0, bounds.x1), TileSpan(row, bounds.y0, bounds.y1));
          local.caster.cast(local.pixels, local.count);
        }
      }
    });
}

} // namespace

RayCounters castPrimaryRays(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, PrimaryHits& hits)
{
  const Camera& camera = snapshot.camera;
  const std::size_t pixels = std::size_t(camera.width) * camera.height;
  const PixelBounds bounds = settings.bounds.within(camera.width, camera.height);
  if (bounds.pixels() != pixels)
  {
    hits.ids.assign(pixels, 0);
    hits.clipDepths.assign(pixels, 1.0);
  }
  hits.ids.resize(pixels); // every tile clears its own
  hits.clipDepths.resize(pixels);
  const TracedFrame frame(snapshot, structure, settings);
  const Lattice lattice(camera, settings.interleave);
  tbb::enumerable_thread_specific<Local> locals(
    [&] { return Local(frame, hits); });
  forEachTile(lattice.samplesWithin(bounds), locals,
    [&](Local& local, const TileSpan& columns, const TileSpan& rows) {
      forEachInBlocks(columns.count, rows.count, [&](int x, int y) {
        local.pixels.push_back(lattice.pixel(columns.first + x, rows.first + y));
      });
    });
  if (settings.interleave > 1)
  {
    forEachTile(bounds, locals,
      [&](Local& local, const TileSpan& columns, const TileSpan& rows) {
        forEachInBlocks(columns.count, rows.count, [&](int x, int y) {
          const int column = columns.first + x, row = rows.first + y;
          if (!lattice.isSample(column, row) &&
            !local.caster.infer(
              column, row, lattice, settings.interleaveErrorControl, local.count))
          {
            local.pixels.push_back(static_cast<std::uint32_t>(row * camera.width + column));
          }
        });
      });
  }
  RayCounters sum;
  for (const Local& local : locals)
  {
    sum.primary += local.count;
  }
  return sum;
}

} // namespace hrt
