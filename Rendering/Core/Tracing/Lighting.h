// The colour of surface points under the scene's lights: the shared Phong equations, each light
// behind a shadow ray. Points are shaded in bulk: what needs no ray is added to its pixel at once,
// the rest waits in a queue whose rays are traced together.
#pragma once

#include "Rendering/Core/Tracing/Meeting.h"
#include "Rendering/Core/Tracing/PathSignature.h"
#include "Rendering/Core/Tracing/SurfaceBlock.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <vector>

namespace hrt
{

// Light on its way to pixels, each portion behind a ray that must reach its light unhindered.
struct ShadowQueue
{
  std::vector<Ray> rays;
  std::vector<glm::vec3> portions;    // what the pixel gains when the ray passes
  std::vector<std::uint32_t> pixels;  // index into the caller's sums
  std::vector<std::uint32_t> lights;
  std::vector<std::uint8_t> bounces;  // before the ray

  bool empty() const { return this->rays.empty(); }
  void clear()
  {
    this->rays.clear();
    this->portions.clear();
    this->pixels.clear();
    this->lights.clear();
    this->bounces.clear();
  }
};

class Lighting
{
public:
  // All four must outlive it.
  Lighting(const Snapshot& snapshot, const Surfaces& surfaces, const Structure& structure,
    const TracerSettings& settings);

  // What a point adds to a pixel, besides its own colour.
  struct Target
  {
    std::uint32_t pixel;
    glm::vec3 weight;
    glm::vec3& sum; // of the pixel
    PathSignature& signature; // likewise
    int bounces = 0;
    // The camera sees the point directly: shadow maps, where there are some, decide its shadows.
    bool direct = false;
  };

  // Ambient and every light's diffuse and specular part; hrtUnlit where the material or the scene
  // has no lighting. `toViewer`: unit, from the point to where it is seen from.
  void shade(const SurfacePoint& point, const glm::dvec3& toViewer, const Target& target,
    ShadowQueue& queue, RayCount& shadowRays) const;

  // The same for several points side by side, of lit surfaces that are not physically based: those lanes of
  // the block that `bits` has, not zero. `targets`: of each of them; all direct, or none.
  static bool goesInBlocks(const Material& material)
  {
    return material.lit && !material.physical.used;
  }
  void shade(SurfaceBlock& block, unsigned int bits, const Target* const* targets,
    ShadowQueue& queue, RayCount& shadowRays) const;

  // The lights' specular part alone: the highlights on glass.
  void highlights(const SurfacePoint& point, const glm::dvec3& toViewer, const Target& target,
    ShadowQueue& queue, RayCount& shadowRays) const;

  // Likewise side by side, of lit surfaces.
  void highlights(SurfaceBlock& block, unsigned int bits, const Target* const* targets,
    ShadowQueue& queue, RayCount& shadowRays) const;

  // Traces the queue's rays and adds what passes; the queue is empty afterwards.
  void flush(ShadowQueue& queue, RayOrder order, std::vector<glm::vec3>& sums,
    std::vector<PathSignature>& signatures) const;

  // The share of one light that reaches a point that the camera sees.
  float visibleShare(const SurfacePoint& point, std::size_t light) const;

private:
  // A physically based surface: its colour is no sum over lights, and its shadow rays are traced at once.
  void shadePhysically(const SurfacePoint& point, const glm::dvec3& toViewer,
    const Target& target, RayCount& shadowRays) const;
  // The share of a light that arrives, of a portion that is not zero.
  glm::vec3 arrivingShare(const SurfacePoint& point, std::size_t light, const Target& target,
    RayCount& shadowRays) const;
  void addLights(const SurfacePoint& point, const shading::HrtSurface& colors,
    const glm::dvec3& toViewer, const Target& target, ShadowQueue& queue,
    RayCount& shadowRays) const;
  LaneLight laneLight(const Light& light, const shading::HrtLight& shaded) const;
  shading::HrtLight lightFrom(const SurfacePoint& point, std::size_t index) const;

  enum class Sight
  {
    Free,    // known without a ray
    Blocked, // likewise
    Open     // `ray` has to be traced
  };
  Sight sight(const SurfacePoint& point, const Light& light, Ray& ray) const;
  // The lights of the block's lanes, with or without their diffuse parts.
  void addLights(SurfaceBlock& block, unsigned int bits, bool diffuse,
    const Target* const* targets, ShadowQueue& queue, RayCount& shadowRays) const;
  // What becomes of the portions that the block's lanes get of a light.
  void addPortions(SurfaceBlock& block, unsigned int bits, unsigned int shining, std::size_t light,
    const Target* const* targets, ShadowQueue& queue, RayCount& shadowRays) const;
  // Adds an event to the signature of a path, where one is asked for.
  void note(PathSignature& signature, PathEvent event, int bounces, std::uint64_t index,
    unsigned int outcome) const
  {
    if (this->Settings.interleave > 1)
    {
      signature += signatureOf(event, bounces, index, outcome);
    }
  }
  // Of a ray that nothing blocks; `hit`: the first surface that it meets.
  glm::vec3 transmittance(const Ray& ray, int bounces, PathSignature& signature) const;
  glm::vec3 transmittance(Ray ray, Hit hit, int bounces, PathSignature& signature) const;
  void findVeils(const ShadowQueue& queue, const std::vector<std::uint8_t>& blocked,
    RayOrder order, std::vector<Hit>& veils) const;
  glm::vec3 throughVeil(
    const SurfacePoint& point, int bounces, PathSignature& signature) const;
  float shareFromMap(const glm::dvec3& point, const glm::dvec3& geometricNormal, const Part& part,
    std::size_t light) const;

  const Snapshot& Scene;
  const Structure& Rays;
  const TracerSettings& Settings;
  const Surfaces& Points;
  Meetings Sets;
  std::vector<shading::HrtLight> Lights; // positions unset: see lightFrom
  std::vector<LaneLight> LaneLights; // the same
  std::vector<shading::HrtLight> FrameLights; // in the frame that shadow maps are looked up in
  glm::dmat4 ToFrame; // to it, from coordinates relative to the scene's origin
  glm::dmat3 NormalsToFrame;
  bool AnyVeil = false;
  // The eye of a perspective camera, relative to the scene's origin.
  bool HasEye = false;
  glm::dvec3 Eye{ 0.0 };
};

} // namespace hrt
