// The colour of a surface point under the scene's lights: the shared Phong equations, each light
// behind a shadow ray.
#pragma once

#include "Rendering/Core/Tracing/Surface.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <vector>

namespace hrt
{

class Lighting
{
public:
  // All three must outlive it.
  Lighting(const Snapshot& snapshot, const Structure& structure, const TracerSettings& settings);

  // Ambient and every light's diffuse and specular part; hrtUnlit where the material or the scene
  // has no lighting. `direction`: unit, of the ray that sees the point.
  glm::vec3 shade(
    const SurfacePoint& point, const glm::dvec3& direction, RayCount& shadowRays) const;

  // The lights' specular part alone: the highlights on glass.
  glm::vec3 highlights(
    const SurfacePoint& point, const glm::dvec3& direction, RayCount& shadowRays) const;

private:
  glm::vec3 sumOfLights(const SurfacePoint& point, const shading::HrtSurface& colors,
    const glm::dvec3& direction, RayCount& shadowRays) const;
  shading::HrtLight lightFrom(const SurfacePoint& point, std::size_t index) const;
  bool shadowed(const SurfacePoint& point, const Light& light, RayCount& shadowRays) const;

  const Snapshot& Scene;
  const Structure& Rays;
  const TracerSettings& Settings;
  std::vector<shading::HrtLight> Lights; // those of the scene, in its order
  // The eye of a perspective camera, relative to the scene's origin.
  bool HasEye = false;
  glm::dvec3 Eye{ 0.0 };
};

} // namespace hrt
