// Traces one tile of the picture at a time, generation by generation: all rays of a kind that the
// tile's pixels need next are gathered in a queue, traced as one stream, and shaded together, until no
// queue holds a ray. Neighbouring rays go through the structure together, which packets gain from,
// and nothing depends on how many threads share the tiles: within a tile every sum is made in one
// fixed order.
#pragma once

#include "Rendering/Core/Tracing/FirstHits.h"
#include "Rendering/Core/Tracing/Lighting.h"
#include "Rendering/Core/Tracing/Meeting.h"
#include "Rendering/Core/Tracing/PathSignature.h"
#include "Rendering/Core/Tracing/Surface.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <optional>
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
  bool hasOptics(std::size_t part) const;        // either of them

  // The primary ray through the centre of a pixel, row 0 at the bottom; unit direction.
  Ray primaryRay(std::uint32_t pixel) const;
  const Snapshot& snapshot;
  const Structure& structure;
  const TracerSettings& settings;
  Surfaces surfaces;
  Meetings meetings;
  CameraOrder cameraOrder;
  FirstHits firstHits;
  Lighting lighting;
  CameraRays rays;
  PixelRays pixelRays; // the same, for blocks of pixels
  glm::dvec3 viewer; // the view coordinates' origin, relative to the scene's
};

class TileTracer
{
public:
  explicit TileTracer(const TracedFrame& frame);

  // What the tracer learns of a pixel beside its colour.
  struct Note
  {
    // Of the surface that the pixel shows; kNoPart when it shows none whose light is wanted.
    std::uint32_t part = kNoPart;
    bool missed = false; // see FirstHits
    // Something on its paths has a texture or edges: what lies beside it may look different.
    bool detailed = false;
    PathSignature signature = 0;
  };
  static constexpr std::uint32_t kNoPart = 0xffffffff;

  // The pixels with the given numbers in the whole picture, which `ids` and `image` are of. A pixel's
  // result depends on no other pixel of the list; neighbours in it should be neighbours in the
  // picture.
  void trace(const std::vector<std::uint32_t>& pixels, Wanted wanted, const std::uint32_t* ids,
    SecondaryImage& image, SecondaryResult& result);

  // Of the pixel at that index of the last call's list.
  Note note(std::size_t index) const;

private:
  // A ray on its way and what its light is worth.
  struct Path
  {
    glm::vec3 weight{ 1.0f }; // share of its radiance in the pixel
    std::uint32_t pixel = 0;  // index into the tile's list
    int bounces = 0;          // reflections and refractions so far
    int layers = 0;           // translucent surfaces passed since the last of them
    Way way;                  // from the camera to where the ray starts
    // Between surfaces in one place: the set, the member that the ray meets next or has just met, and
    // the step to the one after it.
    std::int32_t set = kNoSet;
    std::int32_t member = 0;
    std::int32_t step = 1;
  };
  static constexpr std::int32_t kNoSet = -1;
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

  enum class Kind
  {
    Eye,
    Reflected,
    Refracted
  };
  void start(const std::vector<std::uint32_t>& pixels, Wanted wanted, const std::uint32_t* ids,
    SecondaryResult& result);
  void startBlock(
    unsigned int count, Wanted wanted, const std::uint32_t* ids, SecondaryResult& result);
  void startAlone(unsigned int lane, Wanted wanted);
  bool startOptics(
    const SurfacePoint& point, const Ray& ray, const Hit& hit, Path& eye, Wanted wanted);
  bool mayShowOptics(std::uint32_t pixel, const std::uint32_t* ids) const;
  void startMirror(const SurfacePoint& point, const glm::dvec3& direction, const Path& path);
  void enter(std::vector<Hit>& members, Path& path);
  Hit firstOfSet(const Ray& ray, const Hit& hit, Path& path);
  void turnOn(Path& path, bool back) const;
  void put(unsigned int lane, const Hit& hit, const glm::dvec3& direction, const Path& path);
  void arriveFrom(unsigned int count, const Path* paths, Kind kind);
  void arrive(unsigned int bits, const Path* paths, Kind kind);
  void arrive(const SurfacePoint& point, const glm::dvec3& direction,
    const glm::dvec3& toViewer, const Path& path, Kind kind);
  Lighting::Target targetOf(const Path& path, float mirror, float opacity);
  Lighting::Target highlightOf(const Path& path);
  void noteArrival(
    const Path& path, const Part& part, std::size_t index, bool front, Kind kind);
  void note(PathEvent event, const Path& path, std::size_t index, unsigned int outcome);
  void arriveAtGlass(const SurfacePoint& point, const glm::dvec3& direction,
    const glm::dvec3& toViewer, const Path& path);
  void sendThroughGlass(
    const SurfacePoint& point, const glm::dvec3& direction, const Path& path);
  void passThrough(const SurfacePoint& point, const glm::dvec3& direction, const Path& path,
    Kind kind);
  void spawn(
    PathQueue& queue, const Ray& ray, const Path& path, const glm::vec3& share, bool back);
  void follow(PathQueue& queue, Kind kind, RayCount& count, RayOrder order);
  void addBackground(const glm::dvec3& direction, const Path& path, const glm::vec3& weight);
  glm::vec3 background(const glm::dvec3& direction) const;

  const TracedFrame& Frame;
  SurfaceBlock Block;
  Path Eyes[SurfaceBlock::kLanes], Arriving[SurfaceBlock::kLanes]; // of the block's lanes
  std::uint32_t Indices[SurfaceBlock::kLanes];                    // into the tile's list
  std::optional<Lighting::Target> Targets[SurfaceBlock::kLanes];
  Surfaces::Located Where;
  std::vector<glm::vec3> Sums;
  std::vector<float> Alphas;
  std::vector<std::uint32_t> Parts;
  std::vector<std::uint8_t> Missed;
  std::vector<std::uint8_t> Detailed;
  std::vector<PathSignature> Signatures;
  PathQueue Reflected, Refracted;         // rays of the generation to come
  PathQueue NowReflected, NowRefracted;   // of the one being traced
  PathQueue Within;                       // of which these stay between surfaces in one place
  std::vector<Hit> Hits;
  std::vector<std::vector<Hit>> Sets;     // of surfaces in one place, in the order of the first ray's way
  ShadowQueue Shadows;
  RayCounters Counters;
};

} // namespace hrt
