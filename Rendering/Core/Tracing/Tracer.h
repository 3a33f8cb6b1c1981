// The ray tracer behind the pass: primary visibility by rays, what mirrors and glass show, and whole
// pictures without a rasteriser (the paper's traditional ray tracer). All three share one wavefront
// engine (TileTracer.h) and one shading source (Shading.h), so that a surface looks the same directly
// and in a mirror.
#pragma once

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Shading/ShadowLookup.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Tracing/Multisampling.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace hrt
{

struct TracerSettings
{
  int maximumDepth = 3;       // bounces; a ray that would be the (n+1)th adds nothing
  bool shadows = true;        // shadow rays at the hits
  // For what the camera sees directly, looked up instead of casting shadow rays; null: rays there too.
  std::shared_ptr<const ShadowMapTables> shadowMaps;
  bool tintedShadows = false; // translucent surfaces take their share of a shadow ray's light
  bool reflections = true;
  bool refractions = true;
  Multisampling multisampling = Multisampling::Clamp; // of the first hits: see Multisampling.h
  // Every n-th column and row is traced, and the last ones; what lies between is interpolated in a
  // second pass. At least 1.
  int interleave = 1;
  // Between samples that saw different things the pixels are traced; otherwise the paper's plain
  // interpolation. See Interleaving.h.
  bool interleaveErrorControl = true;
  // What is traced; the other pixels are as if nothing was hit. Multisampling and interleaving look
  // at neighbours: near the bounds their result is that of the whole picture from pixelsAround() of
  // both inwards.
  PixelBounds bounds;
};

// Rays by class, for the statistics: how many were asked for and how many had to be traced;
// asked == answered + traced.
struct RayCount
{
  std::uint64_t asked = 0;
  // Without tracing: shadow rays of a surface turned from the light or a term that is zero; primary
  // rays beside the near and far plane or of pixels between samples that show the same; other rays
  // beyond the maximum depth or with a weight below 1/512 of the pixel.
  std::uint64_t answered = 0;
  std::uint64_t traced = 0;

  RayCount& operator+=(const RayCount& o)
  {
    this->asked += o.asked;
    this->answered += o.answered;
    this->traced += o.traced;
    return *this;
  }
};

struct RayCounters
{
  RayCount primary;
  RayCount reflection;
  RayCount refraction;
  RayCount shadow;

  RayCounters& operator+=(const RayCounters& o)
  {
    this->primary += o.primary;
    this->reflection += o.reflection;
    this->refraction += o.refraction;
    this->shadow += o.shadow;
    return *this;
  }
};

// What every pixel of the camera's viewport shows, row 0 at the bottom.
struct PrimaryHits
{
  std::vector<std::uint32_t> ids;   // triangle numbers plus one; 0: no hit
  std::vector<double> clipDepths;   // z / w in OpenGL's clip space, -1 near to 1 far; 1: no hit
};

// Primary visibility by rays through the centres of the pixels within the settings' bounds: the nearest
// triangle, between the near and the far plane, of a part that the camera sees, on a side that is not
// culled; the other pixels hit nothing. Of the other settings only the interleaving counts: a pixel
// between the samples shows what the nearest sample shows; with error control only where the samples
// around it show one triangle or nothing, elsewhere its ray is traced.
RayCounters castPrimaryRays(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, PrimaryHits& hits);

// The secondary image: for each pixel of the camera's viewport, row 0 at the bottom, the radiance
// to add (rgb) and the share of the primary colour that stays (a). Pixels without mirror or glass
// are (0, 0, 0, 1).
struct SecondaryImage
{
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> pixels;
};

// Which light of a pixel is wanted.
enum class Wanted : std::uint8_t
{
  Everything,   // the finished colour, alpha 1; (0, 0, 0, 0) where there is no hit
  SecondaryOnly // what is to be added to a primary image: see SecondaryImage
};

// Of a pixel that nothing is traced for.
inline glm::vec4 noLight(Wanted wanted)
{
  return { 0.0f, 0.0f, 0.0f, wanted == Wanted::Everything ? 0.0f : 1.0f };
}

// What became of the pixels whose ray does not meet the triangle that the rasteriser named; all 0 with
// Multisampling::Clamp.
struct MultisamplingCounts
{
  std::uint64_t failed = 0;       // the pixel's own triangle is not met
  std::uint64_t repaired = 0;     // another pixel's triangle is shown instead
  std::uint64_t interpolated = 0; // coloured from the pixels around it
  std::uint64_t unresolved = 0;   // left without colour

  MultisamplingCounts& operator+=(const MultisamplingCounts& o)
  {
    this->failed += o.failed;
    this->repaired += o.repaired;
    this->interpolated += o.interpolated;
    this->unresolved += o.unresolved;
    return *this;
  }
};

// How the pixels that show something wanted got their colour.
struct InterleaveCounts
{
  std::uint64_t traced = 0;
  std::uint64_t interpolated = 0; // from the samples around them

  InterleaveCounts& operator+=(const InterleaveCounts& o)
  {
    this->traced += o.traced;
    this->interpolated += o.interpolated;
    return *this;
  }
};

struct SecondaryResult
{
  RayCounters rays;
  MultisamplingCounts multisampling;
  InterleaveCounts interleave;
  std::uint64_t pixels = 0;     // that show a mirror or glass, traced
  std::uint64_t invalidIds = 0;

  SecondaryResult& operator+=(const SecondaryResult& o)
  {
    this->rays += o.rays;
    this->multisampling += o.multisampling;
    this->interleave += o.interleave;
    this->pixels += o.pixels;
    this->invalidIds += o.invalidIds;
    return *this;
  }
};

// The visible share of one light at every pixel with a valid id, 1 lit to 0 in shadow, NaN elsewhere;
// by shadow rays or from the settings' shadow maps. With tinted shadows the mean over the colours.
std::vector<float> castShadowRays(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, std::size_t light);

} // namespace hrt
