// The shadow of one light, asked for alone.
#include "Rendering/Core/Tracing/Tracer.h"

#include "Rendering/Core/Tracing/TileTracer.h"

#include <tbb/parallel_for.h>

#include <limits>

namespace hrt
{

std::vector<float> castShadowRays(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, std::size_t light)
{
  const Camera& camera = snapshot.camera;
  std::vector<float> shares(std::size_t(camera.width) * camera.height,
    std::numeric_limits<float>::quiet_NaN());
  const TracedFrame frame(snapshot, structure, settings);
  tbb::parallel_for(0, camera.height, [&](int row) {
    for (int column = 0; column < camera.width; ++column)
    {
      const std::size_t pixel = std::size_t(row) * camera.width + column;
      const Ray ray = frame.primaryRay(static_cast<std::uint32_t>(pixel));
      Hit hit;
      if (ids[pixel] != 0 && ids[pixel] <= snapshot.triangleCount &&
        frame.surfaces.primaryHit(ids[pixel] - 1, ray, hit))
      {
        shares[pixel] =
          frame.lighting.visibleShare(frame.surfaces.at(hit, ray.direction), light);
      }
    }
  });
  return shares;
}

} // namespace hrt
