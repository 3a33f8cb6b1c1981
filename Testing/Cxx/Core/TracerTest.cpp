// The Whitted tracer against optics that can be solved on paper.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Tracing/Fresnel.h"
#include "Scenes.h"
#include "Testing/Cxx/TracedImages.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{

using namespace hrt;

// Colours pass through about ten operations in single precision.
constexpr float kColorTolerance = 16 * static_cast<float>(scenes::kFloatRounding);

Ray primary(const Snapshot& s, int column, int row)
{
  const CameraRays rays = s.camera.worldRays(s.origin);
  const double x = (column + 0.5) / s.camera.width * 2 - 1;
  const double y = (row + 0.5) / s.camera.height * 2 - 1;
  Ray ray;
  ray.origin = rays.origin(x, y);
  ray.direction = glm::normalize(rays.direction(x, y));
  return ray;
}

// What the rasteriser would hand over.
std::vector<std::uint32_t> visibleIds(const Snapshot& s, const Structure& structure)
{
  std::vector<std::uint32_t> ids;
  for (int row = 0; row < s.camera.height; ++row)
  {
    for (int column = 0; column < s.camera.width; ++column)
    {
      ids.push_back(structure.intersect(primary(s, column, row)).triangle + 1); // none: 0
    }
  }
  return ids;
}

struct Picture
{
  SecondaryImage image;
  SecondaryResult result;
  std::vector<std::uint32_t> ids;

  Picture(const Snapshot& s, const TracerSettings& settings)
  {
    BvhStructure structure;
    structure.update(s);
    ids = visibleIds(s, structure);
    result = traceSecondary(s, structure, settings, ids.data(), image);
  }
  const glm::vec4& at(int column, int row) const
  {
    return image.pixels[std::size_t(row) * image.width + column];
  }
};

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance)
{
  EXPECT_NEAR(a.r, b.r, tolerance);
  EXPECT_NEAR(a.g, b.g, tolerance);
  EXPECT_NEAR(a.b, b.b, tolerance);
}

// Black below, white above: the background's brightness is the direction's height along `up`.
void setGradient(Snapshot& s, const glm::vec3& up)
{
  s.background.bottom = glm::vec3(0.0f);
  s.background.top = glm::vec3(1.0f);
  s.background.up = up;
}

float heightOf(const glm::dvec3& direction, const glm::vec3& up)
{
  return static_cast<float>(0.5 * (1.0 + glm::dot(direction, glm::dvec3(up))));
}

std::shared_ptr<Geometry> square(float half)
{
  return scenes::quad({ -half, -half, 0 }, { half, -half, 0 }, { half, half, 0 },
    { -half, half, 0 });
}

TEST(Tracer, PlaneMirrorShowsTheReflectedBackground)
{
  Snapshot s;
  const glm::dmat4 tilt = glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(1, 2, 0)));
  scenes::addPart(s, square(1), tilt).material = scenes::mirror(0.75f);
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 48, 32);
  const glm::dvec3 normal(tilt[2]);
  int mirrored = 0;
  for (const glm::vec3& up : { glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1) })
  {
    setGradient(s, up);
    const Picture picture(s, {});
    for (int row = 0; row < 32; ++row)
    {
      for (int column = 0; column < 48; ++column)
      {
        const glm::vec4& pixel = picture.at(column, row);
        if (picture.ids[row * 48 + column] == 0)
        {
          ASSERT_EQ(pixel, glm::vec4(0, 0, 0, 1));
          continue;
        }
        ++mirrored;
        const glm::dvec3 d = primary(s, column, row).direction;
        const glm::dvec3 away = d - 2 * glm::dot(d, normal) * normal;
        ASSERT_NEAR(pixel.r, 0.75f * heightOf(away, up), kColorTolerance);
        ASSERT_EQ(pixel.a, 0.25f);
      }
    }
    EXPECT_EQ(picture.result.rays.reflection.traced, picture.result.pixels);
  }
  EXPECT_GT(mirrored, 500);
}

TEST(Tracer, MirroredObjectStandsWhereTheVirtualEyeSeesIt)
{
  // A mirror in the plane z = 0 and, behind the camera's back, a red square at height 8. The eye's
  // mirror image sees it through each pixel along the straight line.
  Snapshot s;
  scenes::addPart(s, square(3)).material = scenes::mirror(1.0f);
  const glm::dvec3 centre(0.7, -0.4, 8.0);
  const double half = 1.5;
  scenes::addPart(s, square(1.5f), glm::translate(glm::dmat4(1.0), centre)).material =
    scenes::glowing({ 1, 0, 0 });
  const glm::dvec3 eye(0, 0, 5);
  s.camera = scenes::perspective(eye, { 0, 0, 0 }, 64, 64);
  s.background.bottom = s.background.top = glm::vec3(0, 0, 1);
  const Picture picture(s, {});
  int red = 0, blue = 0;
  for (int row = 0; row < 64; ++row)
  {
    for (int column = 0; column < 64; ++column)
    {
      const glm::dvec3 d = primary(s, column, row).direction;
      const glm::dvec3 foot = eye + d * (-eye.z / d.z), virtualEye(eye.x, eye.y, -eye.z);
      const glm::dvec3 seen = virtualEye + (foot - virtualEye) * ((centre.z + eye.z) / eye.z);
      const double inside =
        half - std::max(std::abs(seen.x - centre.x), std::abs(seen.y - centre.y));
      ASSERT_GT(std::abs(inside), 1e-9); // no pixel sits on the border, where rounding decides
      ASSERT_EQ(picture.at(column, row),
        inside > 0 ? glm::vec4(1, 0, 0, 0) : glm::vec4(0, 0, 1, 0));
      ++(inside > 0 ? red : blue);
    }
  }
  EXPECT_GT(red, 100);
  EXPECT_GT(blue, 100);
}

// A ray that passes the unit sphere's centre at distance b is turned by 2 (asin b - asin(b / n)).
// On the mesh, with normals equal to positions, the interpolated normal is exactly radial, so that
// only the hits' radii differ: |p|^2 = 1 - sum of l_i l_j e_ij^2 over the corners' weights l and
// the edges e, hence |p| >= r = sqrt(1 - e^2 / 3). Both surfaces keep the impact parameter, and
// each turns the ray by at most asin(b / r) - asin(b) more than the sphere would.
TEST(Tracer, GlassSphereBendsLightAsOnPaper)
{
  const auto ball = scenes::sphere(256, 128);
  float longest = 0.0f;
  for (std::size_t i = 0; i < ball->triangleCount(); ++i)
  {
    const auto p = ball->cornerPositions(i);
    longest = std::max({ longest, glm::distance(p[0], p[1]), glm::distance(p[1], p[2]),
      glm::distance(p[2], p[0]) });
  }
  const double least = std::sqrt(1.0 - longest * longest / 3.0), index = 1.5;
  Snapshot s;
  scenes::addPart(s, ball).material = scenes::glass(1.5f);
  s.camera = scenes::perspective({ 0, 0.5, 6 }, { 0, 0, 0 }, 40, 40, 18.0);
  TracerSettings settings;
  settings.reflections = false; // all light goes through: the pixel is the exit direction's height
  settings.maximumDepth = 2;
  int compared = 0;
  for (const glm::vec3& up : { glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1) })
  {
    setGradient(s, up);
    const Picture picture(s, settings);
    for (int i = 0; i < 40 * 40; ++i)
    {
      const Ray ray = primary(s, i % 40, i / 40);
      const glm::dvec3 towards = -ray.origin; // to the centre
      const glm::dvec3 across = towards - glm::dot(towards, ray.direction) * ray.direction;
      const double b = glm::length(across);
      if (picture.ids[i] == 0 || b > 0.9)
      {
        continue;
      }
      const double turn = 2 * (std::asin(b) - std::asin(b / index));
      const glm::dvec3 out = std::cos(turn) * ray.direction + std::sin(turn) * across / b;
      const double error = 2 * (std::asin(b / least) - std::asin(b));
      // The height is half the direction's component.
      ASSERT_NEAR(picture.at(i % 40, i / 40).r, heightOf(out, up), 0.5 * error + kColorTolerance);
      ASSERT_LT(error, 0.002); // far below what is measured: turns of up to 0.95
      ++compared;
    }
    EXPECT_EQ(picture.result.rays.reflection.asked, 0u);
  }
  EXPECT_GT(compared, 1000);
}

// A prism with a right angle turns a ray by total internal reflection at 45 degrees (critical angle
// 41.8): straight in, reflected whole, straight out.
TEST(Tracer, PrismReflectsTotally)
{
  // Legs in the planes z = 1 (towards the camera) and x = 1, hypotenuse from (-1, 1) to (1, -1).
  const glm::vec3 a(-1, -1, 1), b(1, -1, 1), c(1, -1, -1);
  const glm::vec3 up(0, 2, 0), a2 = a + up, b2 = b + up, c2 = c + up;
  auto prism = scenes::makeGeometry({ a, b, b2, a, b2, a2, // front leg, normal +z
    b, c, c2, b, c2, b2,                                   // side leg, normal +x
    c, a, a2, c, a2, c2,                                   // hypotenuse, normal (-1, 0, -1)
    a, c, b, a2, b2, c2 });                                // lids
  Snapshot s;
  Material material = scenes::glass(1.5f);
  material.front.diffuseColor = { 1.0f, 0.5f, 1.0f };
  material.back = material.front;
  scenes::addPart(s, prism).material = material;
  s.camera.worldToView =
    glm::lookAt(glm::dvec3(0.2, 0, 5), glm::dvec3(0.2, 0, 0), glm::dvec3(0, 1, 0));
  s.camera.viewToClip = glm::ortho(-0.1, 0.1, -0.1, 0.1, 0.1, 100.0);
  s.camera.width = s.camera.height = 4;
  setGradient(s, { 1, 0, 0 });
  const Picture picture(s, {});
  // Reflected at the entry: straight back, height 1/2, share 4 %. The rest leaves towards +x,
  // height 1, after two crossings of 96 % and tint each. What the exit reflects meets the
  // hypotenuse again, whose total reflection would be the fourth bounce: nothing.
  const float back = 0.04f * 0.5f, through = 0.96f * 0.96f;
  expectNear(glm::vec3(picture.at(1, 2)),
    { back + through, back + 0.25f * through, back + through }, kColorTolerance);
  EXPECT_EQ(picture.at(1, 2).a, 0.0f);
  // A pixel asks for a reflection and a refraction at the entry, a total reflection, one of each at
  // the exit and a last total reflection beyond the depth.
  EXPECT_EQ(picture.result.rays.reflection.asked, 16u * 4);
  EXPECT_EQ(picture.result.rays.reflection.answered, 16u);
  EXPECT_EQ(picture.result.rays.refraction.asked, 16u * 2);
  EXPECT_EQ(picture.result.rays.refraction.traced, 16u * 2);
}

TEST(Tracer, MirroredMatricesKeepGlassInside)
{
  // A mirrored sphere is the same body of glass, and must bend light the same way.
  Snapshot s;
  scenes::addPart(s, scenes::sphere(64, 32)).material = scenes::glass(1.5f);
  s.camera = scenes::perspective({ 0, 0, 6 }, { 0, 0, 0 }, 8, 8, 10.0);
  setGradient(s, { 0, 0, 1 });
  TracerSettings settings;
  settings.reflections = false;
  const Picture plain(s, settings);
  s.parts[0].localToWorld = glm::scale(glm::dmat4(1.0), { -1, 1, 1 });
  const Picture mirrored(s, settings);
  for (int i = 0; i < 64; ++i)
  {
    // The meshes are each other's image in x = 0: so are the pictures, but for rounding.
    expectNear(glm::vec3(mirrored.at(7 - i % 8, i / 8)), glm::vec3(plain.at(i % 8, i / 8)),
      kColorTolerance);
  }
}

// Two facing mirrors, each adding (1 - r) c: with n bounces r c (1 - r^n).
struct Corridor
{
  Snapshot scene;
  Corridor()
  {
    scenes::addPart(scene, square(5)).material = scenes::mirror(0.5f, glm::vec3(0.8f));
    scenes::addPart(scene, square(5), glm::translate(glm::dmat4(1.0), { 0, 0, 4 })).material =
      scenes::mirror(0.5f, glm::vec3(0.8f));
    scene.camera = scenes::perspective({ 0, 0, 2 }, { 0, 0, 0 }, 4, 4, 2.0);
  }
};

TEST(Tracer, DepthIsLimited)
{
  const Corridor corridor;
  for (int depth = 1; depth <= 6; ++depth)
  {
    TracerSettings settings;
    settings.maximumDepth = depth;
    const Picture picture(corridor.scene, settings);
    const float expected = 0.5f * 0.8f * (1.0f - std::pow(0.5f, static_cast<float>(depth)));
    expectNear(glm::vec3(picture.at(2, 1)), glm::vec3(expected), kColorTolerance);
    EXPECT_EQ(picture.result.rays.reflection.traced, 16u * depth);
    EXPECT_EQ(picture.result.rays.reflection.answered, 16u);
  }
  TracerSettings none;
  none.maximumDepth = 0;
  EXPECT_EQ(Picture(corridor.scene, none).at(2, 1), glm::vec4(0, 0, 0, 1));
}

TEST(Tracer, LightBranchesAreNotTraced)
{
  TracerSettings settings;
  settings.maximumDepth = 100;
  const Picture picture(Corridor().scene, settings);
  // Weights 1/2, 1/4, ... 1/512 are traced, 1/1024 is not: nine rays.
  EXPECT_EQ(picture.result.rays.reflection.traced, 16u * 9);
  EXPECT_NEAR(picture.at(2, 1).r, 0.4f, 1.0f / 512.0f);
}

TEST(Tracer, TranslucentSurfacesLetTheRestThrough)
{
  // A mirror at z = 0 sees, above the camera, a red veil of opacity 1/4 before a green wall.
  Snapshot s;
  scenes::addPart(s, square(2)).material = scenes::mirror(1.0f);
  Part& veil = scenes::addPart(s, square(5), glm::translate(glm::dmat4(1.0), { 0, 0, 6 }));
  veil.material = scenes::glowing({ 1, 0, 0 });
  veil.material.front.opacity = veil.material.back.opacity = 0.25f;
  scenes::addPart(s, square(5), glm::translate(glm::dmat4(1.0), { 0, 0, 7 })).material =
    scenes::glowing({ 0, 1, 0 });
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 4, 4, 10.0);
  TracerSettings settings;
  settings.maximumDepth = 1; // going straight on is no bounce
  expectNear(glm::vec3(Picture(s, settings).at(1, 1)), { 0.25f, 0.75f, 0.0f }, kColorTolerance);
}

TEST(Tracer, ManyLayersEndInTheBackground)
{
  Snapshot s;
  scenes::addPart(s, square(2)).material = scenes::mirror(1.0f);
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 1, 1, 10.0);
  s.background.bottom = s.background.top = glm::vec3(0, 0, 1);
  for (int layer = 0; layer < 100; ++layer)
  {
    Part& veil =
      scenes::addPart(s, square(5), glm::translate(glm::dmat4(1.0), { 0, 0, 6.0 + layer }));
    veil.material = scenes::glowing({ 1, 0, 0 });
    veil.material.front.opacity = veil.material.back.opacity = 0.0f;
  }
  const Picture picture(s, {});
  EXPECT_EQ(picture.at(0, 0), glm::vec4(0, 0, 1, 0));
  EXPECT_EQ(picture.result.rays.reflection.traced, 65u); // the mirror's ray and 64 prolongations
}

TEST(Tracer, ShadowsShowInTheMirror)
{
  // A mirror facing up sees a ceiling lit from below by a point light behind a small square: the
  // shadow's border lies where the line from the light passes the blocker's.
  Snapshot s;
  scenes::addPart(s, square(4)).material = scenes::mirror(1.0f);
  const double blocker = 6.0, light = 5.5, ceiling = 8.0, half = 0.25;
  scenes::addPart(s, square(0.25f), glm::translate(glm::dmat4(1.0), { 0, 0, blocker }))
    .visibleToRays = false;
  scenes::addPart(s, square(20), glm::translate(glm::dmat4(1.0), { 0, 0, ceiling }));
  Light lamp;
  lamp.kind = Light::Kind::Positional;
  lamp.position = { 0, 0, light };
  s.lights.push_back(lamp);
  const glm::dvec3 eye(0.1, 0.05, 5);
  s.camera = scenes::perspective(eye, { 0.1, 0.05, 0 }, 40, 40, 15.0);
  const double reach = half * (ceiling - light) / (blocker - light);
  const Picture picture(s, {});
  int dark = 0, bright = 0;
  for (int i = 0; i < 1600; ++i)
  {
    const glm::dvec3 d = primary(s, i % 40, i / 40).direction;
    const glm::dvec3 p = eye + d * ((eye.z + ceiling) / -d.z); // x and y are kept by the mirror
    const double inside = reach - std::max(std::abs(p.x), std::abs(p.y));
    ASSERT_GT(std::abs(inside), 1e-9);
    if (inside > 0)
    {
      ASSERT_EQ(picture.at(i % 40, i / 40).r, 0.0f);
      ++dark;
    }
    else
    {
      ASSERT_GT(picture.at(i % 40, i / 40).r, 0.5f);
      ++bright;
    }
  }
  EXPECT_GT(dark, 200);
  EXPECT_GT(bright, 200);
  EXPECT_EQ(picture.result.rays.shadow.traced, 1600u);
}

TEST(Tracer, SettingsTakeEffectsAway)
{
  Snapshot s;
  scenes::addPart(s, square(2)).material = scenes::mirror(0.5f);
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 4, 4, 10.0);
  TracerSettings settings;
  settings.reflections = false;
  EXPECT_EQ(Picture(s, settings).at(1, 1), glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(Picture(s, settings).result.pixels, 0u);
  s.parts[0].material = scenes::glass(1.5f);
  settings = {};
  settings.refractions = false;
  EXPECT_EQ(Picture(s, settings).at(1, 1), glm::vec4(0, 0, 0, 1));
}

TEST(Tracer, MirrorInAMirrorWithoutReflectionsIsPlain)
{
  // Glass before a mirror; with reflections off the mirror shows its own colour at full weight.
  Snapshot s;
  scenes::addPart(s, square(2), glm::translate(glm::dmat4(1.0), { 0, 0, 1 })).material =
    scenes::glass(1.0f); // index 1 bends nothing
  scenes::addPart(s, square(2)).material = scenes::mirror(0.75f, { 0.5f, 0.25f, 0.0f });
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 4, 4, 10.0);
  TracerSettings settings;
  settings.reflections = false;
  expectNear(glm::vec3(Picture(s, settings).at(1, 1)), { 0.5f, 0.25f, 0.0f }, kColorTolerance);
}

TEST(Tracer, IdsOutOfRangeAreCountedAndIgnored)
{
  Snapshot s;
  scenes::addPart(s, square(2)).material = scenes::mirror(1.0f);
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 2, 2, 10.0);
  BvhStructure structure;
  structure.update(s);
  const std::uint32_t ids[] = { 0, 3, 0xffffffffu, 2 };
  SecondaryImage image;
  const SecondaryResult result = traceSecondary(s, structure, {}, ids, image);
  EXPECT_EQ(result.invalidIds, 2u);
  EXPECT_EQ(result.pixels, 1u);
  EXPECT_EQ(image.pixels[1], glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(image.pixels[2], glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(image.pixels[3].a, 0.0f);
}

Snapshot livelyScene()
{
  Snapshot s;
  scenes::addPart(s, scenes::torus(48, 24, 1.2, 0.5)).material = scenes::glass(1.4f);
  Part& floor = scenes::addPart(s, square(6), glm::translate(glm::dmat4(1.0), { 0, 0, -1 }));
  floor.material = scenes::mirror(0.4f, { 0.3f, 0.4f, 0.5f });
  floor.material.lit = true;
  floor.material.front.diffuse = 0.5f;
  Part& ball = scenes::addPart(s, scenes::sphere(32, 16));
  ball.localToWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(0.5));
  ball.material.front.specular = 0.4f;
  ball.material.front.specularPower = 30.0f;
  s.lights.resize(2);
  s.lights[0].direction = glm::normalize(glm::dvec3(-1, -1, -2));
  s.lights[1].kind = Light::Kind::Positional;
  s.lights[1].position = { -3, 2, 4 };
  s.camera = scenes::perspective({ 0, -4, 3 }, { 0, 0, 0 }, 97, 61);
  setGradient(s, { 0, 0, 1 });
  return s;
}

TEST(Tracer, ThreadsDoNotShow)
{
  const Snapshot s = livelyScene();
  const auto withThreads = [&s](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return Picture(s, {});
  };
  const Picture one = withThreads(1), two = withThreads(2);
  ASSERT_EQ(one.image.pixels.size(), two.image.pixels.size());
  EXPECT_EQ(std::memcmp(one.image.pixels.data(), two.image.pixels.data(),
              one.image.pixels.size() * sizeof(glm::vec4)),
    0);
  EXPECT_EQ(
    std::memcmp(&one.result, &two.result, sizeof(SecondaryResult)), 0); // counters alone
  EXPECT_GT(one.result.rays.refraction.traced, 1000u);
  EXPECT_GT(one.result.rays.shadow.traced, 1000u);
}

TEST(Tracer, EveryRayIsAnsweredOrTraced)
{
  const SecondaryResult result = Picture(livelyScene(), {}).result;
  for (const RayCount& count :
    { result.rays.reflection, result.rays.refraction, result.rays.shadow })
  {
    EXPECT_EQ(count.asked, count.answered + count.traced);
    EXPECT_GT(count.answered, 0u);
  }
}

TEST(Tracer, StructureDoesNotShow)
{
  const Snapshot s = livelyScene();
  scenes::BruteForce reference;
  reference.update(s);
  const Picture embree(s, {});
  SecondaryImage image;
  traceSecondary(s, reference, {}, embree.ids.data(), image);
  EXPECT_EQ(std::memcmp(image.pixels.data(), embree.image.pixels.data(),
              image.pixels.size() * sizeof(glm::vec4)),
    0);
}

} // namespace
