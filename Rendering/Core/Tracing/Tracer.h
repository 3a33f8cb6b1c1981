// The Whitted tracer for secondary rays: what a mirror shows and what is seen through glass. It
// starts where the rasterised primary image ends, from a pixel and the triangle visible there, and
// returns what has to be composited onto that pixel. Shading is the shared source (Shading.h), so a
// surface looks the same directly and in a mirror.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"

#include <cstdint>
#include <vector>

namespace hrt
{

struct TracerSettings
{
  int maximumDepth = 3;     // bounces; a ray that would be the (n+1)th adds nothing
  bool shadows = true;      // shadow rays at the hits
  bool reflections = true;
  bool refractions = true;
};

// Rays by class, for the statistics: how many were asked for and how many had to be traced;
// asked == answered + traced.
struct RayCount
{
  std::uint64_t asked = 0;
  // Without tracing: shadow rays of a surface turned from the light or a term that is zero; other
  // rays beyond the maximum depth or with a weight below 1/512 of the pixel.
  std::uint64_t answered = 0;
  std::uint64_t traced = 0;
};

struct RayCounters
{
  RayCount reflection;
  RayCount refraction;
  RayCount shadow;
};

// The secondary image: for each pixel of the camera's viewport, row 0 at the bottom, the radiance
// to add (rgb) and the share of the primary colour that stays (a). Pixels without mirror or glass
// are (0, 0, 0, 1).
struct SecondaryImage
{
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> pixels;
};

// Traces reflection and refraction for every pixel whose triangle belongs to a mirror or to glass.
// `ids`: width x height triangle numbers plus one, as in the object intersection buffer (0: no
// hit); ids out of range are treated as no hit and counted in `invalidIds`. A material that is both
// mirror and glass is glass. The result does not depend on the number of threads.
struct SecondaryResult
{
  RayCounters rays;
  std::uint64_t pixels = 0;     // with at least one secondary ray
  std::uint64_t invalidIds = 0;
};
SecondaryResult traceSecondary(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, SecondaryImage& image);

} // namespace hrt
