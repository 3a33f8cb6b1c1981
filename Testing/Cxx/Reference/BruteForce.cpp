// See BruteForce.h.
#include "Testing/Cxx/Reference/BruteForce.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hrt
{
namespace reference
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Triangle
{
  TriangleId id;
  glm::dvec3 a, b, c;            // relative to the snapshot's origin
  int left, right, bottom, top;  // pixels whose rays are tried, inclusive
};

// Pixel box of a triangle, one pixel wider; the whole picture when a corner is not in front.
void fitBox(const glm::dmat4& toClip, const Camera& camera, Triangle& triangle)
{
  double lower[2] = { kInfinity, kInfinity };
  double upper[2] = { -kInfinity, -kInfinity };
  for (const glm::dvec3& corner : { triangle.a, triangle.b, triangle.c })
  {
    const glm::dvec4 clip = toClip * glm::dvec4(corner, 1.0);
    if (!(clip.w > 0.0))
    {
      lower[0] = lower[1] = -kInfinity;
      upper[0] = upper[1] = kInfinity;
      break;
    }
    const double size[2] = { double(camera.width), double(camera.height) };
    for (int k = 0; k < 2; ++k)
    {
      const double pixel = (clip[k] / clip.w * 0.5 + 0.5) * size[k];
      lower[k] = std::min(lower[k], pixel);
      upper[k] = std::max(upper[k], pixel);
    }
  }
  const auto fit = [](double value, int size) {
    return static_cast<int>(std::clamp(std::floor(value), -1.0, double(size)));
  };
  triangle.left = std::max(0, fit(lower[0] - 1.0, camera.width));
  triangle.right = std::min(camera.width - 1, fit(upper[0] + 1.0, camera.width));
  triangle.bottom = std::max(0, fit(lower[1] - 1.0, camera.height));
  triangle.top = std::min(camera.height - 1, fit(upper[1] + 1.0, camera.height));
}

std::vector<Triangle> gather(const Snapshot& snapshot)
{
  const Camera& camera = snapshot.camera;
  const glm::dmat4 toClip = camera.viewToClip * camera.worldToView;
  std::vector<Triangle> triangles;
  for (const Part& part : snapshot.parts)
  {
    if (!part.visibleToCamera)
    {
      continue;
    }
    const glm::dmat4 toWorld = part.positionsToWorld();
    for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
    {
      const auto local = part.geometry->cornerPositions(i);
      glm::dvec3 corner[3];
      for (int k = 0; k < 3; ++k)
      {
        corner[k] =
          glm::dvec3(toWorld * glm::dvec4(glm::dvec3(local[k]), 1.0)) - snapshot.origin;
      }
      Triangle triangle{ part.firstTriangle + static_cast<TriangleId>(i), corner[0], corner[1],
        corner[2], 0, 0, 0, 0 };
      glm::dmat4 fromScene = toClip;
      fromScene[3] = toClip * glm::dvec4(snapshot.origin, 1.0);
      fitBox(fromScene, camera, triangle);
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

// The line of the ray passes inside when the three signed volumes that it spans with the edges have
// one sign; their ratios are the barycentrics.
bool meets(const glm::dvec3& origin, const glm::dvec3& direction, const Triangle& triangle,
  double& t, double& u, double& v)
{
  const glm::dvec3 a = triangle.a - origin;
  const glm::dvec3 b = triangle.b - origin;
  const glm::dvec3 c = triangle.c - origin;
  const double wa = glm::dot(direction, glm::cross(b, c));
  const double wb = glm::dot(direction, glm::cross(c, a));
  const double wc = glm::dot(direction, glm::cross(a, b));
  const bool inside = (wa >= 0 && wb >= 0 && wc >= 0) || (wa <= 0 && wb <= 0 && wc <= 0);
  const double sum = wa + wb + wc;
  if (!inside || sum == 0.0)
  {
    return false;
  }
  u = wb / sum;
  v = wc / sum;
  const glm::dvec3 point = a + u * (b - a) + v * (c - a);
  t = glm::dot(point, direction) / glm::dot(direction, direction);
  return t > 0.0;
}

bool betweenClipPlanes(const glm::dmat4& sceneToClip, const glm::dvec3& point)
{
  const glm::dvec4 clip = sceneToClip * glm::dvec4(point, 1.0);
  return clip.z >= -clip.w && clip.z <= clip.w;
}

} // namespace

std::vector<Pixel> bruteForce(const Snapshot& snapshot)
{
  const Camera& camera = snapshot.camera;
  const std::vector<Triangle> triangles = gather(snapshot);
  const CameraRays rays = camera.worldRays(snapshot.origin);
  glm::dmat4 sceneToClip = camera.viewToClip * camera.worldToView;
  sceneToClip[3] = sceneToClip * glm::dvec4(snapshot.origin, 1.0);

  std::vector<Pixel> pixels(std::size_t(camera.width) * camera.height);
  // A thread owns a band of rows and tries every triangle with the band's rays.
  tbb::parallel_for(tbb::blocked_range<int>(0, camera.height, 16), [&](const auto& band) {
    for (const Triangle& triangle : triangles)
    {
      for (int y = std::max(band.begin(), triangle.bottom);
           y <= std::min(band.end() - 1, triangle.top); ++y)
      {
        for (int x = triangle.left; x <= triangle.right; ++x)
        {
          const double nx = (x + 0.5) / camera.width * 2.0 - 1.0;
          const double ny = (y + 0.5) / camera.height * 2.0 - 1.0;
          const glm::dvec3 origin = rays.origin(nx, ny);
          const glm::dvec3 direction = rays.direction(nx, ny);
          double t, u, v;
          if (!meets(origin, direction, triangle, t, u, v) ||
            !betweenClipPlanes(sceneToClip, origin + t * direction))
          {
            continue;
          }
          Pixel& pixel = pixels[std::size_t(y) * camera.width + x];
          if (pixel.triangle == kNoTriangle)
          {
            pixel = { triangle.id, t, u, v, kInfinity };
          }
          else if (t <= pixel.t) // triangles come by rising number
          {
            pixel = { triangle.id, t, u, v, (pixel.t - t) / t };
          }
          else
          {
            pixel.gap = std::min(pixel.gap, (t - pixel.t) / pixel.t);
          }
        }
      }
    }
  });
  return pixels;
}

} // namespace reference
} // namespace hrt
