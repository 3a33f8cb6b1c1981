// From a pixel's number in the object intersection buffer to the point that its ray meets: where the
// rasteriser's answer is checked and repaired, by the rules of Multisampling.h.
#pragma once

#include "Rendering/Core/Tracing/CameraOrder.h"
#include "Rendering/Core/Tracing/ClipPlanes.h"
#include "Rendering/Core/Tracing/Surface.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <array>
#include <cstdint>

namespace hrt
{

class FirstHits
{
public:
  // The first three must outlive it.
  FirstHits(const Snapshot& snapshot, const Surfaces& surfaces, const CameraOrder& order,
    Multisampling mode);

  enum class Outcome
  {
    Nothing, // the pixel shows none of the triangles
    Found,
    Missed   // it shows some triangle, but the ray meets none of those that were tried
  };

  // `ids`: of the whole picture; `ray`: the pixel's own. An id out of range counts as none. `where`: perhaps
  // that of the hit's triangle afterwards.
  Outcome find(const std::uint32_t* ids, std::uint32_t pixel, const Ray& ray, Hit& hit,
    Surfaces::Located& where, MultisamplingCounts& counts) const;

  // The distinct triangles that the pixel may show, its own first. Ids out of range are left out.
  struct Candidates
  {
    std::array<TriangleId, 25> triangles;
    int count = 0;
  };
  void gather(const std::uint32_t* ids, std::uint32_t pixel, Candidates& candidates) const;

private:
  bool isTriangle(std::uint32_t id) const { return id != 0 && id <= this->Scene.triangleCount; }

  const Snapshot& Scene;
  const Surfaces& Points;
  const CameraOrder& Order;
  Multisampling Mode;
  ClipPlanes Planes;
};

} // namespace hrt
