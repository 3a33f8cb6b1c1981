// Pixel bounds: how they are clamped, and that a part left out of a tile shows in none of its pixels.
#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Plan/Facts.h"
#include "Rendering/Core/Plan/PixelFrustum.h"
#include "Rendering/Core/Plan/Settings.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace hrt;

constexpr int kWidth = 64, kHeight = 48;

PixelBounds bounds(int x0, int x1, int y0, int y1)
{
  return PixelBounds{ x0, x1, y0, y1 };
}

TEST(PixelBounds, AreClampedToThePicture)
{
  constexpr int kMost = std::numeric_limits<int>::max();
  constexpr int kLeast = std::numeric_limits<int>::min();
  const PixelBounds nothing = bounds(0, 0, 0, 0);
  const struct
  {
    PixelBounds asked, inside;
  } table[] = {
    { PixelBounds(), bounds(0, kWidth, 0, kHeight) },
    { bounds(kLeast, kMost, kLeast, kMost), bounds(0, kWidth, 0, kHeight) },
    { bounds(3, 5, 7, 9), bounds(3, 5, 7, 9) },
    { bounds(-3, 5, 40, 90), bounds(0, 5, 40, kHeight) },
    { bounds(63, 64, 47, 48), bounds(63, 64, 47, 48) },
    { bounds(64, 70, 0, 48), nothing },
    { bounds(0, 64, -9, 0), nothing },
    { bounds(5, 5, 0, 9), nothing },
    { bounds(5, 4, 0, 9), nothing },
    { bounds(0, -1, 0, -1), nothing },
    { bounds(kMost, kLeast, kMost, kLeast), nothing },
  };
  for (const auto& row : table)
  {
    const PixelBounds inside = row.asked.within(kWidth, kHeight);
    EXPECT_EQ(inside, row.inside) << row.asked.x0 << " " << row.asked.x1;
    EXPECT_EQ(inside.within(kWidth, kHeight), inside);
    EXPECT_EQ(inside.empty(), inside.pixels() == 0);
  }
  EXPECT_TRUE(PixelBounds().within(0, 0).empty());
}

// What looks at neighbours needs them drawn and traced too, but no more than the picture has.
TEST(PixelBounds, GrowByWhatAPixelDependsOn)
{
  Settings settings;
  const auto traced = [&](const PixelBounds& wanted) {
    settings.setBounds(wanted, kWidth, kHeight);
    return settings.tracedBounds;
  };
  EXPECT_EQ(traced(bounds(10, 20, 0, 5)), bounds(10, 20, 0, 5));
  settings.multisampling = Multisampling::Full5x5;
  EXPECT_EQ(traced(bounds(10, 20, 0, 5)), bounds(6, 24, 0, 9));
  settings.interleave = 4;
  EXPECT_EQ(traced(bounds(10, 20, 0, 5)), bounds(3, 27, 0, 12));
  EXPECT_EQ(settings.bounds, bounds(10, 20, 0, 5));
  settings.visibility = Visibility::RayCasting; // which needs no multisampling
  EXPECT_EQ(traced(bounds(10, 20, 0, 5)), bounds(7, 23, 0, 8));
  EXPECT_EQ(traced(PixelBounds()), bounds(0, kWidth, 0, kHeight));
  EXPECT_TRUE(traced(bounds(0, 0, 5, 9)).empty());
}

TEST(PixelBounds, RowsGoToTheirPlace)
{
  const int packed[] = { 1, 2, 3, 4 };
  std::vector<int> picture(4 * 3, 0);
  placeRows(packed, bounds(1, 3, 1, 3), 4, picture);
  EXPECT_EQ(picture, std::vector<int>({ 0, 0, 0, 0, 0, 1, 2, 0, 0, 3, 4, 0 }));
}

// Where the corners of a part are in the picture, in pixels; false when one is behind the eye.
bool columnsAndRows(const Snapshot& s, const Part& part, double low[2], double high[2])
{
  const glm::dmat4 toClip = s.camera.viewToClip * s.camera.worldToView * part.positionsToWorld();
  const double size[2] = { double(s.camera.width), double(s.camera.height) };
  std::fill_n(low, 2, std::numeric_limits<double>::infinity());
  std::fill_n(high, 2, -std::numeric_limits<double>::infinity());
  for (const glm::vec3& p : part.geometry->positions)
  {
    const glm::dvec4 clip = toClip * glm::dvec4(glm::dvec3(p), 1.0);
    if (clip.w <= 0.0)
    {
      return false;
    }
    for (int axis = 0; axis < 2; ++axis)
    {
      const double at = (clip[axis] / clip.w * 0.5 + 0.5) * size[axis];
      low[axis] = std::min(low[axis], at);
      high[axis] = std::max(high[axis], at);
    }
  }
  return true;
}

// Random triangles before a camera: whatever touches the bounds must be kept, and what is left out of
// every tile of a division lies outside of the picture. That it also leaves something out is counted.
TEST(PixelFrustum, LeavesOutOnlyWhatNoPixelShows)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<float> across(-4.0f, 4.0f), size(-0.7f, 0.7f);
  std::size_t kept = 0, left = 0;
  for (int round = 0; round < 400; ++round)
  {
    Snapshot s;
    s.camera = scenes::perspective({ 0, 0, 10 }, { 0, 0, 0 }, kWidth, kHeight, 40.0);
    const glm::vec3 centre(across(random), across(random), across(random));
    const auto corner = [&] { return centre + glm::vec3(size(random), size(random), size(random)); };
    scenes::addPart(s, scenes::makeGeometry({ corner(), corner(), corner() }), glm::dmat4(1.0));
    const Part& part = s.parts.back();
    double low[2], high[2];
    ASSERT_TRUE(columnsAndRows(s, part, low, high));
    for (int tile = 0; tile < 16; ++tile)
    {
      const PixelBounds b =
        bounds(tile % 4 * 16, tile % 4 * 16 + 16, tile / 4 * 12, tile / 4 * 12 + 12);
      const bool touches = low[0] < b.x1 && high[0] > b.x0 && low[1] < b.y1 && high[1] > b.y0;
      const bool shown = PixelFrustum(s.camera, b).mayShow(part);
      EXPECT_TRUE(shown || !touches) << round << " " << tile;
      kept += shown ? 1 : 0;
      left += shown ? 0 : 1;
    }
  }
  // A triangle of 1.4 at most spans 9 of 64 columns: 4 of the 16 tiles at the very most.
  EXPECT_GT(left, 3 * kept);
}

// Right at an edge: the margin is half a pixel towards the centres plus the rounding of a vertex.
TEST(PixelFrustum, KeepsWhatRoundingCouldMove)
{
  Snapshot s;
  s.camera.width = kWidth;
  s.camera.height = kHeight;
  // Clip space itself, far from its origin: a vertex at 1e6 rounds to 1/16.
  Part& part = scenes::addPart(s, scenes::makeGeometry({ { 1e6f, 0, 0 }, { 1e6f, 1, 0 }, { 1e6f, 0, 0 } }));
  const auto shownAt = [&](double x) {
    part.localToWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(x - 1e6, 0.0, 0.0));
    return PixelFrustum(s.camera, PixelBounds()).mayShow(part);
  };
  EXPECT_TRUE(shownAt(1.0));
  EXPECT_TRUE(shownAt(1.05));
  EXPECT_FALSE(shownAt(3.0));
}

TEST(PixelFrustum, NothingIsInEmptyBounds)
{
  Snapshot s;
  s.camera = scenes::perspective({ 0, 0, 10 }, { 0, 0, 0 }, kWidth, kHeight, 40.0);
  scenes::addPart(s, scenes::sphere(8, 4));
  const Part& ball = s.parts.back();
  EXPECT_TRUE(PixelFrustum(s.camera, PixelBounds()).mayShow(ball));
  EXPECT_FALSE(PixelFrustum(s.camera, bounds(5, 5, 0, 9)).mayShow(ball));
  EXPECT_FALSE(PixelFrustum(s.camera, bounds(0, 99, 48, 99)).mayShow(ball));
}

// The facts are those of the bounds, but for shadows, which come from outside too.
TEST(PixelFrustum, FactsAreThoseOfTheBounds)
{
  Snapshot s;
  s.camera = scenes::perspective({ 0, 0, 10 }, { 0, 0, 0 }, kWidth, kHeight, 40.0);
  scenes::addPart(s, scenes::sphere(8, 4), glm::translate(glm::dmat4(1.0), glm::dvec3(-2.5, 0, 0)));
  scenes::addPart(s, scenes::sphere(8, 4), glm::translate(glm::dmat4(1.0), glm::dvec3(2.5, 0, 0)))
    .material.reflectance = 0.5f;
  const Facts all = gatherFacts(s);
  EXPECT_EQ(all.partInView, std::vector<bool>({ true, true }));
  EXPECT_TRUE(all.mirrorInView);
  const Facts left = gatherFacts(s, bounds(0, 32, 0, kHeight));
  EXPECT_EQ(left.partInView, std::vector<bool>({ true, false }));
  EXPECT_TRUE(left.anyPartInView && left.anyCaster);
  EXPECT_FALSE(left.mirrorInView);
  const Facts corner = gatherFacts(s, bounds(0, 64, 0, 4));
  EXPECT_FALSE(corner.anyPartInView);
  EXPECT_TRUE(corner.anyCaster);
}

} // namespace
