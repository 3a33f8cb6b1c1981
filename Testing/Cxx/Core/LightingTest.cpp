// Shadow rays: where their segments end, and which of them need not be traced.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Tracing/Lighting.h"
#include "Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace hrt;

// A white floor at z = 0 under a small blocker at the given height, seen by a camera at height 10.
struct Floor
{
  Snapshot scene;
  BvhStructure structure;
  TracerSettings settings;
  RayCount rays;

  explicit Floor(double blocker, double camera = 10.0)
  {
    const auto square = scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 });
    scenes::addPart(scene, square, glm::scale(glm::dmat4(1.0), { 5, 5, 1 }));
    scenes::addPart(scene, square, glm::translate(glm::dmat4(1.0), { 0, 0, blocker }));
    scene.camera.worldToView =
      glm::lookAt(glm::dvec3(0, 0, camera), glm::dvec3(0), glm::dvec3(0, 1, 0));
    scene.camera.viewToClip = glm::perspective(0.7, 1.0, 0.1, 100.0);
    structure.update(scene);
  }

  Light& addLight(Light::Kind kind, const glm::dvec3& position)
  {
    Light light;
    light.kind = kind;
    light.position = position;
    light.direction = { 0, 0, -1 };
    scene.lights.push_back(light);
    return scene.lights.back();
  }

  // The floor's colour at (x, 0), seen straight from above.
  float brightnessAt(double x)
  {
    Ray ray;
    ray.origin = { x, 0, 0.5 };
    Hit hit;
    EXPECT_TRUE(primaryHit(scene, 0, ray, hit) && hit.valid());
    const Surfaces surfaces(scene);
    const Lighting lighting(scene, surfaces, structure, settings);
    std::vector<glm::vec3> sums(1, glm::vec3(0.0f));
    std::vector<PathSignature> signatures(1, 0);
    ShadowQueue queue;
    lighting.shade(surfaces.at(hit, ray.direction), -ray.direction,
      { 0, glm::vec3(1.0f), sums[0], signatures[0] }, queue, rays);
    lighting.flush(queue, RayOrder::Coherent, sums, signatures);
    EXPECT_TRUE(queue.empty());
    return sums[0].r;
  }
};

TEST(Lighting, DirectionalLightsAreBlockedAtAnyDistance)
{
  Floor floor(1000.0);
  floor.addLight(Light::Kind::Directional, { 0, 0, 5 });
  EXPECT_EQ(floor.brightnessAt(0.5), 0.0f);
  EXPECT_EQ(floor.brightnessAt(2.0), 1.0f);
  EXPECT_EQ(floor.rays.asked, 2u);
  EXPECT_EQ(floor.rays.traced, 2u);
}

TEST(Lighting, PositionalLightsAreBlockedOnlyInFront)
{
  Floor above(4.0), below(2.0);
  above.addLight(Light::Kind::Positional, { 0, 0, 3 });
  below.addLight(Light::Kind::Positional, { 0, 0, 3 });
  EXPECT_GT(above.brightnessAt(0.5), 0.9f); // cosine 3 / sqrt(9.25)
  EXPECT_EQ(below.brightnessAt(0.5), 0.0f);
  // The shadow's border lies where the line from the light passes the blocker's, at x = 3.
  EXPECT_EQ(below.brightnessAt(3.0 - 1e-9), 0.0f);
  EXPECT_GT(below.brightnessAt(3.0 + 1e-9), 0.5f);
}

TEST(Lighting, HeadlightsShineFromTheCamerasPlane)
{
  Floor behind(12.0), between(8.0);
  behind.addLight(Light::Kind::Directional, { 0, 0, 10 }).isHeadlight = true;
  between.addLight(Light::Kind::Directional, { 0, 0, 10 }).isHeadlight = true;
  EXPECT_EQ(behind.brightnessAt(0.5), 1.0f);
  EXPECT_EQ(between.brightnessAt(0.5), 0.0f);
  // The same light, not a headlight, comes from infinitely far.
  behind.scene.lights[0].isHeadlight = false;
  EXPECT_EQ(behind.brightnessAt(0.5), 0.0f);
  // A parallel camera has no plane to shine from.
  behind.scene.lights[0].isHeadlight = true;
  behind.scene.camera.viewToClip = glm::ortho(-1.0, 1.0, -1.0, 1.0, 0.1, 100.0);
  EXPECT_EQ(behind.brightnessAt(0.5), 0.0f);
}

TEST(Lighting, NoRayWhereTheAnswerIsKnown)
{
  Floor floor(1000.0);
  floor.addLight(Light::Kind::Directional, {}).direction = { 0, 0, 1 }; // from below
  EXPECT_EQ(floor.brightnessAt(2.0), 0.0f);
  EXPECT_EQ(floor.rays.answered, 1u);
  // A shading normal that leans towards a light below the horizon: the face is its own shadow.
  auto tilted = std::make_shared<Geometry>(*floor.scene.parts[0].geometry);
  tilted->normals.values.assign(tilted->vertexCount(), glm::vec3(1, 0, 0.2f));
  floor.scene.parts[0].geometry = tilted;
  floor.scene.lights[0].direction = glm::normalize(glm::dvec3(-1, 0, 0.1));
  EXPECT_EQ(floor.brightnessAt(2.0), 0.0f);
  EXPECT_EQ(floor.rays.answered, 2u);
  EXPECT_EQ(floor.rays.traced, 0u);
  floor.settings.shadows = false;
  EXPECT_GT(floor.brightnessAt(2.0), 0.5f); // VTK's own answer
  EXPECT_EQ(floor.rays.asked, 2u);
}

TEST(Lighting, UnlitAndUnlightedShowTheirColour)
{
  Floor floor(1000.0);
  floor.scene.parts[0].material.front.ambient = 0.25f;
  floor.scene.parts[0].material.front.diffuse = 0.5f;
  EXPECT_EQ(floor.brightnessAt(0.5), 0.75f); // no light at all
  floor.addLight(Light::Kind::Directional, {});
  EXPECT_EQ(floor.brightnessAt(0.5), 0.25f); // in shadow: ambient
  floor.scene.parts[0].material.lit = false;
  EXPECT_EQ(floor.brightnessAt(0.5), 0.75f);
}

// A veil of opacity a and colour C lets (1 - a) (1 - a + a C) through, each veil anew.
TEST(Lighting, TranslucentSurfacesTintWhenAsked)
{
  Floor floor(3.0);
  floor.addLight(Light::Kind::Directional, { 0, 0, 5 });
  Part& veil = floor.scene.parts[1];
  veil.castsShadow = false;
  veil.tintsShadow = true;
  veil.material.front.opacity = veil.material.back.opacity = 0.25f;
  veil.material.front.diffuseColor = veil.material.back.diffuseColor = { 0.5f, 1.0f, 1.0f };
  floor.structure.update(floor.scene);
  EXPECT_EQ(floor.brightnessAt(0.5), 1.0f) << "not asked for";
  floor.settings.tintedShadows = true;
  const float once = 0.75f * (0.75f + 0.25f * 0.5f);
  EXPECT_FLOAT_EQ(floor.brightnessAt(0.5), once);
  EXPECT_EQ(floor.brightnessAt(2.0), 1.0f) << "beside the veil";
  scenes::addPart(floor.scene, floor.scene.parts[1].geometry,
    glm::translate(glm::dmat4(1.0), { 0, 0, 4 }));
  floor.scene.parts[2].castsShadow = false;
  floor.scene.parts[2].tintsShadow = true;
  floor.scene.parts[2].material = floor.scene.parts[1].material;
  floor.structure.update(floor.scene);
  EXPECT_FLOAT_EQ(floor.brightnessAt(0.5), once * once);
}

// Light goes through the holes of a texture and is blocked beside them, tinted shadows or not.
TEST(Lighting, HolesLetLightThrough)
{
  Floor floor(3.0);
  floor.addLight(Light::Kind::Directional, { 0, 0, 5 });
  Part& sieve = floor.scene.parts[1];
  auto mapped = std::make_shared<Geometry>(*sieve.geometry);
  for (const glm::vec3& p : mapped->positions)
  {
    mapped->textureCoordinates.values.push_back({ 0.5f * (p.x + 1.0f), 0.5f });
  }
  auto texture = std::make_shared<Texture>();
  texture->version = 1;
  texture->width = 4;
  texture->height = 1;
  texture->bytes.assign(4, { 255, 0, 255, 255 });
  texture->bytes[2].a = 0; // where 0 < x < 1/2
  sieve.geometry = mapped;
  sieve.material.textures.layers = { { texture, TextureBlend::None } };
  sieve.material.textures.alpha = Texture::Alpha::Holes;
  sieve.castsShadow = false;
  sieve.tintsShadow = true;
  sieve.perforated = true;
  floor.structure.update(floor.scene);
  for (const bool tinted : { false, true })
  {
    floor.settings.tintedShadows = tinted;
    EXPECT_EQ(floor.brightnessAt(0.25), 1.0f) << "through the hole";
    EXPECT_EQ(floor.brightnessAt(0.75), 0.0f) << "beside it";
    EXPECT_EQ(floor.brightnessAt(2.0), 1.0f) << "beside the part";
  }
}

TEST(Lighting, TexturesMultiplyAmbientAndUnlitColours)
{
  Floor floor(1000.0);
  auto mapped = std::make_shared<Geometry>(*floor.scene.parts[0].geometry);
  mapped->textureCoordinates.values.assign(mapped->vertexCount(), glm::vec2(0.5f));
  auto texture = std::make_shared<Texture>();
  texture->version = 1;
  texture->width = texture->height = 1;
  texture->floats = { { 0.5f, 0.5f, 0.5f, 1.0f } };
  Material& material = floor.scene.parts[0].material;
  floor.scene.parts[0].geometry = mapped;
  material.textures.layers = { { texture, TextureBlend::None } };
  material.front.ambient = 0.25f;
  material.front.diffuse = 0.5f;
  EXPECT_EQ(floor.brightnessAt(0.5), 0.375f); // no light at all
  floor.addLight(Light::Kind::Directional, {});
  EXPECT_EQ(floor.brightnessAt(0.5), 0.125f); // in shadow: ambient
  EXPECT_EQ(floor.brightnessAt(2.0), 0.375f);
  material.lit = false;
  EXPECT_EQ(floor.brightnessAt(0.5), 0.375f);
}

// What casts none is no translucent surface: light passes it whole.
TEST(Lighting, WhatCastsNoShadowTakesNoLight)
{
  Floor floor(3.0);
  floor.addLight(Light::Kind::Directional, { 0, 0, 5 });
  floor.settings.tintedShadows = true;
  EXPECT_EQ(floor.brightnessAt(0.5), 0.0f);
  floor.scene.parts[1].castsShadow = false;
  floor.structure.update(floor.scene);
  EXPECT_EQ(floor.brightnessAt(0.5), 1.0f);
}

// Nothing is asked of a light that casts no shadows, not even which side a surface turns to it.
TEST(Lighting, LightsThatCastNoShadowsNeedNoRays)
{
  Floor floor(3.0);
  floor.addLight(Light::Kind::Directional, { 0, 0, 5 });
  floor.scene.lights[0].castsShadows = false;
  EXPECT_EQ(floor.brightnessAt(0.5), 1.0f);
}

TEST(Lighting, SpotsLightTheirCone)
{
  Floor floor(1000.0);
  Light& spot = floor.addLight(Light::Kind::Positional, { 0, 0, 2 });
  spot.coneAngle = 45.0f; // a circle of radius 2 on the floor
  // Single precision rounds the cosine of the border, whose slope there is 1/4, to 2^-24.
  EXPECT_GT(floor.brightnessAt(2.0 - 1e-6), 0.5f);
  EXPECT_EQ(floor.brightnessAt(2.0 + 1e-6), 0.0f);
}

// Far from the world's origin the light is placed as exactly as near it. All coordinates and their
// differences are exact in double; in single precision they would be off by up to 1/128.
TEST(Lighting, LargeCoordinatesCancel)
{
  Floor here(1000.0), there(1000.0);
  const glm::dvec3 offset(148376, 1234, -223423);
  const glm::dvec3 lamp(259.0 / 256, 0, 517.0 / 256);
  here.addLight(Light::Kind::Positional, lamp);
  there.addLight(Light::Kind::Positional, offset + lamp);
  for (Part& part : there.scene.parts)
  {
    part.localToWorld = glm::translate(glm::dmat4(1.0), offset) * part.localToWorld;
  }
  there.scene.origin = offset;
  EXPECT_EQ(there.brightnessAt(2.0), here.brightnessAt(2.0));
}

} // namespace
