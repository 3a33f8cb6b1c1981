// The physically based equations: single against double precision, and values known by hand.
#include "Rendering/Core/Tracing/Lighting.h"
#include "Rendering/Core/Tracing/Surface.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace hrt;
using shading64::HrtPhysical;

HrtPhysical plain(double roughness = 0.5, double metallic = 0.0)
{
  HrtPhysical s;
  s.albedo = { 0.8, 0.4, 0.2 };
  s.metallic = metallic;
  s.roughness = roughness;
  s.f0 = 0.04;
  s.edgeTint = { 1, 1, 1 };
  s.coat = s.coatRoughness = s.coatF0 = 0.0;
  s.coatColor = { 1, 1, 1 };
  return s;
}

shading64::HrtLight sun(const glm::dvec3& direction, const glm::dvec3& color = glm::dvec3(1.0))
{
  shading64::HrtLight light;
  light.position = { 0, 0, 0 };
  light.direction = glm::normalize(direction);
  light.color = color;
  light.attenuation = { 1, 0, 0 };
  light.cosCone = -2.0;
  light.exponent = 0.0;
  light.kind = HRT_LIGHT_DIRECTIONAL;
  return light;
}

const glm::dvec3 kUp(0, 0, 1), kHere(0, 0, 0);

// Light, viewer and normal in one line: D = 1 / (pi r^4), V = 1 / 4 (the square roots are 1), F = F0.
TEST(Physical, AlongTheNormal)
{
  for (const double r : { 0.3, 0.5, 1.0 })
  {
    const glm::dvec3 c = shading64::hrtShadePhysically(plain(r), sun({ 0, 0, -1 }), kHere, kUp, kUp);
    const double specular = 0.04 / (scenes::kPi * std::pow(r, 4)) / 4;
    const glm::dvec3 expected = 0.96 * glm::dvec3(0.8, 0.4, 0.2) / scenes::kPi + specular;
    EXPECT_LT(glm::length(c - expected), 1e-9) << r;
  }
}

TEST(Physical, MetalReflectsItsColourAndScattersNothing)
{
  const glm::dvec3 c =
    shading64::hrtShadePhysically(plain(0.5, 1.0), sun({ 0, 0, -1 }), kHere, kUp, kUp);
  const double lobe = 1.0 / (scenes::kPi * std::pow(0.5, 4)) / 4;
  EXPECT_LT(glm::length(c - lobe * glm::dvec3(0.8, 0.4, 0.2)), 1e-9);
}

// At 60 degrees on either side: the half vector is the normal, and F has (1 - 1/2)^5 of F90.
TEST(Physical, MirrorDirectionAtAnAngle)
{
  const glm::dvec3 viewer(std::sin(scenes::kPi / 3), 0, 0.5);
  const double r = 0.5;
  HrtPhysical s = plain(r);
  s.albedo = { 0, 0, 0 };
  const glm::dvec3 c =
    shading64::hrtShadePhysically(s, sun({ viewer.x, 0, -0.5 }), kHere, kUp, viewer);
  const double f90 = std::min(1.0, 0.04 * 3 * 50 * 0.33);
  const double fresnel = 0.04 + (f90 - 0.04) / 32;
  const double distribution = 1 / (scenes::kPi * std::pow(r, 4));
  const double root = std::sqrt(r * r + 0.25 * (1 - r * r));
  EXPECT_NEAR(c.x, fresnel * distribution * 0.5 / root * 0.5, 1e-9); // both terms 1/2 root; facing 1/2
}

// What the coat reflects is missing below it, and its colour filters what comes through.
TEST(Physical, ACoatTakesItsShare)
{
  HrtPhysical s = plain(0.5);
  const glm::dvec3 bare = shading64::hrtShadePhysically(s, sun({ 0, 0, -1 }), kHere, kUp, kUp);
  s.coat = 1.0;
  s.coatF0 = 0.25;
  s.coatRoughness = 1.0;
  s.coatColor = { 1.0, 0.5, 0.0 };
  const glm::dvec3 c = shading64::hrtShadePhysically(s, sun({ 0, 0, -1 }), kHere, kUp, kUp);
  const double layer = 0.25 / scenes::kPi / 4;
  const double specular = 0.04 / (scenes::kPi * std::pow(0.5, 4)) / 4;
  const glm::dvec3 below = 0.75 * (bare - specular) + 0.75 * 0.75 * specular;
  EXPECT_LT(glm::length(c - (layer + below * s.coatColor)), 1e-9);
}

TEST(Physical, TheSingleHeadlightComesFromTheViewer)
{
  shading64::HrtLight headlight = sun({ 0, 0, -1 });
  headlight.kind = HRT_LIGHT_SINGLE_HEADLIGHT;
  const glm::dvec3 viewer = glm::normalize(glm::dvec3(1, 0, 1));
  const glm::dvec3 c =
    shading64::hrtShadePhysically(plain(0.4), headlight, kHere, kUp, viewer);
  // The same as a sun that shines along the line of sight: half vector and light are the viewer.
  const glm::dvec3 same = shading64::hrtShadePhysically(plain(0.4), sun(-viewer), kHere, kUp, viewer);
  EXPECT_LT(glm::length(c - same), 1e-9);
}

TEST(Physical, NoInputGivesWhatIsNoNumber)
{
  scenes::Random random(5);
  for (int i = 0; i < 20000; ++i)
  {
    HrtPhysical s = plain(i % 3 ? random(0, 1) : 0.0, random(0, 1));
    s.coat = random(0, 1);
    s.coatRoughness = i % 5 ? random(0, 1) : 0.0;
    s.coatF0 = random(0, 1);
    const glm::dvec3 normal = random.direction(), viewer = random.direction();
    const glm::dvec3 direction = i % 7 ? random.direction() : -viewer;
    for (int kind = 0; kind < 3; ++kind)
    {
      shading64::HrtLight light = sun(direction);
      light.position = 3.0 * random.direction();
      light.kind = kind;
      const glm::dvec3 c = shading64::hrtShadePhysically(s, light, kHere, normal, viewer);
      ASSERT_TRUE(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
      ASSERT_TRUE(c.x >= 0.0 && c.y >= 0.0 && c.z >= 0.0);
    }
  }
}

TEST(Physical, EncodingIsTheGammaOfVTK)
{
  EXPECT_NEAR(shading64::hrtEncoded({ 0.5, 1.0, 0.0 }).x, std::pow(0.5, 1 / 2.2), 1e-12);
  EXPECT_EQ(shading64::hrtEncoded({ 0.5, 1.0, 0.0 }).y, 1.0);
  EXPECT_EQ(shading64::hrtEncoded({ 0.5, 1.0, -1e-20 }).z, 0.0);
}

// A floor of a physically based material under two lights, one of them blocked over a part of it.
TEST(Physical, ShadowsTakeTheirLightBeforeTheGamma)
{
  Snapshot scene;
  scenes::addPart(
    scene, scenes::quad({ -5, -5, 0 }, { 5, -5, 0 }, { 5, 5, 0 }, { -5, 5, 0 }));
  scenes::addPart(scene, scenes::quad({ -1, -1, 3 }, { 1, -1, 3 }, { 1, 1, 3 }, { -1, 1, 3 }));
  scene.parts[0].material.physical.used = true;
  scene.camera = scenes::perspective({ 0, 0, 10 }, { 0, 0, 0 }, 10, 10);
  for (const glm::dvec3& direction : { glm::dvec3(0, 0, -1), glm::dvec3(0.6, 0, -0.8) })
  {
    Light light;
    light.direction = direction;
    scene.lights.push_back(light);
  }
  scenes::BruteForce structure;
  structure.update(scene);
  TracerSettings settings;
  const Surfaces surfaces(scene);
  const Lighting lighting(scene, surfaces, structure, settings);
  const auto colorAt = [&](double x, RayCount& rays)
  {
    Ray ray;
    ray.origin = { x, 0, 1 };
    Hit hit;
    EXPECT_TRUE(primaryHit(scene, 0, ray, hit));
    std::vector<glm::vec3> sums(1, glm::vec3(0.0f));
    std::vector<PathSignature> signatures(1, 0);
    ShadowQueue queue;
    lighting.shade(surfaces.at(hit, ray.direction), -ray.direction,
      { 0, glm::vec3(1.0f), sums[0], signatures[0] }, queue, rays);
    EXPECT_TRUE(queue.empty());
    return sums[0];
  };
  RayCount rays;
  const glm::vec3 both = colorAt(4.5, rays), one = colorAt(0.5, rays);
  EXPECT_EQ(rays.asked, 4u);
  EXPECT_EQ(rays.traced, 4u);
  // The shadowed point gets the second light alone; undoing the gamma, lights add up.
  const auto decoded = [](float c) { return std::pow(double(c), 2.2); };
  settings.shadows = false;
  scene.lights.pop_back();
  const Lighting first(scene, surfaces, structure, settings);
  std::vector<glm::vec3> sums(1, glm::vec3(0.0f));
  std::vector<PathSignature> signatures(1, 0);
  ShadowQueue queue;
  Ray ray;
  ray.origin = { 0.5, 0, 1 };
  Hit hit;
  ASSERT_TRUE(primaryHit(scene, 0, ray, hit));
  first.shade(surfaces.at(hit, ray.direction), -ray.direction,
    { 0, glm::vec3(1.0f), sums[0], signatures[0] }, queue, rays);
  EXPECT_NEAR(decoded(both.r), decoded(one.r) + decoded(sums[0].r), 1e-5);
  EXPECT_LT(one.r, both.r);
}

} // namespace
