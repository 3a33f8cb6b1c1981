// Implements the Whitted tracer: Turner Whitted, "An Improved Illumination Model for Shaded
// Display", Communications of the ACM 23(6), 1980. Each pixel is traced on its own by recursion and
// in a fixed order of additions; threads share nothing but read-only data, and their counters are
// whole numbers. The image is therefore the same, bit by bit, for any number of threads.
#include "Rendering/Core/Tracing/Tracer.h"

#include "Rendering/Core/Tracing/Fresnel.h"
#include "Rendering/Core/Tracing/Lighting.h"
#include "Rendering/Core/Tracing/Surface.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace hrt
{

namespace
{

// A ray whose result counts less than half an 8-bit step is not traced. Where nothing is brighter
// than 1, each such ray changes its pixel by less than this.
constexpr double kLeastWeight = 1.0 / 512.0;

// A ray goes straight through at most so many translucent surfaces, then sees the background. Their
// opacities would have to be below 9 % each for the rest to weigh more than kLeastWeight.
constexpr int kMostLayers = 64;

// How a ray came about.
struct Path
{
  RayCount RayCounters::*kind = &RayCounters::reflection;
  int bounces = 1;     // reflections and refractions so far, this one included
  int layers = 0;      // translucent surfaces passed since
  double weight = 1.0; // bound of its share in the pixel
};

float largest(const glm::vec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

// What becomes of a ray at a glass surface.
struct Boundary
{
  glm::dvec3 reflected;
  glm::dvec3 refracted{ 0.0 };
  double reflectance = 1.0; // 1: nothing is refracted
};

// An interpolated normal may be turned away from the viewer where the face is not.
glm::dvec3 normalTowardsViewer(const SurfacePoint& point, const glm::dvec3& direction)
{
  return glm::dot(point.opticalNormal, direction) < 0.0 ? point.opticalNormal
                                                        : point.geometricNormal;
}

// By the shading normal, or by the face's own where that would lead below the surface.
glm::dvec3 mirrorDirection(const SurfacePoint& point, const glm::dvec3& direction)
{
  const glm::dvec3 smooth = reflected(direction, normalTowardsViewer(point, direction));
  return glm::dot(smooth, point.geometricNormal) > 0.0
    ? smooth
    : reflected(direction, point.geometricNormal);
}

Boundary boundaryAt(const SurfacePoint& point, const glm::dvec3& direction)
{
  Boundary boundary;
  boundary.reflected = mirrorDirection(point, direction);
  const double index = point.material->indexOfRefraction;
  const double eta = point.outside ? 1.0 / index : index;
  glm::dvec3 normal = normalTowardsViewer(point, direction);
  if (!refracted(direction, normal, eta, boundary.refracted))
  {
    return boundary;
  }
  if (!(glm::dot(boundary.refracted, point.geometricNormal) < 0.0))
  {
    normal = point.geometricNormal; // the smooth direction does not cross the face
    if (!refracted(direction, normal, eta, boundary.refracted))
    {
      return boundary;
    }
  }
  boundary.reflectance = fresnelReflectance(-glm::dot(direction, normal), eta);
  return boundary;
}

// Traces the rays of one pixel after the other; one per task.
class Whitted
{
public:
  Whitted(const Snapshot& snapshot, const Structure& structure, const TracerSettings& settings,
    const Surfaces& surfaces, const Lighting& lighting, RayCounters& counters)
    : Scene(snapshot)
    , Rays(structure)
    , Settings(settings)
    , Points(surfaces)
    , Lights(lighting)
    , Counters(counters)
  {
  }

  bool isMirror(const Material& material) const
  {
    return material.isMirror() && this->Settings.reflections && !this->isGlass(material);
  }
  bool isGlass(const Material& material) const
  {
    return material.isGlass() && this->Settings.refractions;
  }

  // The pixel of the secondary image for a surface that is a mirror or glass and is seen directly.
  glm::vec4 pixel(const SurfacePoint& point, const glm::dvec3& direction)
  {
    Path eye;
    eye.bounces = 0;
    if (this->isGlass(*point.material))
    {
      return glm::vec4(this->glass(point, direction, eye), 0.0f);
    }
    const float share = point.material->reflectance;
    return glm::vec4(share * this->mirrored(point, direction, eye), 1.0f - share);
  }

private:
  glm::vec3 background(const glm::dvec3& direction) const
  {
    const Background& b = this->Scene.background;
    const float height =
      0.5f * (1.0f + static_cast<float>(glm::dot(glm::normalize(direction), glm::dvec3(b.up))));
    return glm::mix(b.bottom, b.top, glm::clamp(height, 0.0f, 1.0f));
  }

  // What the ray's path sees, or nothing when the ray is too deep or weighs too little.
  glm::vec3 follow(const Ray& ray, const Path& path)
  {
    RayCount& count = this->Counters.*path.kind;
    ++count.asked;
    if (path.bounces > this->Settings.maximumDepth || path.weight < kLeastWeight)
    {
      ++count.answered;
      return glm::vec3(0.0f);
    }
    ++count.traced;
    const Hit hit = this->Rays.intersect(ray);
    return hit.valid() ? this->seen(this->Points.at(hit, ray.direction), ray.direction, path)
                       : this->background(ray.direction);
  }

  // The colour of a surface that a ray has met; all directions from here on are unit vectors.
  glm::vec3 seen(const SurfacePoint& point, const glm::dvec3& direction, const Path& path)
  {
    if (this->isGlass(*point.material))
    {
      return this->glass(point, direction, path);
    }
    glm::vec3 color = this->Lights.shade(point, direction, this->Counters.shadow);
    if (this->isMirror(*point.material))
    {
      Path opaque = path;
      opaque.weight *= point.opacity;
      color =
        glm::mix(color, this->mirrored(point, direction, opaque), point.material->reflectance);
    }
    if (point.opacity >= 1.0f)
    {
      return color;
    }
    return point.opacity * color + (1.0f - point.opacity) * this->behind(point, direction, path);
  }

  // What lies straight behind a translucent surface. Counted with the ray that it prolongs.
  glm::vec3 behind(const SurfacePoint& point, const glm::dvec3& direction, Path path)
  {
    if (++path.layers > kMostLayers)
    {
      return this->background(direction);
    }
    path.weight *= 1.0 - point.opacity;
    return this->follow(leave(point, direction), path);
  }

  // The mirror image at a point, not yet multiplied by the reflectance.
  glm::vec3 mirrored(const SurfacePoint& point, const glm::dvec3& direction, const Path& path)
  {
    return this->follow(leave(point, mirrorDirection(point, direction)),
      bounce(path, &RayCounters::reflection, point.material->reflectance));
  }

  // Without reflections the light that glass would reflect goes the way of the refracted; where
  // everything is reflected nothing is left.
  glm::vec3 glass(const SurfacePoint& point, const glm::dvec3& direction, const Path& path)
  {
    const Boundary boundary = boundaryAt(point, direction);
    glm::vec3 color = this->Lights.highlights(point, direction, this->Counters.shadow);
    if (this->Settings.reflections)
    {
      color += static_cast<float>(boundary.reflectance) *
        this->follow(leave(point, boundary.reflected),
          bounce(path, &RayCounters::reflection, boundary.reflectance));
    }
    if (boundary.reflectance < 1.0)
    {
      const double share = this->Settings.reflections ? 1.0 - boundary.reflectance : 1.0;
      const glm::vec3 tint = static_cast<float>(share) * point.diffuseColor;
      color += tint *
        this->follow(leave(point, boundary.refracted),
          bounce(path, &RayCounters::refraction, largest(tint)));
    }
    return color;
  }

  static Path bounce(const Path& path, RayCount RayCounters::*kind, double share)
  {
    return { kind, path.bounces + 1, 0, path.weight * share };
  }

  const Snapshot& Scene;
  const Structure& Rays;
  const TracerSettings& Settings;
  const Surfaces& Points;
  const Lighting& Lights;
  RayCounters& Counters;
};

void add(RayCount& to, const RayCount& from)
{
  to.asked += from.asked;
  to.answered += from.answered;
  to.traced += from.traced;
}

SecondaryResult sum(SecondaryResult a, const SecondaryResult& b)
{
  add(a.rays.reflection, b.rays.reflection);
  add(a.rays.refraction, b.rays.refraction);
  add(a.rays.shadow, b.rays.shadow);
  a.pixels += b.pixels;
  a.invalidIds += b.invalidIds;
  return a;
}

// The primary ray through a pixel's centre.
Ray primaryRay(const CameraRays& rays, const Camera& camera, int column, int row)
{
  const double x = (column + 0.5) / camera.width * 2.0 - 1.0;
  const double y = (row + 0.5) / camera.height * 2.0 - 1.0;
  Ray ray;
  ray.origin = rays.origin(x, y);
  ray.direction = glm::normalize(rays.direction(x, y));
  return ray;
}

// Everything that the pixels share.
struct Frame
{
  const Snapshot& snapshot;
  const Structure& structure;
  const TracerSettings& settings;
  const std::uint32_t* ids;
  SecondaryImage& image;
  Surfaces surfaces;
  Lighting lighting;
  CameraRays rays;

  void traceRow(int row, SecondaryResult& result) const
  {
    Whitted whitted(this->snapshot, this->structure, this->settings, this->surfaces,
      this->lighting, result.rays);
    for (int column = 0; column < this->image.width; ++column)
    {
      const std::size_t pixel = std::size_t(row) * this->image.width + column;
      this->tracePixel(whitted, pixel, column, row, result);
    }
  }

  void tracePixel(
    Whitted& whitted, std::size_t pixel, int column, int row, SecondaryResult& result) const
  {
    if (this->ids[pixel] == 0)
    {
      return;
    }
    const TriangleId id = this->ids[pixel] - 1;
    if (id >= this->snapshot.triangleCount)
    {
      ++result.invalidIds;
      return;
    }
    const Material& material = this->snapshot.parts[this->snapshot.partOf(id)].material;
    if (!whitted.isMirror(material) && !whitted.isGlass(material))
    {
      return;
    }
    const Ray ray = primaryRay(this->rays, this->snapshot.camera, column, row);
    Hit hit;
    if (this->surfaces.primaryHit(id, ray, hit))
    {
      ++result.pixels;
      this->image.pixels[pixel] =
        whitted.pixel(this->surfaces.at(hit, ray.direction), ray.direction);
    }
  }
};

} // namespace

SecondaryResult traceSecondary(const Snapshot& snapshot, const Structure& structure,
  const TracerSettings& settings, const std::uint32_t* ids, SecondaryImage& image)
{
  image.width = snapshot.camera.width;
  image.height = snapshot.camera.height;
  image.pixels.assign(
    std::size_t(image.width) * image.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  const Frame frame{ snapshot, structure, settings, ids, image, Surfaces(snapshot),
    Lighting(snapshot, structure, settings), snapshot.camera.worldRays(snapshot.origin) };
  if (settings.maximumDepth <= 0)
  {
    return {};
  }
  return tbb::parallel_reduce(
    tbb::blocked_range<int>(0, image.height), SecondaryResult{},
    [&frame](const tbb::blocked_range<int>& rows, SecondaryResult result) {
      for (int row = rows.begin(); row < rows.end(); ++row)
      {
        frame.traceRow(row, result);
      }
      return result;
    },
    sum);
}

} // namespace hrt
