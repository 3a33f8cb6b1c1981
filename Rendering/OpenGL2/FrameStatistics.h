// What one frame did, in numbers: filled by FrameRenderer, told to scripts by StatisticsReport.
#pragma once

#include "Rendering/Core/Plan/FramePlan.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <array>
#include <cstdint>

namespace hrt
{
namespace gl
{

struct FrameStatistics
{
  FramePlan plan;
  std::array<double, kStageCount> milliseconds{}; // of the host, 0 for stages that did not run
  RayCounters rays;
  MultisamplingCounts multisampling;
  InterleaveCounts interleave;
  StructureReport structure;
  int shadowMapResolution = 0; // texels along a side, as memory allowed
  std::uint64_t secondaryPixels = 0;
  std::uint64_t invalidIds = 0;
  std::uint64_t trianglesDrawn = 0; // rasterised, shadow maps included
  std::uint64_t bytesReadBack = 0;
  std::uint64_t bytesUploaded = 0;
};

} // namespace gl
} // namespace hrt
