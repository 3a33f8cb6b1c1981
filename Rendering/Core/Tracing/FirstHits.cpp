// Implements the first hits. All tests are the exact kernel's, on the exact primary ray.
#include "Rendering/Core/Tracing/FirstHits.h"

#include <algorithm>

namespace hrt
{

FirstHits::FirstHits(const Snapshot& snapshot, const Surfaces& surfaces, const CameraOrder& order,
  Multisampling mode)
  : Scene(snapshot)
  , Points(surfaces)
  , Order(order)
  , Mode(mode)
  , Planes(snapshot)
{
}

void FirstHits::gather(
  const std::uint32_t* ids, std::uint32_t pixel, Candidates& candidates) const
{
  candidates.count = 0;
  const auto add = [&](std::uint32_t id) {
    const auto end = candidates.triangles.begin() + candidates.count;
    if (this->isTriangle(id) && std::find(candidates.triangles.begin(), end, id - 1) == end)
    {
      candidates.triangles[candidates.count++] = id - 1;
    }
  };
  add(ids[pixel]);
  const int reach = reachOf(this->Mode);
  const int width = this->Scene.camera.width, height = this->Scene.camera.height;
  const int column = static_cast<int>(pixel) % width, row = static_cast<int>(pixel) / width;
  for (int y = std::max(row - reach, 0); y <= std::min(row + reach, height - 1); ++y)
  {
    for (int x = std::max(column - reach, 0); x <= std::min(column + reach, width - 1); ++x)
    {
      add(ids[std::size_t(y) * width + x]);
    }
  }
}

FirstHits::Outcome FirstHits::find(const std::uint32_t* ids, std::uint32_t pixel, const Ray& ray,
  Hit& hit, Surfaces::Located& where, MultisamplingCounts& counts) const
{
  const std::uint32_t own = ids[pixel];
  const bool named = this->isTriangle(own);
  const bool always = testsAlways(this->Mode);
  if (!named && !always)
  {
    return Outcome::Nothing;
  }
  if (this->Mode == Multisampling::Clamp)
  {
    return this->Points.primaryHit(own - 1, ray, hit, where) ? Outcome::Found : Outcome::Nothing;
  }
  const ShearedRay exact(ray.origin, ray.direction);
  const bool met = named && this->Points.exactHit(own - 1, exact, ray.tMaximum, hit);
  counts.failed += named && !met ? 1 : 0;
  if (met && !always)
  {
    return Outcome::Found;
  }
  // The rasteriser vouches for the pixel's own triangle only: a neighbour's may be cut off here by the
  // near or the far plane. Its sides need no check: a plane shows the same side to all pixels.
  Hit best = met ? hit : Hit();
  double first = 0.0, last = 0.0;
  if (reachOf(this->Mode) > 0 && this->Planes.between(ray, first, last))
  {
    Candidates candidates;
    this->gather(ids, pixel, candidates);
    for (int i = named ? 1 : 0; i < candidates.count; ++i)
    {
      Hit other;
      if (this->Points.exactHit(candidates.triangles[i], exact, last, other) &&
        other.t >= first && !this->Points.isHole(other, ray.direction) &&
        (!best.valid() || this->Order.hides(ray, other, best)))
      {
        best = other;
      }
    }
  }
  if (!best.valid())
  {
    return named ? Outcome::Missed : Outcome::Nothing;
  }
  counts.repaired += !met || best.triangle != hit.triangle ? 1 : 0;
  hit = best;
  return Outcome::Found;
}

} // namespace hrt
