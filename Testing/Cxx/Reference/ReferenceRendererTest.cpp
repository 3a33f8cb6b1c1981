// The reference renderer held against closed forms, and the product's tracer against the reference.
#include "Testing/Cxx/Reference/ReferenceRenderer.h"

#include "Rendering/Core/Structures/BvhStructure.h"
#include "Testing/Cxx/Core/Scenes.h"
#include "Testing/Cxx/Reference/TriangleSoup.h"
#include "Testing/Cxx/TracedImages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace hrt;
using hrt::reference::Picture;

namespace
{

using Ids = std::vector<TriangleId>;

// A square in the plane z = 0, cut along y = x, seen from above. Pixels are 2 / size wide.
Snapshot square(int size)
{
  Snapshot s;
  scenes::addPart(s, scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 }))
    .material = scenes::glowing({ 0.25f, 0.5f, 0.75f });
  s.camera.worldToView = glm::lookAt(glm::dvec3(0, 0, 5), glm::dvec3(0), glm::dvec3(0, 1, 0));
  s.camera.viewToClip = glm::ortho(-2.0, 2.0, -2.0, 2.0, 1.0, 10.0);
  s.camera.parallel = true;
  s.camera.width = s.camera.height = size;
  return s;
}

const Ids& admissible(const Picture& picture, int column, int row)
{
  return picture.admissible[std::size_t(row) * picture.width + column];
}

// Mirror, glass, smooth and flat surfaces under three kinds of light; a veil that rays see.
Snapshot lively()
{
  Snapshot s;
  Part& floor = scenes::addPart(
    s, scenes::quad({ -4, -1, 4 }, { 4, -1, 4 }, { 4, -1, -4 }, { -4, -1, -4 }));
  floor.material.front.diffuseColor = { 0.7f, 0.7f, 0.8f };
  floor.material.front.ambient = 0.1f;
  floor.material.reflectance = 0.4f;
  Part& ball = scenes::addPart(s, scenes::sphere(24, 16),
    glm::translate(glm::dmat4(1.0), glm::dvec3(1.1, -0.2, 0.3)) *
      glm::scale(glm::dmat4(1.0), glm::dvec3(0.7)));
  ball.material = scenes::glass(1.5f);
  ball.material.front.specular = 0.5f;
  ball.material.front.specularPower = 30.0f;
  ball.castsShadow = false;
  Part& ring = scenes::addPart(s, scenes::torus(24, 12, 0.8, 0.3),
    glm::translate(glm::dmat4(1.0), glm::dvec3(-0.9, 0.0, -0.4)));
  ring.material.front.diffuseColor = { 0.9f, 0.6f, 0.3f };
  ring.material.front.specular = 0.4f;
  ring.material.front.specularPower = 12.0f;
  Part& veil = scenes::addPart(
    s, scenes::quad({ -1, 1.2f, 1 }, { 0, 1.2f, 1 }, { 0, 1.2f, -1 }, { -1, 1.2f, -1 }));
  veil.material.front.opacity = 0.4f;
  veil.visibleToCamera = false;
  veil.castsShadow = false;
  veil.tintsShadow = true;
  for (Part& part : s.parts)
  {
    part.material.back = part.material.front;
  }
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(0.3, -1.0, -0.4));
  sun.color = glm::vec3(0.6f);
  Light spot;
  spot.kind = Light::Kind::Positional;
  spot.position = { 2, 3, 2 };
  spot.direction = glm::normalize(glm::dvec3(-2, -3.5, -2));
  spot.coneAngle = 35.0f;
  spot.exponent = 2.0f;
  spot.color = { 0.5f, 0.4f, 0.3f };
  s.lights = { sun, spot };
  s.background = { { 0.2f, 0.3f, 0.4f }, { 0.6f, 0.7f, 0.9f }, { 0, 1, 0 } };
  s.camera = scenes::perspective({ 0.3, 1.4, 5.0 }, { 0, -0.2, 0 }, 64, 48);
  return s;
}

} // namespace

TEST(ReferenceRenderer, TiesAreNamedAndNothingElse)
{
  // 9 x 9 pixels of 4/9: the centres of the diagonal pixels lie on the cut exactly.
  const Snapshot s = square(9);
  const Picture picture = reference::render(s, TracerSettings());
  for (int row = 0; row < 9; ++row)
  {
    for (int column = 0; column < 9; ++column)
    {
      const bool in = std::abs(column - 4) <= 2 && std::abs(row - 4) <= 2;
      const Ids expected = !in ? Ids{ kNoTriangle }
        : column == row        ? Ids{ 0, 1 }
        : column > row         ? Ids{ 0 }
                               : Ids{ 1 };
      EXPECT_EQ(admissible(picture, column, row), expected) << column << ' ' << row;
    }
  }
}

TEST(ReferenceRenderer, AnOpenBorderMayBeMissed)
{
  // 8 x 8 pixels of 1/2, moved by half a pixel: centres lie on the square's border.
  Snapshot s = square(8);
  s.camera.viewToClip = glm::ortho(-2.25, 1.75, -2.25, 1.75, 1.0, 10.0);
  const Picture picture = reference::render(s, TracerSettings());
  EXPECT_EQ(admissible(picture, 6, 3), (Ids{ 0, kNoTriangle }));
  EXPECT_EQ(admissible(picture, 2, 4), (Ids{ 1, kNoTriangle }));
  EXPECT_EQ(admissible(picture, 6, 6), (Ids{ 0, 1, kNoTriangle })) << "a corner";
  EXPECT_EQ(admissible(picture, 4, 4), (Ids{ 0, 1 })) << "the cut: no gap";
  EXPECT_EQ(picture.triangles[6 * 8 + 6], 1u) << "of equals the largest";
}

TEST(ReferenceRenderer, CoplanarTrianglesAreAllAdmissible)
{
  Snapshot s = square(8);
  scenes::addPart(s, s.parts[0].geometry);
  const Picture picture = reference::render(s, TracerSettings());
  EXPECT_EQ(admissible(picture, 5, 3), (Ids{ 0, 2 }));
  EXPECT_EQ(picture.triangles[3 * 8 + 5], 2u);
  s.parts[1].localToWorld[3].z = 1e-9; // far more than rounding, at a distance of 5
  EXPECT_EQ(admissible(reference::render(s, TracerSettings()), 5, 3), (Ids{ 2 }));
}

TEST(ReferenceRenderer, NearPlaneCuts)
{
  Snapshot s = square(8);
  s.camera.viewToClip = glm::ortho(-2.0, 2.0, -2.0, 2.0, 5.5, 10.0);
  const Picture picture = reference::render(s, TracerSettings());
  EXPECT_TRUE(std::all_of(picture.triangles.begin(), picture.triangles.end(),
    [](TriangleId id) { return id == kNoTriangle; }));
}

// Two facing mirrors: a geometric series that maximumDepth cuts.
TEST(ReferenceRenderer, MirrorsInMirrors)
{
  Snapshot s = square(8);
  s.parts[0].material = scenes::mirror(0.5f, glm::vec3(1.0f));
  Part& other = scenes::addPart(s,
    scenes::quad({ -3, -3, 2 }, { -3, 3, 2 }, { 3, 3, 2 }, { 3, -3, 2 }));
  other.material = scenes::mirror(0.5f, glm::vec3(1.0f));
  other.visibleToCamera = false;
  for (int depth = 0; depth < 6; ++depth)
  {
    TracerSettings settings;
    settings.maximumDepth = depth;
    // Depth 0 is no mirror at all.
    const double expected = depth == 0 ? 1.0 : 1.0 - std::pow(0.5, depth + 1);
    EXPECT_NEAR(reference::render(s, settings).colors[3 * 8 + 5].r, expected, 1e-15) << depth;
  }
}

TEST(ReferenceRenderer, GlassAtNormalIncidence)
{
  // Fresnel at 0 degrees: ((n - 1) / (n + 1))^2; the pane's back is open, so that light ends inside.
  Snapshot s = square(8);
  s.parts[0].material = scenes::glass(1.5f);
  s.parts[0].material.front.diffuseColor = { 0.5f, 1.0f, 0.25f };
  s.background = { glm::vec3(1.0f), glm::vec3(1.0f), { 0, 1, 0 } };
  const glm::dvec4 color = reference::render(s, TracerSettings()).colors[3 * 8 + 5];
  EXPECT_NEAR(color.r, 0.04 + 0.96 * 0.5, 1e-15);
  EXPECT_NEAR(color.g, 1.0, 1e-15);
  EXPECT_NEAR(color.b, 0.04 + 0.96 * 0.25, 1e-15);
}

// The product's whole picture within the rounding of its single-precision colours, what it omits for
// lightness, and the pixels where rounding decides.
TEST(ReferenceRenderer, TheTracerShowsTheReference)
{
  for (const bool tinted : { false, true })
  {
    for (const int depth : { 0, 1, 3, 6 })
    {
      const Snapshot s = lively();
      TracerSettings settings;
      settings.tintedShadows = tinted;
      settings.maximumDepth = depth;
      const Picture truth = reference::render(s, settings);
      BvhStructure structure;
      structure.update(s);
      PrimaryHits hits;
      castPrimaryRays(s, structure, {}, hits);
      SecondaryImage image;
      traceImage(s, structure, settings, hits.ids.data(), image);
      std::size_t fragile = 0, covered = 0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i)
      {
        const TriangleId id = hits.ids[i] == 0 ? kNoTriangle : hits.ids[i] - 1;
        const Ids& may = truth.admissible[i];
        ASSERT_NE(std::find(may.begin(), may.end(), id), may.end()) << "pixel " << i;
        covered += truth.colors[i].a > 0 ? 1 : 0;
        if (may.size() > 1 || truth.fragile[i])
        {
          ++fragile;
          continue;
        }
        // Some twenty float operations on values up to 2, and powers up to 30.
        const glm::dvec3 error =
          glm::abs(glm::dvec3(image.pixels[i]) - glm::dvec3(truth.colors[i])) - truth.omitted[i];
        ASSERT_LE(std::max({ error.r, error.g, error.b }), 2e-5) << "pixel " << i;
        ASSERT_EQ(image.pixels[i].a, truth.colors[i].a);
      }
      EXPECT_GT(covered, image.pixels.size() / 2);
      EXPECT_LT(fragile, image.pixels.size() / 100);
    }
  }
}
