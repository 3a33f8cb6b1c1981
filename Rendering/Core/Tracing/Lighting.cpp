// Implements lighting with shadow rays.
#include "Rendering/Core/Tracing/Lighting.h"

#include "Rendering/Core/Shading/ShadingFrame.h"
#include "Rendering/Core/Shading/ShadingLight.h"

#include <algorithm>

namespace hrt
{

namespace
{

// A shadow ray is followed through at most so many translucent surfaces and holes; beyond, it counts as
// blocked.
// Each lets less than 1 - 2^-8 of the light through or is invisible in 8 bits.
constexpr int kMostVeils = 64;

// Whether light may pass the part, or some of it. Where `tinted` is off only holes let it through.
bool isVeil(const Part& part, bool tinted)
{
  return part.visibleToRays && part.tintsShadow && (tinted || part.perforated);
}

// How a share of a light counts in a signature.
unsigned int stateOf(float share)
{
  return share == 0.0f ? 0 : share == 1.0f ? 1 : 2;
}

template <class Visit>
void forEachBit(unsigned int bits, Visit visit)
{
  for (; bits != 0; bits &= bits - 1)
  {
    visit(static_cast<unsigned int>(__builtin_ctz(bits)));
  }
}

// VTK multiplies textures with what is shaded, ambient light and highlights among it.
Lighting::Target textured(const Lighting::Target& target, const glm::vec3& texture)
{
  Lighting::Target t = target;
  t.weight *= texture;
  return t;
}

} // namespace

Lighting::Lighting(const Snapshot& snapshot, const Surfaces& surfaces, const Structure& structure,
  const TracerSettings& settings)
  : Scene(snapshot)
  , Rays(structure)
  , Settings(settings)
  , Points(surfaces)
  , Sets(snapshot, surfaces, structure, settings.refractions)
{
  const ShadingFrame frame(snapshot);
  const CameraRays rays = snapshot.camera.worldRays(snapshot.origin);
  this->HasEye = rays.originX == glm::dvec3(0.0) && rays.originY == glm::dvec3(0.0);
  this->Eye = rays.origin0;
  for (const Light& light : snapshot.lights)
  {
    this->Lights.push_back(shadingLight(light, snapshot.singleHeadlight, glm::dmat4(1.0)));
    this->LaneLights.push_back(this->laneLight(light, this->Lights.back()));
    this->FrameLights.push_back(
      shadingLight(light, snapshot.singleHeadlight, frame.fromWorld));
  }
  this->ToFrame = frame.fromWorld;
  this->ToFrame[3] = frame.fromWorld * glm::dvec4(snapshot.origin, 1.0);
  this->NormalsToFrame = glm::inverseTranspose(glm::dmat3(this->ToFrame));
  this->AnyVeil = std::any_of(snapshot.parts.begin(), snapshot.parts.end(),
    [&settings](const Part& part) { return isVeil(part, settings.tintedShadows); });
}

LaneLight Lighting::laneLight(const Light& light, const shading::HrtLight& shaded) const
{
  LaneLight l;
  const glm::dvec3 position = light.position - this->Scene.origin;
  for (int axis = 0; axis < 3; ++axis)
  {
    l.position[axis] = position[axis];
    l.directionOf[axis] = light.direction[axis];
    l.direction[axis] = shaded.direction[axis];
    l.color[axis] = shaded.color[axis];
    l.attenuation[axis] = shaded.attenuation[axis];
    l.eye[axis] = this->Eye[axis];
  }
  l.cosCone = shaded.cosCone;
  l.exponent = shaded.exponent;
  l.kind = shaded.kind;
  l.positional = light.kind == Light::Kind::Positional;
  l.fromEye = !l.positional && light.isHeadlight && this->HasEye;
  return l;
}

// Single precision never sees a large coordinate: the light is placed relative to the point.
shading::HrtLight Lighting::lightFrom(const SurfacePoint& point, std::size_t index) const
{
  shading::HrtLight light = this->Lights[index];
  light.position =
    glm::vec3(this->Scene.lights[index].position - this->Scene.origin - point.position);
  return light;
}

void Lighting::shade(const SurfacePoint& point, const glm::dvec3& toViewer,
  const Target& untextured, ShadowQueue& queue, RayCount& shadowRays) const
{
  const Target target = textured(untextured, point.textureColor);
  if (!point.material->lit || this->Scene.lights.empty())
  {
    target.sum += target.weight * shading::hrtUnlit(point.colors);
    return;
  }
  if (point.material->physical.used)
  {
    this->shadePhysically(point, toViewer, target, shadowRays);
    return;
  }
  target.sum += target.weight * point.colors.ambient;
  this->addLights(point, point.colors, toViewer, target, queue, shadowRays);
}

glm::vec3 Lighting::arrivingShare(const SurfacePoint& point, std::size_t light,
  const Target& target, RayCount& shadowRays) const
{
  if (!this->Settings.shadows)
  {
    return glm::vec3(1.0f);
  }
  const auto note = [&](unsigned int state)
  { this->note(target.signature, PathEvent::Light, target.bounces, light, state); };
  if (target.direct && this->Settings.shadowMaps)
  {
    const float share = this->shareFromMap(
      point.position, point.geometricNormal, this->Scene.parts[point.part], light);
    note(stateOf(share));
    return glm::vec3(share);
  }
  ++shadowRays.asked;
  Ray ray;
  const Sight seen = this->sight(point, this->Scene.lights[light], ray);
  if (seen != Sight::Open)
  {
    ++shadowRays.answered;
    note(seen == Sight::Free ? 1 : 0);
    return glm::vec3(seen == Sight::Free ? 1.0f : 0.0f);
  }
  ++shadowRays.traced;
  const bool blocked = this->Rays.occluded(ray);
  note(blocked ? 0 : 1);
  return blocked       ? glm::vec3(0.0f)
    : this->AnyVeil ? this->transmittance(ray, target.bounces, target.signature)
                    : glm::vec3(1.0f);
}

void Lighting::shadePhysically(const SurfacePoint& point, const glm::dvec3& toViewer,
  const Target& target, RayCount& shadowRays) const
{
  const PhysicalTerms& terms = point.material->physical;
  shading::HrtPhysical surface;
  surface.albedo = point.colors.diffuse;
  surface.metallic = terms.metallic;
  surface.roughness = terms.roughness;
  surface.f0 = terms.f0;
  surface.edgeTint = terms.edgeTint;
  surface.coat = terms.coat;
  surface.coatRoughness = terms.coatRoughness;
  surface.coatF0 = terms.coatF0;
  surface.coatColor = terms.coatColor;
  const glm::vec3 here(0.0f), normal(point.normal), viewer(toViewer);
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < this->Lights.size(); ++i)
  {
    const glm::vec3 portion =
      shading::hrtShadePhysically(surface, this->lightFrom(point, i), here, normal, viewer);
    if (portion != glm::vec3(0.0f))
    {
      sum += portion * this->arrivingShare(point, i, target, shadowRays);
    }
  }
  target.sum += target.weight * shading::hrtEncoded(sum);
}

void Lighting::highlights(const SurfacePoint& point, const glm::dvec3& toViewer,
  const Target& untextured, ShadowQueue& queue, RayCount& shadowRays) const
{
  const Target target = textured(untextured, point.textureColor);
  if (!point.material->lit)
  {
    return;
  }
  shading::HrtSurface colors = point.colors;
  colors.ambient = colors.diffuse = glm::vec3(0.0f);
  this->addLights(point, colors, toViewer, target, queue, shadowRays);
}

void Lighting::addLights(const SurfacePoint& point, const shading::HrtSurface& colors,
  const glm::dvec3& toViewer, const Target& target, ShadowQueue& queue, RayCount& shadowRays) const
{
  const glm::vec3 here(0.0f);
  const glm::vec3 normal(point.normal), viewer(toViewer);
  for (std::size_t i = 0; i < this->Lights.size(); ++i)
  {
    const glm::vec3 portion = target.weight *
      shading::hrtShadeLight(colors, this->lightFrom(point, i), here, normal, viewer);
    if (!this->Settings.shadows)
    {
      target.sum += portion;
      continue;
    }
    if (target.direct && this->Settings.shadowMaps)
    {
      if (portion != glm::vec3(0.0f))
      {
        const float share = this->shareFromMap(
          point.position, point.geometricNormal, this->Scene.parts[point.part], i);
        target.sum += portion * share;
        this->note(target.signature, PathEvent::Light, target.bounces, i, stateOf(share));
      }
      continue;
    }
    ++shadowRays.asked;
    Ray ray;
    const Sight seen = portion == glm::vec3(0.0f)
      ? Sight::Blocked
      : this->sight(point, this->Scene.lights[i], ray);
    if (seen == Sight::Open)
    {
      ++shadowRays.traced;
      queue.rays.push_back(ray);
      queue.portions.push_back(portion);
      queue.pixels.push_back(target.pixel);
      queue.lights.push_back(static_cast<std::uint32_t>(i));
      queue.bounces.push_back(static_cast<std::uint8_t>(target.bounces));
      continue;
    }
    ++shadowRays.answered;
    this->note(
      target.signature, PathEvent::Light, target.bounces, i, seen == Sight::Free ? 1 : 0);
    if (seen == Sight::Free)
    {
      target.sum += portion;
    }
  }
}

void Lighting::shade(SurfaceBlock& block, unsigned int bits, const Target* const* targets,
  ShadowQueue& queue, RayCount& shadowRays) const
{
  forEachBit(bits,
    [&](unsigned int lane)
    {
      const SurfaceColoring& coloring = block.coloring(lane);
      const Target target = textured(*targets[lane], coloring.textureColor);
      target.sum += target.weight *
        (this->Scene.lights.empty() ? shading::hrtUnlit(coloring.colors)
                                    : coloring.colors.ambient);
    });
  this->addLights(block, bits, true, targets, queue, shadowRays);
}

void Lighting::highlights(SurfaceBlock& block, unsigned int bits, const Target* const* targets,
  ShadowQueue& queue, RayCount& shadowRays) const
{
  this->addLights(block, bits, false, targets, queue, shadowRays);
}

void Lighting::addLights(SurfaceBlock& block, unsigned int bits, bool diffuse,
  const Target* const* targets, ShadowQueue& queue, RayCount& shadowRays) const
{
  SurfaceLanes& lanes = block.lanes();
  const auto first = static_cast<unsigned int>(__builtin_ctz(bits));
  for (unsigned int lane = 0; lane < SurfaceBlock::kLanes; ++lane)
  {
    const unsigned int of = ((bits >> lane) & 1u) != 0 ? lane : first;
    const SurfaceColoring& coloring = block.coloring(of);
    SurfaceBlock::setVector(
      lanes.diffuse, lane, diffuse ? coloring.colors.diffuse : glm::vec3(0.0f));
    SurfaceBlock::setVector(lanes.specular, lane, coloring.colors.specular);
    lanes.power[lane] = coloring.colors.power;
    SurfaceBlock::setVector(
      lanes.weight, lane, textured(*targets[of], coloring.textureColor).weight);
    lanes.twinReach[lane] = this->Points.coincidence().twinReach(block.partIndex(of));
  }
  for (std::size_t i = 0; i < this->Lights.size(); ++i)
  {
    const unsigned int shining = block.kernels().shade(this->LaneLights[i], lanes) & bits;
    this->addPortions(block, bits, shining, i, targets, queue, shadowRays);
  }
}

void Lighting::addPortions(SurfaceBlock& block, unsigned int bits, unsigned int shining,
  std::size_t light, const Target* const* targets, ShadowQueue& queue, RayCount& shadowRays) const
{
  SurfaceLanes& lanes = block.lanes();
  const auto portion = [&](unsigned int lane)
  { return SurfaceBlock::vectorOf(lanes.portion, lane); };
  if (!this->Settings.shadows)
  {
    forEachBit(bits, [&](unsigned int lane) { targets[lane]->sum += portion(lane); });
    return;
  }
  const auto note = [&](unsigned int lane, unsigned int state)
  {
    this->note(
      targets[lane]->signature, PathEvent::Light, targets[lane]->bounces, light, state);
  };
  if (targets[__builtin_ctz(bits)]->direct && this->Settings.shadowMaps)
  {
    forEachBit(shining,
      [&](unsigned int lane)
      {
        const float share = this->shareFromMap(
          block.position(lane), block.geometricNormal(lane), block.part(lane), light);
        targets[lane]->sum += portion(lane) * share;
        note(lane, stateOf(share));
      });
    return;
  }
  const Light& source = this->Scene.lights[light];
  // Every lane's ray is free, blocked without being traced, or open.
  unsigned int free = shining, open = 0;
  if (shining != 0 && source.castsShadows)
  {
    const LaneLight& laneLight = this->LaneLights[light];
    const unsigned int facing = block.kernels().shadowRays(laneLight, lanes) & shining;
    free = 0;
    open = facing;
    if (laneLight.fromEye)
    {
      forEachBit(facing,
        [&](unsigned int lane)
        {
          if (!(lanes.shadowEnd[lane] > 0.0))
          {
            free |= 1u << lane;
            open &= ~(1u << lane);
          }
        });
    }
  }
  const auto count = [](unsigned int lanesOf)
  { return static_cast<std::uint64_t>(__builtin_popcount(lanesOf)); };
  shadowRays.asked += count(bits);
  shadowRays.traced += count(open);
  shadowRays.answered += count(bits & ~open);
  forEachBit(free, [&](unsigned int lane) { targets[lane]->sum += portion(lane); });
  forEachBit(bits & ~open, [&](unsigned int lane) { note(lane, (free >> lane) & 1u); });
  forEachBit(open,
    [&](unsigned int lane)
    {
      Ray ray;
      ray.origin = SurfaceBlock::vectorOf(lanes.shadowOrigin, lane);
      ray.direction = SurfaceBlock::vectorOf(lanes.shadowDirection, lane);
      ray.tMaximum = lanes.shadowEnd[lane];
      ray.originTriangle = block.hit(lane).triangle;
      ray.twinEnd = lanes.twinEnd[lane];
      queue.rays.push_back(ray);
      queue.portions.push_back(portion(lane));
      queue.pixels.push_back(targets[lane]->pixel);
      queue.lights.push_back(static_cast<std::uint32_t>(light));
      queue.bounces.push_back(static_cast<std::uint8_t>(targets[lane]->bounces));
    });
}

Lighting::Sight Lighting::sight(const SurfacePoint& point, const Light& light, Ray& ray) const
{
  const bool positional = light.kind == Light::Kind::Positional;
  const glm::dvec3 toLight =
    positional ? light.position - this->Scene.origin - point.position : -light.direction;
  if (!light.castsShadows)
  {
    return Sight::Free;
  }
  if (!(glm::dot(point.geometricNormal, toLight) > 0.0))
  {
    return Sight::Blocked; // the viewer's side lies in the shadow of its own surface
  }
  ray = leave(point, toLight);
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
      return Sight::Free;
    }
  }
  return Sight::Open;
}

// A translucent surface of opacity a and colour C lets (1 - a) (1 - a + a C) of the light through:
// all of it at a = 0, none at a = 1, and the more of its colour the denser it is.
glm::vec3 Lighting::throughVeil(
  const SurfacePoint& point, int bounces, PathSignature& signature) const
{
  if (!isVeil(this->Scene.parts[point.part], this->Settings.tintedShadows))
  {
    return glm::vec3(1.0f);
  }
  this->note(signature, PathEvent::Veil, bounces, point.part, point.frontSide ? 1 : 0);
  const float a = glm::clamp(point.opacity, 0.0f, 1.0f);
  return (1.0f - a) * (1.0f - a + a * point.diffuseColor);
}

glm::vec3 Lighting::transmittance(
  const Ray& ray, int bounces, PathSignature& signature) const
{
  return this->transmittance(ray, this->Rays.intersect(ray), bounces, signature);
}

glm::vec3 Lighting::transmittance(
  Ray ray, Hit hit, int bounces, PathSignature& signature) const
{
  glm::vec3 share(1.0f);
  std::vector<Hit> members;
  for (int veil = 0; veil < kMostVeils; ++veil)
  {
    if (!hit.valid())
    {
      return share;
    }
    const SurfacePoint point = this->Points.at(hit, ray.direction);
    if (!hit.shared)
    {
      share *= this->throughVeil(point, bounces, signature);
    }
    else
    {
      this->Sets.gather(ray, hit, members);
      for (const Hit& member : members)
      {
        share *= this->throughVeil(this->Points.at(member, ray.direction), bounces, signature);
      }
    }
    const double left = ray.tMaximum - hit.t;
    ray = leave(point, ray.direction);
    ray.tMaximum = left;
    hit = this->Rays.intersect(ray);
  }
  return glm::vec3(0.0f);
}

// As the GPU's shader looks it up: in single precision, in its frame.
float Lighting::shareFromMap(const glm::dvec3& point, const glm::dvec3& geometricNormal,
  const Part& part, std::size_t light) const
{
  const ShadowMapTables& tables = *this->Settings.shadowMaps;
  const ShadowSlot& slot = tables.slots[light];
  const glm::vec3 position(this->ToFrame * glm::dvec4(point, 1.0));
  const glm::vec3 normal(glm::normalize(this->NormalsToFrame * geometricNormal));
  const float folds = part.isFlat() ? 0.0f : 1.0f;
  return shading::ShadowLookup(tables).hrtLightVisibility(
    slot.firstFace, slot.faceCount, this->FrameLights[light], position, normal, folds);
}

float Lighting::visibleShare(const SurfacePoint& point, std::size_t light) const
{
  const shading::HrtLight from = this->lightFrom(point, light);
  if (!shading::hrtInCone(from, shading::hrtLightDirectionAt(from, glm::vec3(0.0f))))
  {
    return 0.0f;
  }
  if (this->Settings.shadowMaps)
  {
    return this->shareFromMap(
      point.position, point.geometricNormal, this->Scene.parts[point.part], light);
  }
  Ray ray;
  const Sight seen = this->sight(point, this->Scene.lights[light], ray);
  if (seen != Sight::Open)
  {
    return seen == Sight::Free ? 1.0f : 0.0f;
  }
  if (this->Rays.occluded(ray))
  {
    return 0.0f;
  }
  if (!this->AnyVeil)
  {
    return 1.0f;
  }
  PathSignature unused = 0;
  const glm::vec3 share = this->transmittance(ray, 0, unused);
  return (share.x + share.y + share.z) / 3.0f;
}

void Lighting::flush(ShadowQueue& queue, RayOrder order, std::vector<glm::vec3>& sums,
  std::vector<PathSignature>& signatures) const
{
  std::vector<std::uint8_t> blocked(queue.rays.size());
  this->Rays.occluded(queue.rays.data(), blocked.data(), queue.rays.size(), order);
  std::vector<Hit> veils;
  if (this->AnyVeil)
  {
    this->findVeils(queue, blocked, order, veils);
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < queue.rays.size(); ++i)
  {
    const std::uint32_t pixel = queue.pixels[i];
    const int bounces = queue.bounces[i];
    this->note(signatures[pixel], PathEvent::Light, bounces, queue.lights[i], blocked[i] ? 0 : 1);
    if (!blocked[i])
    {
      sums[pixel] += this->AnyVeil
        ? queue.portions[i] *
          this->transmittance(queue.rays[i], veils[next++], bounces, signatures[pixel])
        : queue.portions[i];
    }
  }
  queue.clear();
}

// The first surfaces that rays meet, of those which nothing blocks; the others leave no gaps.
void Lighting::findVeils(const ShadowQueue& queue, const std::vector<std::uint8_t>& blocked,
  RayOrder order, std::vector<Hit>& veils) const
{
  std::vector<Ray> open;
  open.reserve(queue.rays.size());
  for (std::size_t i = 0; i < queue.rays.size(); ++i)
  {
    if (!blocked[i])
    {
      open.push_back(queue.rays[i]);
    }
  }
  veils.resize(open.size());
  this->Rays.intersect(open.data(), veils.data(), open.size(), order);
}

} // namespace hrt
