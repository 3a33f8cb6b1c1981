// Interleaved rendering against pictures whose every pixel was traced.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Tracing/Interleaving.h"
#include "Scenes.h"
#include "Testing/Cxx/TracedImages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace hrt;

// Colours pass through about ten operations in single precision.
constexpr float kColorTolerance = 16 * static_cast<float>(scenes::kFloatRounding);

TracerSettings interleaved(int n, bool errorControl)
{
  TracerSettings settings;
  settings.interleave = n;
  settings.interleaveErrorControl = errorControl;
  return settings;
}

TEST(Lattice, HoldsEveryNthAndTheLastPixel)
{
  Camera camera;
  for (const int width : { 1, 2, 3, 16, 17, 18 })
  {
    for (const int n : { 1, 2, 3, 16 })
    {
      camera.width = width;
      camera.height = 2;
      const Lattice lattice(camera, n);
      int count = 0;
      for (int x = 0; x < width; ++x)
      {
        const bool wanted = x % n == 0 || x == width - 1;
        EXPECT_EQ(lattice.isSample(x, 0), wanted) << x << " of " << width << " by " << n;
        if (wanted)
        {
          EXPECT_EQ(lattice.pixel(count++, 1), static_cast<std::uint32_t>(width + x));
        }
      }
      EXPECT_EQ(lattice.columns(), count);
    }
  }
}

TEST(Lattice, WeightsReproduceEveryLinearFunction)
{
  Camera camera;
  camera.width = 23;
  camera.height = 14;
  for (const int n : { 1, 2, 3, 4, 5, 16 })
  {
    const Lattice lattice(camera, n);
    for (int row = 0; row < camera.height; ++row)
    {
      for (int column = 0; column < camera.width; ++column)
      {
        const Lattice::Around around = lattice.around(column, row);
        double x = 0.0, y = 0.0, sum = 0.0;
        for (int i = 0; i < around.count; ++i)
        {
          const auto& neighbour = around.neighbours[i];
          EXPECT_GT(neighbour.weight, 0.0f);
          EXPECT_LE(neighbour.weight, around.neighbours[around.nearest].weight);
          EXPECT_EQ(neighbour.pixel,
            lattice.pixel(neighbour.sample % lattice.columns(), neighbour.sample / lattice.columns()));
          sum += neighbour.weight;
          x += neighbour.weight * (neighbour.pixel % camera.width);
          y += neighbour.weight * (neighbour.pixel / camera.width);
        }
        EXPECT_EQ(around.count == 1, lattice.isSample(column, row));
        // Weights are products of two rounded numbers; four of them are summed.
        EXPECT_NEAR(sum, 1.0, 8 * scenes::kFloatRounding);
        EXPECT_NEAR(x, column, camera.width * 8 * scenes::kFloatRounding);
        EXPECT_NEAR(y, row, camera.height * 8 * scenes::kFloatRounding);
      }
    }
  }
}

struct Picture
{
  SecondaryImage image;
  SecondaryResult result;
  PrimaryHits hits;
  RayCounters primary;
  const glm::vec4& at(int column, int row) const
  {
    return image.pixels[std::size_t(row) * image.width + column];
  }
};

// The ids by rays through all pixels, as a rasteriser would find them.
Picture trace(const Snapshot& s, const TracerSettings& settings,
  Wanted wanted = Wanted::Everything, bool interleavePrimary = false)
{
  BvhStructure structure;
  structure.update(s);
  Picture p;
  p.primary = castPrimaryRays(
    s, structure, interleavePrimary ? settings : TracerSettings(), p.hits);
  p.result = wanted == Wanted::Everything
    ? traceImage(s, structure, settings, p.hits.ids.data(), p.image)
    : traceSecondary(s, structure, settings, p.hits.ids.data(), p.image);
  return p;
}

Camera parallelCamera(int width, int height)
{
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.parallel = true;
  camera.worldToView = glm::lookAt(glm::dvec3(0, 0, 10), glm::dvec3(0.0), glm::dvec3(0, 1, 0));
  camera.viewToClip =
    glm::ortho(-0.5 * width, 0.5 * width, -0.5 * height, 0.5 * height, 1.0, 20.0);
  return camera;
}

std::shared_ptr<Geometry> rectangle(float left, float bottom, float right, float top, float z = 0)
{
  return scenes::quad({ left, bottom, z }, { right, bottom, z }, { right, top, z }, { left, top, z });
}

// A rectangle whose colour rises from left to right by `steps` of 255 and from bottom to top by half.
Snapshot ramp(int width, int height, int steps)
{
  Snapshot s;
  const float x = 0.5f * width, y = 0.5f * height;
  const auto geometry = rectangle(-x, -y, x, y);
  geometry->colorSource = ColorSource::Corner;
  for (const glm::vec3& p : geometry->positions)
  {
    const int value = (p.x > 0 ? steps : 0) + (p.y > 0 ? steps / 2 : 0);
    geometry->colors.values.push_back(glm::u8vec4(value, 10, 255 - value, 255));
  }
  scenes::addPart(s, geometry).material = scenes::glowing(glm::vec3(1.0f));
  s.camera = parallelCamera(width, height);
  return s;
}

TEST(Interleaving, ReproducesALinearRamp)
{
  const Snapshot s = ramp(45, 33, 30);
  const Picture every = trace(s, {});
  for (const int n : { 2, 3, 4, 7 })
  {
    for (const bool errorControl : { false, true })
    {
      const Picture some = trace(s, interleaved(n, errorControl));
      const Lattice lattice(s.camera, n);
      EXPECT_EQ(some.result.interleave.traced,
        static_cast<std::uint64_t>(lattice.columns() * lattice.rows()));
      EXPECT_EQ(some.result.interleave.traced + some.result.interleave.interpolated, 45u * 33u);
      for (std::size_t i = 0; i < every.image.pixels.size(); ++i)
      {
        for (int k = 0; k < 4; ++k)
        {
          ASSERT_NEAR(some.image.pixels[i][k], every.image.pixels[i][k], kColorTolerance);
        }
      }
    }
  }
}

TEST(Interleaving, ErrorControlTracesWhereColoursRiseSteeply)
{
  // Between samples at n = 2 lie 2 * 170 / 45 = 7.6 steps of 255 along the rows and 2 * 85 / 33 = 5.2
  // along the columns: within the tolerance of 12 each, beyond it together, inside of a cell.
  const Snapshot s = ramp(45, 33, 170);
  const Picture some = trace(s, interleaved(2, true));
  EXPECT_EQ(some.result.interleave.interpolated, 22u * 17u + 23u * 16u);
  const Picture steep = trace(ramp(15, 11, 170), interleaved(2, true));
  EXPECT_EQ(steep.result.interleave.interpolated, 0u);
  EXPECT_EQ(steep.image.pixels, trace(ramp(15, 11, 170), {}).image.pixels);
}

TEST(Interleaving, SamplesThatShowNothingCountForNothing)
{
  // Its border lies between samples; no pixel of it may take in the background, none of the background
  // may take in it.
  Snapshot s;
  scenes::addPart(s, rectangle(-9.5f, -6.5f, 10.5f, 7.5f)).material = scenes::glowing({ 1, 0.5f, 0 });
  s.camera = parallelCamera(40, 30);
  const Picture every = trace(s, {});
  for (const int n : { 2, 3, 5, 8 })
  {
    for (const bool errorControl : { false, true })
    {
      const Picture some = trace(s, interleaved(n, errorControl));
      for (std::size_t i = 0; i < every.image.pixels.size(); ++i)
      {
        for (int k = 0; k < 4; ++k)
        {
          ASSERT_NEAR(some.image.pixels[i][k], every.image.pixels[i][k], kColorTolerance) << i;
        }
      }
    }
  }
}

TEST(Interleaving, WhatLiesBetweenAllSamplesIsTraced)
{
  Snapshot s; // columns and rows 9 to 11 of samples at 8 and 16
  scenes::addPart(s, rectangle(-11, -11, -8, -8)).material = scenes::glowing({ 0, 1, 0 });
  s.camera = parallelCamera(40, 40);
  for (const bool errorControl : { false, true })
  {
    const Picture some = trace(s, interleaved(8, errorControl));
    EXPECT_EQ(some.result.interleave.traced, 9u);
    EXPECT_EQ(some.at(10, 10), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(some.at(8, 8), glm::vec4(0.0f));
  }
}

// A mirror ball and a glass ball over a lit floor with their shadows.
Snapshot balls(int width, int height)
{
  Snapshot s;
  const auto at = [](double x) { return glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0, 0)); };
  scenes::addPart(s, scenes::sphere(48, 32), at(-1.2)).material = scenes::mirror(0.7f);
  scenes::addPart(s, scenes::sphere(48, 32), at(1.2)).material = scenes::glass(1.5f);
  scenes::addPart(s, scenes::quad({ -9, -1, 9 }, { 9, -1, 9 }, { 9, -1, -9 }, { -9, -1, -9 }));
  s.lights.push_back(Light());
  s.lights.back().kind = Light::Kind::Positional;
  s.lights.back().position = { 3, 6, 4 };
  s.background.top = glm::vec3(0.2f, 0.4f, 0.8f);
  s.camera = scenes::perspective({ 0, 2, 7 }, { 0, 0, 0 }, width, height);
  return s;
}

double rootMeanSquare(const SecondaryImage& a, const SecondaryImage& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
  {
    const glm::dvec4 d = glm::dvec4(a.pixels[i]) - glm::dvec4(b.pixels[i]);
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / (4.0 * static_cast<double>(a.pixels.size())));
}

TEST(Interleaving, ErrorControlIsExactWhereItTracesAndNearElsewhere)
{
  const Snapshot s = balls(201, 150);
  for (const Wanted wanted : { Wanted::Everything, Wanted::SecondaryOnly })
  {
    const Picture every = trace(s, {}, wanted);
    EXPECT_EQ(every.result.interleave.interpolated, 0u);
    for (const int n : { 2, 3, 4 })
    {
      const Picture some = trace(s, interleaved(n, true), wanted);
      const Picture plain = trace(s, interleaved(n, false), wanted);
      const Lattice lattice(s.camera, n);
      std::uint64_t different = 0;
      for (int row = 0; row < 150; ++row)
      {
        for (int column = 0; column < 201; ++column)
        {
          different += some.at(column, row) != every.at(column, row) ? 1 : 0;
          if (lattice.isSample(column, row))
          {
            ASSERT_EQ(some.at(column, row), every.at(column, row));
            ASSERT_EQ(plain.at(column, row), every.at(column, row));
          }
          if (every.hits.ids[std::size_t(row) * 201 + column] == 0)
          {
            ASSERT_EQ(some.at(column, row), every.at(column, row));
            ASSERT_EQ(plain.at(column, row), every.at(column, row));
          }
        }
      }
      EXPECT_GT(different, 0u);
      EXPECT_LE(different, some.result.interleave.interpolated);
      EXPECT_EQ(some.result.interleave.traced + some.result.interleave.interpolated,
        every.result.interleave.traced);
      EXPECT_LT(some.result.interleave.traced, every.result.interleave.traced);
      EXPECT_EQ(plain.result.interleave.traced + plain.result.interleave.interpolated,
        every.result.interleave.traced);
      // The whole point: a fifth of plain interpolation's error at most.
      const double error = rootMeanSquare(some.image, every.image);
      EXPECT_LT(error, rootMeanSquare(plain.image, every.image) / 5) << n;
      ::testing::Test::RecordProperty("n" + std::to_string(n), std::to_string(error));
    }
  }
}

TEST(Interleaving, ErrorControlSeesAShadowsEdge)
{
  // A floor of one colour and one part, with the shadow of a square in the air: where the samples
  // differ in what the light reaches, or in colour, no pixel is blended from both.
  Snapshot s;
  scenes::addPart(s, rectangle(-30, -30, 30, 30));
  Part& caster = scenes::addPart(s, rectangle(-6.3f, -5.2f, 7.1f, 4.4f, 1));
  caster.visibleToCamera = false;
  s.lights.push_back(Light());
  s.lights.back().direction = glm::normalize(glm::dvec3(0.2, 0.1, -1));
  s.camera = parallelCamera(40, 30);
  const Picture every = trace(s, {}), some = trace(s, interleaved(2, true));
  for (std::size_t i = 0; i < every.image.pixels.size(); ++i)
  {
    for (int k = 0; k < 4; ++k)
    {
      ASSERT_NEAR(some.image.pixels[i][k], every.image.pixels[i][k], kColorTolerance) << i;
    }
  }
  EXPECT_GT(some.result.interleave.interpolated, 400u);
  EXPECT_GT(rootMeanSquare(trace(s, interleaved(2, false)).image, every.image), 0.01);
}

TEST(Interleaving, ErrorControlSeesThatEqualColoursAreTwoThings)
{
  // A mirror shows two red boards behind the camera and, between samples, the gap between them.
  Snapshot s;
  scenes::addPart(s, rectangle(-30, -30, 30, 30)).material = scenes::mirror(1.0f);
  const auto red = scenes::glowing({ 1, 0, 0 });
  scenes::addPart(s, rectangle(-30, -30, 1.1f, 30, 12)).material = red;
  scenes::addPart(s, rectangle(1.9f, -30, 30, 30, 12)).material = red;
  s.background.bottom = s.background.top = glm::vec3(0, 0, 1);
  s.camera = parallelCamera(40, 30);
  const Picture every = trace(s, {}), some = trace(s, interleaved(2, true));
  ASSERT_EQ(every.at(20, 7), glm::vec4(1, 0, 0, 1));
  ASSERT_EQ(every.at(21, 7), glm::vec4(0, 0, 1, 1));
  ASSERT_EQ(every.at(22, 7), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(some.image.pixels, every.image.pixels);
  EXPECT_GT(some.result.interleave.interpolated, 800u);
  EXPECT_NE(trace(s, interleaved(2, false)).image.pixels, every.image.pixels);
}

TEST(Interleaving, PrimaryRaysAreThinned)
{
  const Snapshot s = balls(201, 150);
  const Picture every = trace(s, {});
  for (const int n : { 2, 3 })
  {
    const Lattice lattice(s.camera, n);
    const Picture plain = trace(s, interleaved(n, false), Wanted::Everything, true);
    const Picture some = trace(s, interleaved(n, true), Wanted::Everything, true);
    EXPECT_EQ(
      plain.primary.primary.traced, static_cast<std::uint64_t>(lattice.columns() * lattice.rows()));
    EXPECT_LT(some.primary.primary.traced, every.primary.primary.traced);
    for (const Picture* p : { &plain, &some })
    {
      EXPECT_EQ(p->primary.primary.asked, 201u * 150u);
      EXPECT_EQ(
        p->primary.primary.asked, p->primary.primary.answered + p->primary.primary.traced);
    }
    for (int row = 0; row < 150; ++row)
    {
      for (int column = 0; column < 201; ++column)
      {
        const std::size_t pixel = std::size_t(row) * 201 + column;
        const Lattice::Around around = lattice.around(column, row);
        ASSERT_EQ(plain.hits.ids[pixel],
          plain.hits.ids[around.neighbours[around.nearest].pixel]);
        // Nothing in this scene is so thin that no sample sees it.
        ASSERT_EQ(some.hits.ids[pixel], every.hits.ids[pixel]) << column << " " << row;
        // Depths in [-1, 1]; weights are single precision.
        ASSERT_NEAR(some.hits.clipDepths[pixel], every.hits.clipDepths[pixel],
          8 * scenes::kFloatRounding);
      }
    }
  }
}

} // namespace
