// The shared shading source: single against double precision, and values known by hand.
#include "Rendering/Core/Shading/Shading.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace hrt;

shading64::HrtLight widen(const shading::HrtLight& l)
{
  return { l.position, l.direction, l.color, l.attenuation, l.cosCone, l.exponent, l.kind };
}

shading64::HrtSurface widen(const shading::HrtSurface& s)
{
  return { s.ambient, s.diffuse, s.specular, s.power };
}

glm::vec3 unitFloat(scenes::Random& random)
{
  return glm::normalize(glm::vec3(random.direction()));
}

shading::HrtLight randomLight(scenes::Random& random, int kind)
{
  shading::HrtLight light;
  light.position = glm::vec3(random.inBox(5));
  light.direction = unitFloat(random);
  light.color = glm::vec3(random(0, 1), random(0, 1), random(0, 1));
  light.attenuation = glm::vec3(1, random(0, 0.1), random(0, 0.1));
  light.cosCone = random(0, 1) < 0.5 ? -2.0f : static_cast<float>(random(0, 0.9));
  light.exponent = static_cast<float>(random(0, 20));
  light.kind = kind;
  return light;
}

// Single precision loses at each step up to one rounding. A cosine is the result of at most 16
// (normalising, reflecting, a dot product); a power p of it multiplies the error by p, as does the
// cone's exponent e, and distance attenuation adds 8. All factors are at most 1, the colours' sum
// of diffuse and specular at most 2: 2 * (16 + 16 p + 16 e + 8 + 8 for the last products).
TEST(Shading, FloatAgreesWithDoubleWithinItsBound)
{
  scenes::Random random(4);
  double worst = 0.0;
  int compared = 0;
  for (int i = 0; i < 300000; ++i)
  {
    const shading::HrtLight light = randomLight(random, i % 3);
    shading::HrtSurface surface;
    surface.ambient = glm::vec3(0.0f);
    surface.diffuse = glm::vec3(random(0, 1), random(0, 1), random(0, 1));
    surface.specular = glm::vec3(random(0, 1), random(0, 1), random(0, 1));
    surface.power = static_cast<float>(random(1, 100));
    const glm::vec3 position(random.inBox(5)), normal = unitFloat(random),
                                               viewer = unitFloat(random);
    // Two places where the equations jump and no bound can hold: the terminator and the cone's rim.
    const glm::dvec3 toward =
      shading64::hrtLightDirectionAt(widen(light), glm::dvec3(position));
    const double facing = glm::dot(toward, glm::dvec3(normal));
    const double rim = glm::dot(toward, glm::dvec3(light.direction)) - light.cosCone;
    const double jump = 32 * scenes::kFloatRounding;
    if (std::abs(facing) < jump || std::abs(rim) < jump)
    {
      continue;
    }
    const glm::dvec3 a = shading::hrtShadeLight(surface, light, position, normal, viewer);
    const glm::dvec3 b =
      shading64::hrtShadeLight(widen(surface), widen(light), position, normal, viewer);
    const double bound = 2 * scenes::kFloatRounding *
      (16.0 + 16.0 * surface.power + 16.0 * light.exponent + 16.0);
    const glm::dvec3 error = glm::abs(a - b) / bound;
    worst = std::max({ worst, error.x, error.y, error.z });
    ++compared;
  }
  EXPECT_GT(compared, 299000);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 1e-3); // the bound says something
}

TEST(Shading, HeadOnDirectionalLight)
{
  // Light, normal and view in one line: facing = lobe = 1; all operations are exact.
  shading::HrtLight light{};
  light.direction = { 0, 0, -1 };
  light.color = { 1, 0.5f, 0.25f };
  light.kind = HRT_LIGHT_DIRECTIONAL;
  const shading::HrtSurface surface{ {}, glm::vec3(0.5f), glm::vec3(0.25f), 4.0f };
  const glm::vec3 lit =
    shading::hrtShadeLight(surface, light, glm::vec3(0), { 0, 0, 1 }, { 0, 0, 1 });
  EXPECT_EQ(lit, glm::vec3(0.75f, 0.375f, 0.1875f));
  const glm::vec3 dark =
    shading::hrtShadeLight(surface, light, glm::vec3(0), { 0, 0, -1 }, { 0, 0, -1 });
  EXPECT_EQ(dark, glm::vec3(0.0f));
}

TEST(Shading, ClampedBarycentricsLieInTheTriangle)
{
  scenes::Random random(5);
  for (int i = 0; i < 10000; ++i)
  {
    const double u = random(-0.5, 1.5), v = random(-0.5, 1.5);
    const glm::dvec2 c = shading64::hrtClampBarycentrics(u, v);
    // The sum of two halves of a rounded excess: one rounding beyond 1.
    ASSERT_TRUE(c.x >= 0 && c.y >= 0 && c.x + c.y <= 1 + 2 * scenes::kDoubleRounding);
    if (u >= 0 && v >= 0 && u + v <= 1)
    {
      ASSERT_EQ(c, glm::dvec2(u, v));
    }
  }
}

} // namespace
