// Traces one tile of the picture at a time, generation by generation: all rays of a kind that the
// tile's pixels need next are gathered in a queue, traced as one stream, and shaded together, until no
// queue holds a ray. Neighbouring rays go through the structure together, which packets gain from,
// and nothing depends on how many threads share the tiles: within a tile every sum is made in one
// fixed order.
#pragma once

#include "Rendering/Core/Tracing/Lighting.h"
#include "Rendering/Core/Tracing/Surface.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <vector>

namespace hrt
{

// What all tiles share, read only.
struct TracedFrame
{
  TracedFrame(
    const Snapshot& snapshot, const Structure& structure, const TracerSettings& settings);

  bool isGlass(const Material& material) const;
  bool isMirror(const Material& material) const; // glass comes first

  // The primary ray through the centre of a pixel, row 0 at the bottom; unit direction.
  Ray primaryRay(std::uint32_t pixel) const;

  const Snapshot& snapshot;
  const Structure& structure;
  const TracerSettings& settings;
  Surfaces surfaces;
  Lighting lighting;
  CameraRays rays;
  glm::dvec3 viewer; // the view coordinates' origin, relative to the scene's
};

class TileTracer
{
public:
  explicit TileTracer(const TracedFrame& frame);

  // The pixels with the given numbers in the whole picture, which `ids` and `image` are of. A pixel's
  // result depends on no other pixel of the list; neighbours in it should be neighbours in the
  // picture.
  void trace(const std::vector<std::uint32_t>& pixels, Wanted wanted, const std::uint32_t* ids,
    SecondaryImage& image, SecondaryResult& result);

private:
  // A ray on its way and what its light is worth.
  struct Path
  {
    glm::vec3 weight{ 1.0f }; // share of its radiance in the pixel
    std::uint32_t pixel = 0;  // index into the tile's list
    int bounces = 0;          // reflections and refractions so far
    int layers = 0;           // translucent surfaces passed since the last of them
  };
  struct PathQueue
  {
    std::vector<Ray> rays;
    std::vector<Path> paths;

    void clear()
    {
      this->rays.clear();
      this->paths.clear();
    }
  };

  void start(std::uint32_t index, std::uint32_t pixel, std::uint32_t id, Wanted wanted,
    SecondaryResult& result);
  void startMirror(const SurfacePoint& point, const glm::dvec3& direction, const Path& path);
  void arrive(const SurfacePoint& point, const glm::dvec3& direction,
    const glm::dvec3& toViewer, const Path& path, PathQueue& sameKind);
  void arriveAtGlass(const SurfacePoint& point, const glm::dvec3& direction,
    const glm::dvec3& toViewer, const Path& path);
  void passThrough(const SurfacePoint& point, const glm::dvec3& direction, const Path& path,
    PathQueue& sameKind);
  void spawn(PathQueue& queue, const Ray& ray, const Path& path, const glm::vec3& share);
  void follow(PathQueue& queue, PathQueue& sameKind, RayCount& count, RayOrder order);
  glm::vec3 background(const glm::dvec3& direction) const;

  const TracedFrame& Frame;
  std::vector<glm::vec3> Sums;
  std::vector<float> Alphas;
  PathQueue Reflected, Refracted;         // rays of the generation to come
  PathQueue NowReflected, NowRefracted;   // of the one being traced
  std::vector<Hit> Hits;
  ShadowQueue Shadows;
  RayCounters Counters;
};

} // namespace hrt
