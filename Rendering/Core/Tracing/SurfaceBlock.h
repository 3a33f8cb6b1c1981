// Up to eight points of surfaces, evaluated side by side: what Surfaces::at says of one. Where each ray meets
// its triangle is either given or found here.
#pragma once

#include "Rendering/Core/Surface/SurfaceKernels.h"
#include "Rendering/Core/Tracing/Surface.h"

#include <array>
#include <cstddef>

namespace hrt
{

class SurfaceBlock
{
public:
  static constexpr unsigned int kLanes = kSurfaceLanes;

  // The surfaces must outlive it.
  explicit SurfaceBlock(
    const Surfaces& surfaces, const SurfaceKernels& kernels = surfaceKernelsFor(bestInstructionSet()));

  // The rays through the centres of so many pixels, whose numbers are lanes().pixel.
  void pixelRays(const PixelRays& camera, unsigned int count);
  Ray ray(unsigned int lane) const;
  void setDirection(unsigned int lane, const glm::dvec3& direction);

  // Puts a triangle into a lane; then where it is met, unless `meet` finds that out.
  void set(unsigned int lane, TriangleId triangle);
  void setHit(unsigned int lane, const Hit& hit);

  // primaryHit, or exactHit, of the first `count` lanes, which have rays and triangles. Bits of those that meet.
  unsigned int meet(unsigned int count, bool exactly);
  Hit hit(unsigned int lane) const;

  // The surfaces of those of the first `count` lanes, `bits` not zero, without edges. Seen from `eye`, or,
  // where there is none, along the rays.
  void evaluate(unsigned int count, unsigned int bits, const glm::dvec3* eye);

  const Part& part(unsigned int lane) const { return *this->Sites[lane].part; }
  std::size_t partIndex(unsigned int lane) const { return this->Sites[lane].index; }
  bool isFront(unsigned int lane) const { return ((this->Lanes.front >> lane) & 1u) != 0; }
  const SurfaceColoring& coloring(unsigned int lane) const { return this->Colorings[lane]; }
  glm::dvec3 position(unsigned int lane) const { return vectorOf(this->Lanes.position, lane); }
  glm::dvec3 geometricNormal(unsigned int lane) const
  {
    return vectorOf(this->Lanes.geometricNormal, lane);
  }

  // All of one.
  SurfacePoint point(unsigned int lane) const;

  SurfaceLanes& lanes() { return this->Lanes; }
  const SurfaceKernels& kernels() const { return this->Kernels; }

  template <class T>
  static glm::vec<3, T> vectorOf(const T (&from)[3][kLanes], unsigned int lane)
  {
    return { from[0][lane], from[1][lane], from[2][lane] };
  }
  template <class T>
  static void setVector(T (&to)[3][kLanes], unsigned int lane, const glm::vec<3, T>& value)
  {
    to[0][lane] = value.x;
    to[1][lane] = value.y;
    to[2][lane] = value.z;
  }

private:
  void repeat(unsigned int lane, unsigned int of);

  const Surfaces& Points;
  const SurfaceKernels& Kernels;
  SurfaceLanes Lanes{};
  std::array<Surfaces::Site, kLanes> Sites;
  std::array<SurfaceColoring, kLanes> Colorings;
};

} // namespace hrt
