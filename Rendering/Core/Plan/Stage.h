// The stages of a frame, by the names that scripts read, and what is decided about each: whether it
// runs, and why or why not.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hrt
{

// In the order in which they run.
enum class Stage : std::uint8_t
{
  GeometryUpload,  // triangles to vertex and texture buffers
  ShadowMaps,      // depth maps as seen from the lights
  Structure,       // acceleration structure for rays
  Visibility,      // what each pixel shows: rasterised or by primary rays
  ShadowReadBack,  // shadow maps to host memory
  ReadBack,        // ids of the pixels to host memory
  PrimaryShading,  // the GPU's shader, or the tracer
  SecondaryRays,   // reflection, refraction and their shadow rays
  Blit,            // result into the window's framebuffer
  Count
};
inline constexpr std::size_t kStageCount = static_cast<std::size_t>(Stage::Count);

// The name scripts read in the statistics: snake case.
const char* stageName(Stage stage);

struct StageDecision
{
  bool run = false;
  const char* reason = ""; // why it runs or why it is skipped; a short English phrase
};

} // namespace hrt
