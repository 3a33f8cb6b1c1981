// The tracer's pictures for tests that have all ids at hand.
#pragma once

#include "Rendering/Core/Tracing/ImageTracer.h"

#include <cstdint>

namespace hrt
{

// What is to be added to a primary image, and the share of it that stays: see SecondaryImage.
inline SecondaryResult traceSecondary(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, SecondaryImage& image)
{
  return ImageTracer(snapshot, structure, settings, Wanted::SecondaryOnly, ids, image).finish();
}

// The whole picture.
inline SecondaryResult traceImage(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, SecondaryImage& image)
{
  return ImageTracer(snapshot, structure, settings, Wanted::Everything, ids, image).finish();
}

} // namespace hrt
