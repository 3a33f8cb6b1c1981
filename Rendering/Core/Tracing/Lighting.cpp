// Implements lighting with shadow rays.
#include "Rendering/Core/Tracing/Lighting.h"

#include "Rendering/Core/Shading/Lighting.h"

namespace hrt
{

Lighting::Lighting(
  const Snapshot& snapshot, const Structure& structure, const TracerSettings& settings)
  : Scene(snapshot)
  , Rays(structure)
  , Settings(settings)
{
  const CameraRays rays = snapshot.camera.worldRays(snapshot.origin);
  this->HasEye = rays.originX == glm::dvec3(0.0) && rays.originY == glm::dvec3(0.0);
  this->Eye = rays.origin0;
  for (const Light& light : snapshot.lights)
  {
    this->Lights.push_back(shadingLight(light, snapshot.singleHeadlight, glm::dmat4(1.0)));
  }
}

// Single precision never sees a large coordinate: the light is placed relative to the point.
shading::HrtLight Lighting::lightFrom(const SurfacePoint& point, std::size_t index) const
{
  shading::HrtLight light = this->Lights[index];
  light.position =
    glm::vec3(this->Scene.lights[index].position - this->Scene.origin - point.position);
  return light;
}

glm::vec3 Lighting::shade(
  const SurfacePoint& point, const glm::dvec3& direction, RayCount& shadowRays) const
{
  if (!point.material->lit || this->Scene.lights.empty())
  {
    return shading::hrtUnlit(point.colors);
  }
  return point.colors.ambient + this->sumOfLights(point, point.colors, direction, shadowRays);
}

glm::vec3 Lighting::highlights(
  const SurfacePoint& point, const glm::dvec3& direction, RayCount& shadowRays) const
{
  if (!point.material->lit)
  {
    return glm::vec3(0.0f);
  }
  shading::HrtSurface colors = point.colors;
  colors.ambient = colors.diffuse = glm::vec3(0.0f);
  return this->sumOfLights(point, colors, direction, shadowRays);
}

glm::vec3 Lighting::sumOfLights(const SurfacePoint& point, const shading::HrtSurface& colors,
  const glm::dvec3& direction, RayCount& shadowRays) const
{
  const glm::vec3 here(0.0f);
  const glm::vec3 normal(point.normal), toViewer(-direction);
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < this->Lights.size(); ++i)
  {
    const glm::vec3 term =
      shading::hrtShadeLight(colors, this->lightFrom(point, i), here, normal, toViewer);
    if (!this->Settings.shadows)
    {
      sum += term;
      continue;
    }
    ++shadowRays.asked;
    if (term == glm::vec3(0.0f))
    {
      ++shadowRays.answered;
    }
    else if (!this->shadowed(point, this->Scene.lights[i], shadowRays))
    {
      sum += term;
    }
  }
  return sum;
}

// Every call answers or traces exactly one ray.
bool Lighting::shadowed(
  const SurfacePoint& point, const Light& light, RayCount& shadowRays) const
{
  const bool positional = light.kind == Light::Kind::Positional;
  const glm::dvec3 toLight =
    positional ? light.position - this->Scene.origin - point.position : -light.direction;
  if (!(glm::dot(point.geometricNormal, toLight) > 0.0))
  {
    ++shadowRays.answered; // the viewer's side lies in the shadow of its own surface
    return true;
  }
  Ray ray = leave(point, toLight);
  if (positional)
  {
    ray.direction = light.position - this->Scene.origin - ray.origin; // ends exactly at the light
    ray.tMaximum = 1.0;
  }
  else if (light.isHeadlight && this->HasEye)
  {
    // Shines from the camera's plane on: what is behind the camera casts no shadow.
    ray.tMaximum = glm::dot(ray.origin - this->Eye, light.direction);
    if (!(ray.tMaximum > 0.0))
    {
      ++shadowRays.answered;
      return false;
    }
  }
  ++shadowRays.traced;
  return this->Rays.occluded(ray);
}

} // namespace hrt
