// The shadow maps' projections: whatever casts lies within the map, and a texel is as large as the
// table for the shader says.
#include "Rendering/OpenGL2/LightFrustum.h"
#include "Testing/Cxx/Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace
{

constexpr int kResolution = 512;

hrt::Snapshot boxScene(const glm::dvec3& lower, const glm::dvec3& upper)
{
  const auto geometry = hrt::meshes::fromCorners(
    { glm::vec3(lower), glm::vec3(upper), glm::vec3(lower.x, upper.y, lower.z) });
  geometry->boundsMin = lower;
  geometry->boundsMax = upper;
  hrt::Part part;
  part.geometry = geometry;
  hrt::Snapshot snapshot;
  snapshot.parts = { part };
  snapshot.triangleCount = 1;
  snapshot.boundsMin = lower;
  snapshot.boundsMax = upper;
  return snapshot;
}

std::vector<hrt::gl::LightFace> fit(const hrt::Snapshot& snapshot, const hrt::Light& light)
{
  return hrt::gl::fitLightFaces(snapshot, light, hrt::gl::castersFor(snapshot, light), kResolution,
    hrt::gl::kNearestRatioReversed);
}

int facesThatSee(const std::vector<hrt::gl::LightFace>& faces, const glm::dvec3& p)
{
  int count = 0;
  for (const hrt::gl::LightFace& face : faces)
  {
    const glm::dvec4 clip = face.worldToClip * glm::dvec4(p, 1.0);
    count += clip.w > 0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w &&
        std::abs(clip.z) <= clip.w
      ? 1
      : 0;
  }
  return count;
}

glm::dvec3 randomPoint(std::mt19937& random, const glm::dvec3& lower, const glm::dvec3& upper)
{
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double x = unit(random), y = unit(random), z = unit(random);
  return lower + glm::dvec3(x, y, z) * (upper - lower);
}

} // namespace

TEST(LightFrustum, DirectionalSeesEveryCaster)
{
  std::mt19937 random(1);
  const glm::dvec3 lower(-3, 1, 20), upper(5, 1.5, 90);
  const hrt::Snapshot snapshot = boxScene(lower, upper);
  for (int trial = 0; trial < 50; ++trial)
  {
    hrt::Light light;
    light.direction = glm::normalize(randomPoint(random, glm::dvec3(-1), glm::dvec3(1)));
    const auto faces = fit(snapshot, light);
    ASSERT_EQ(faces.size(), 1u);
    for (int k = 0; k < 100; ++k)
    {
      EXPECT_EQ(facesThatSee(faces, randomPoint(random, lower, upper)), 1);
    }
  }
}

TEST(LightFrustum, PointLightSeesEveryCasterOutsideAndAmongThem)
{
  std::mt19937 random(2);
  const glm::dvec3 lower(-1, -2, -3), upper(1, 2, 3);
  const hrt::Snapshot snapshot = boxScene(lower, upper);
  for (const glm::dvec3& at : { glm::dvec3(10, 3, 2), glm::dvec3(0.1, 0.2, 0.3) })
  {
    hrt::Light light;
    light.kind = hrt::Light::Kind::Positional;
    light.coneAngle = 180.0f;
    light.position = at;
    const auto faces = fit(snapshot, light);
    ASSERT_EQ(faces.size(), 6u);
    for (int k = 0; k < 2000; ++k)
    {
      const glm::dvec3 p = randomPoint(random, lower, upper);
      // Points nearer than the near plane belong to no face; seams belong to two.
      if (glm::length(p - at) > faces[0].near * std::sqrt(3.0))
      {
        EXPECT_GE(facesThatSee(faces, p), 1);
      }
    }
  }
}

TEST(LightFrustum, SpotSeesItsCone)
{
  std::mt19937 random(3);
  const glm::dvec3 lower(-1, -1, -1), upper(1, 1, 1);
  const hrt::Snapshot snapshot = boxScene(lower, upper);
  hrt::Light light;
  light.kind = hrt::Light::Kind::Positional;
  light.position = { 0.5, 4.0, 1.0 };
  light.direction = glm::normalize(-light.position);
  for (const float angle : { 5.0f, 30.0f, 60.0f })
  {
    light.coneAngle = angle;
    const auto faces = fit(snapshot, light);
    ASSERT_EQ(faces.size(), 1u);
    int inside = 0;
    for (int k = 0; k < 5000; ++k)
    {
      const glm::dvec3 p = randomPoint(random, lower, upper);
      const double cosine = glm::dot(glm::normalize(p - light.position), light.direction);
      if (cosine >= std::cos(glm::radians(double(angle))))
      {
        ++inside;
        EXPECT_EQ(facesThatSee(faces, p), 1);
      }
    }
    EXPECT_GT(inside, 10);
  }
  light.coneAngle = 75.0f; // wider than one perspective face serves
  EXPECT_EQ(fit(snapshot, light).size(), 6u);
}

TEST(LightFrustum, TexelSizeIsTrue)
{
  const hrt::Snapshot snapshot = boxScene({ -1, -1, -1 }, { 1, 1, 1 });
  hrt::Light directional;
  directional.direction = glm::normalize(glm::dvec3(1, -2, 3));
  hrt::Light spot = directional;
  spot.kind = hrt::Light::Kind::Positional;
  spot.coneAngle = 25.0f;
  spot.position = -5.0 * spot.direction;
  for (const hrt::Light& light : { directional, spot })
  {
    const hrt::gl::LightFace face = fit(snapshot, light).front();
    const glm::dmat4 back = glm::inverse(face.worldToClip);
    for (const double depth : { -0.9, 0.0, 0.9 })
    {
      const auto world = [&](double pixel) {
        const glm::dvec4 p = back * glm::dvec4(pixel / kResolution * 2.0, 0.0, depth, 1.0);
        return glm::dvec3(p) / p.w;
      };
      const double distance =
        face.perspective ? glm::dot(world(0.0) - light.position, light.direction) : 0.0;
      // A texel in double arithmetic through one matrix inversion.
      EXPECT_NEAR(glm::length(world(1.0) - world(0.0)),
        face.texelConstant + face.texelLinear * distance, 1e-9);
    }
  }
}

TEST(LightFrustum, NothingToCastMeansNoFace)
{
  hrt::Snapshot snapshot = boxScene({ 0, 0, 0 }, { 1, 1, 1 });
  snapshot.parts[0].castsShadow = false;
  EXPECT_TRUE(fit(snapshot, hrt::Light()).empty());
}

// A single flat caster seen edge-on has no width for the light, but a map all the same.
TEST(LightFrustum, FlatCasterEdgeOn)
{
  const hrt::Snapshot snapshot = boxScene({ -1, 0, -1 }, { 1, 0, 1 });
  hrt::Light light;
  light.direction = { 1, 0, 0 };
  const auto faces = fit(snapshot, light);
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_EQ(facesThatSee(faces, { 0.5, 0.0, 0.5 }), 1);
}

// A floor shadows nothing of what stands on it, and the map need not cover it; a ceiling does.
TEST(LightFrustum, FlatPartsWithEverythingBeforeThemDoNotCast)
{
  hrt::Snapshot snapshot = boxScene({ -1, 0, -1 }, { 1, 2, 1 });
  const auto floor =
    hrt::meshes::fromCorners({ { -100, 0, -100 }, { -100, 0, 100 }, { 100, 0, 0 } });
  floor->flat = hrt::isFlat(*floor);
  ASSERT_TRUE(floor->flat);
  hrt::Part part;
  part.geometry = floor;
  part.firstTriangle = 1;
  snapshot.parts.push_back(part);

  hrt::Light light;
  light.direction = { 0, -1, 0 };
  EXPECT_EQ(hrt::gl::castersFor(snapshot, light), (std::vector<bool>{ true, false }));
  EXPECT_LT(fit(snapshot, light)[0].texelConstant, 2.1 / kResolution) << "the object alone";
  light.direction = { 0, 1, 0 }; // from below the floor is a caster
  EXPECT_EQ(hrt::gl::castersFor(snapshot, light), (std::vector<bool>{ true, true }));
  light.kind = hrt::Light::Kind::Positional;
  light.position = { 5, 3, 5 };
  EXPECT_EQ(hrt::gl::castersFor(snapshot, light), (std::vector<bool>{ true, false }));
  light.position.y = -3;
  EXPECT_EQ(hrt::gl::castersFor(snapshot, light), (std::vector<bool>{ true, true }));
  light.position.y = 0; // within the plane: no side is lit
  EXPECT_EQ(hrt::gl::castersFor(snapshot, light), (std::vector<bool>{ true, true }));
  // What sticks through the floor has to be shadowed by it.
  light.position.y = 3;
  snapshot.parts[1].localToWorld[3].y = 0.5;
  EXPECT_EQ(hrt::gl::castersFor(snapshot, light), (std::vector<bool>{ true, true }));
}

TEST(Flatness, OnlyOnePlaneIsFlat)
{
  const glm::vec3 a(0.1f, 0.2f, 0.3f), b(1.3f, 0.7f, 0.1f), c(0.2f, 1.1f, 0.9f);
  const glm::vec3 inPlane = a + 0.7f * (b - a) + 0.9f * (c - a);
  const auto isFlat = [](const std::vector<glm::vec3>& corners) {
    return hrt::isFlat(*hrt::meshes::fromCorners(corners));
  };
  EXPECT_TRUE(isFlat({}));
  EXPECT_TRUE(isFlat({ a, b, c }));
  EXPECT_TRUE(isFlat({ a, a, b, a, b, c, b, c, inPlane })) << "but for rounding";
  EXPECT_FALSE(isFlat({ a, b, c, b, c, inPlane + glm::vec3(0, 0, 1e-4f) }));
}
