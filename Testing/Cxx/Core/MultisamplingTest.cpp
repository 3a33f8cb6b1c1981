// Wrong numbers planted in an item buffer, and what each mode of multisampling makes of them.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Scenes.h"
#include "Testing/Cxx/TracedImages.h"

#include <gtest/gtest.h>

namespace
{

using namespace hrt;

const glm::vec3 kRed(0.75f, 0, 0), kGreen(0, 0.5f, 0), kBlue(0, 0, 0.25f);
constexpr int kSize = 48; // pixels along a side

// Seen along -z by a parallel camera, a pixel a unit: red left and green right of the middle, and a
// blue triangle that no pixel shows.
struct Halves
{
  Snapshot scene;
  BvhStructure structure;
  std::vector<std::uint32_t> ids; // the right ones
  static constexpr std::uint32_t kAway = 5;

  explicit Halves(Material left = scenes::glowing(kRed))
  {
    const auto strip = [](float from, float to, float z) {
      return scenes::quad({ from, 0, z }, { to, 0, z }, { to, kSize, z }, { from, kSize, z });
    };
    scenes::addPart(scene, strip(0, kSize / 2, 0)).material = left;
    scenes::addPart(scene, strip(kSize / 2, kSize, 0)).material = scenes::glowing(kGreen);
    scenes::addPart(scene, scenes::makeGeometry({ { 99, 99, 0 }, { 100, 99, 0 }, { 99, 100, 0 } }))
      .material = scenes::glowing(kBlue);
    scene.background.bottom = scene.background.top = glm::vec3(1.0f);
    Camera& camera = scene.camera;
    camera.width = camera.height = kSize;
    camera.parallel = true;
    camera.worldToView = glm::lookAt(
      glm::dvec3(kSize / 2, kSize / 2, 10), glm::dvec3(kSize / 2, kSize / 2, 0), { 0, 1, 0 });
    const double half = kSize / 2;
    camera.viewToClip = glm::ortho(-half, half, -half, half, 1.0, 20.0);
    prepare();
  }

  void prepare()
  {
    structure.update(scene);
    PrimaryHits hits;
    castPrimaryRays(scene, structure, {}, hits);
    ids = hits.ids;
  }

  static std::size_t at(int column, int row) { return std::size_t(row) * kSize + column; }

  // A square block of pixels around one that all name one triangle.
  std::vector<std::uint32_t> planted(int column, int row, int radius, std::uint32_t id) const
  {
    std::vector<std::uint32_t> wrong = ids;
    for (int y = row - radius; y <= row + radius; ++y)
    {
      for (int x = column - radius; x <= column + radius; ++x)
      {
        wrong[at(x, y)] = id;
      }
    }
    return wrong;
  }

  struct Picture
  {
    SecondaryImage image;
    SecondaryResult result;
    glm::vec4 operator()(int column, int row) const { return image.pixels[at(column, row)]; }
  };
  Picture trace(const std::vector<std::uint32_t>& numbers, Multisampling mode,
    Wanted wanted = Wanted::Everything) const
  {
    Picture picture;
    TracerSettings settings;
    settings.multisampling = mode;
    picture.result = wanted == Wanted::Everything
      ? traceImage(scene, structure, settings, numbers.data(), picture.image)
      : traceSecondary(scene, structure, settings, numbers.data(), picture.image);
    return picture;
  }
};

void expectCounts(const MultisamplingCounts& counts, std::uint64_t failed, std::uint64_t repaired,
  std::uint64_t interpolated, std::uint64_t unresolved)
{
  EXPECT_EQ(counts.failed, failed);
  EXPECT_EQ(counts.repaired, repaired);
  EXPECT_EQ(counts.interpolated, interpolated);
  EXPECT_EQ(counts.unresolved, unresolved);
}

const glm::vec4 kOpaqueRed(kRed, 1), kOpaqueGreen(kGreen, 1), kOpaqueBlue(kBlue, 1), kHole(0.0f);

TEST(Multisampling, EachModeOnOneWrongPixel)
{
  const Halves halves;
  const auto wrong = halves.planted(5, 9, 0, Halves::kAway);
  const auto off = halves.trace(wrong, Multisampling::Off);
  EXPECT_EQ(off(5, 9), kHole);
  expectCounts(off.result.multisampling, 1, 0, 0, 1);
  const auto clamped = halves.trace(wrong, Multisampling::Clamp);
  EXPECT_EQ(clamped(5, 9), kOpaqueBlue); // no pixel is lost, but it shows the wrong triangle
  expectCounts(clamped.result.multisampling, 0, 0, 0, 0);
  for (const Multisampling mode : { Multisampling::Lazy3x3, Multisampling::Lazy5x5,
         Multisampling::Full3x3, Multisampling::Full5x5 })
  {
    const auto repaired = halves.trace(wrong, mode);
    EXPECT_EQ(repaired(5, 9), kOpaqueRed);
    expectCounts(repaired.result.multisampling, 1, 1, 0, 0);
  }
}

TEST(Multisampling, RightPicturesStayAsTheyAre)
{
  const Halves halves;
  const auto expected = halves.trace(halves.ids, Multisampling::Clamp);
  for (const Multisampling mode :
    { Multisampling::Off, Multisampling::Lazy3x3, Multisampling::Full5x5 })
  {
    const auto picture = halves.trace(halves.ids, mode);
    EXPECT_EQ(picture.image.pixels, expected.image.pixels);
    expectCounts(picture.result.multisampling, 0, 0, 0, 0);
  }
}

TEST(Multisampling, ABorderPixelTakesTheRightNeighbour)
{
  const Halves halves;
  // The first column of the green half names a red triangle, as after a snapped corner.
  const int column = kSize / 2;
  const auto wrong = halves.planted(column, 7, 0, halves.ids[Halves::at(column - 1, 7)]);
  EXPECT_EQ(halves.trace(wrong, Multisampling::Clamp)(column, 7), kOpaqueRed);
  EXPECT_EQ(halves.trace(wrong, Multisampling::Lazy3x3)(column, 7), kOpaqueGreen);
}

TEST(Multisampling, WhereNoNeighbourIsMetTheColourIsInterpolated)
{
  const Halves halves;
  // The pixel in the middle of 3x3 wrong ones sees only wrong ones; the eight around it see right
  // ones, five of them red and three, at the right, green.
  const int column = kSize / 2 - 1;
  const auto wrong = halves.planted(column, 9, 1, Halves::kAway);
  const auto lazy = halves.trace(wrong, Multisampling::Lazy3x3);
  expectCounts(lazy.result.multisampling, 9, 8, 1, 0);
  EXPECT_EQ(lazy(column - 1, 9), kOpaqueRed);
  EXPECT_EQ(lazy(column + 1, 9), kOpaqueGreen);
  EXPECT_EQ(lazy(column, 9), glm::vec4((5.0f * kRed + 3.0f * kGreen) / 8.0f, 1.0f));
  // A reach of two pixels finds the triangle itself.
  const auto wide = halves.trace(wrong, Multisampling::Lazy5x5);
  expectCounts(wide.result.multisampling, 9, 9, 0, 0);
  EXPECT_EQ(wide(column, 9), kOpaqueRed);
}

TEST(Multisampling, TheRingGrowsToTheReachAndNoFurther)
{
  const Halves halves;
  // Of 7x7 wrong pixels a reach of 2 repairs the two outer rings; the next sees them, the middle one
  // sees them as its second ring.
  const auto wide = halves.trace(halves.planted(6, 30, 3, Halves::kAway), Multisampling::Lazy5x5);
  expectCounts(wide.result.multisampling, 49, 40, 9, 0);
  EXPECT_EQ(wide(6, 30), kOpaqueRed);
  // Of 5x5 a reach of 1 repairs the outer ring, interpolates the next and gives the middle one up.
  const auto narrow = halves.trace(halves.planted(6, 30, 2, Halves::kAway), Multisampling::Lazy3x3);
  expectCounts(narrow.result.multisampling, 25, 16, 8, 1);
  EXPECT_EQ(narrow(6, 30), kHole);
  EXPECT_EQ(narrow(7, 30), kOpaqueRed);
}

TEST(Multisampling, OnlyFullModesDoubtATriangleThatIsMet)
{
  // Blue behind all, met by every ray. A pixel of the red half names it, as after a lost depth test.
  Halves halves;
  scenes::addPart(halves.scene,
    scenes::quad({ -1, -1, -2 }, { 99, -1, -2 }, { 99, 99, -2 }, { -1, 99, -2 }))
    .material = scenes::glowing(kBlue);
  halves.prepare();
  const std::uint32_t first = halves.scene.parts.back().firstTriangle + 1;
  const std::uint32_t behind = first + 1; // of the square's two the upper left one
  const auto wrong = halves.planted(5, 9, 0, behind);
  EXPECT_EQ(halves.trace(wrong, Multisampling::Off)(5, 9), kOpaqueBlue);
  const auto lazy = halves.trace(wrong, Multisampling::Lazy5x5);
  EXPECT_EQ(lazy(5, 9), kOpaqueBlue);
  expectCounts(lazy.result.multisampling, 0, 0, 0, 0);
  const auto full = halves.trace(wrong, Multisampling::Full3x3);
  EXPECT_EQ(full(5, 9), kOpaqueRed);
  expectCounts(full.result.multisampling, 0, 1, 0, 0);
}

TEST(Multisampling, OfEquallyNearTrianglesTheLargestNumberWins)
{
  Halves halves;
  scenes::addPart(halves.scene, halves.scene.parts[0].geometry).material = scenes::glowing(kBlue);
  halves.prepare();
  const std::uint32_t twin = halves.ids[Halves::at(5, 9)] - halves.scene.parts[3].firstTriangle;
  const auto wrong = halves.planted(5, 9, 0, twin);
  EXPECT_EQ(halves.trace(wrong, Multisampling::Lazy3x3)(5, 9), kOpaqueRed);
  EXPECT_EQ(halves.trace(wrong, Multisampling::Full3x3)(5, 9), kOpaqueBlue);
}

TEST(Multisampling, NeighboursBeyondTheClipPlanesDoNotCount)
{
  Halves halves;
  // Nearer than the near plane, which lies at z = 9; no pixel shows it.
  scenes::addPart(halves.scene, scenes::quad({ 0, 0, 9.5f }, { 20, 0, 9.5f }, { 20, 20, 9.5f },
                                  { 0, 20, 9.5f }))
    .material = scenes::glowing(kBlue);
  halves.prepare();
  ASSERT_EQ(halves.ids, Halves().ids);
  auto wrong = halves.planted(5, 9, 1, halves.scene.parts.back().firstTriangle + 1);
  wrong[Halves::at(5, 9)] = halves.ids[Halves::at(5, 9)];
  EXPECT_EQ(halves.trace(wrong, Multisampling::Full3x3)(5, 9), kOpaqueRed);
  wrong[Halves::at(5, 9)] = Halves::kAway;
  EXPECT_NE(halves.trace(wrong, Multisampling::Lazy3x3)(5, 9), kOpaqueBlue);
}

TEST(Multisampling, FullModesFillWhatTheRasteriserLeftOut)
{
  const Halves halves;
  const auto wrong = halves.planted(5, 9, 0, 0);
  for (const Multisampling mode :
    { Multisampling::Off, Multisampling::Clamp, Multisampling::Lazy5x5 })
  {
    EXPECT_EQ(halves.trace(wrong, mode)(5, 9), kHole);
  }
  const auto full = halves.trace(wrong, Multisampling::Full3x3);
  EXPECT_EQ(full(5, 9), kOpaqueRed);
  expectCounts(full.result.multisampling, 0, 1, 0, 0);
}

TEST(Multisampling, NumbersOutOfRangeAreNoNeighbours)
{
  const Halves halves;
  auto wrong = halves.planted(5, 9, 1, 4000000000u);
  wrong[Halves::at(5, 9)] = Halves::kAway;
  const auto lazy = halves.trace(wrong, Multisampling::Lazy3x3);
  EXPECT_EQ(lazy.result.invalidIds, 8u);
  expectCounts(lazy.result.multisampling, 1, 0, 0, 1);
  EXPECT_EQ(lazy(5, 9), kHole);
}

TEST(Multisampling, SecondaryRaysStartWhereAMirrorIsAfterTheRepair)
{
  const Halves halves(scenes::mirror(0.25f));
  const glm::vec4 none(0, 0, 0, 1), mirrored(0.25f, 0.25f, 0.25f, 0.75f);
  const auto secondary = Wanted::SecondaryOnly;
  const int column = kSize / 2;
  // A pixel of the mirror names the green triangle beside it, and one of the green half the mirror.
  const auto lost = halves.planted(column - 1, 7, 0, halves.ids[Halves::at(column, 7)]);
  EXPECT_EQ(halves.trace(lost, Multisampling::Clamp, secondary)(column - 1, 7), none);
  const auto found = halves.trace(lost, Multisampling::Lazy3x3, secondary);
  EXPECT_EQ(found(column - 1, 7), mirrored);
  EXPECT_EQ(found.result.pixels, std::uint64_t(kSize * kSize / 2));

  const auto added = halves.planted(column, 7, 0, halves.ids[Halves::at(column - 1, 7)]);
  EXPECT_EQ(halves.trace(added, Multisampling::Clamp, secondary)(column, 7), mirrored);
  const auto removed = halves.trace(added, Multisampling::Lazy3x3, secondary);
  EXPECT_EQ(removed(column, 7), none);
  EXPECT_EQ(removed.result.pixels, std::uint64_t(kSize * kSize / 2));
  EXPECT_EQ(halves.trace(added, Multisampling::Off, secondary)(column, 7), none);
}

} // namespace
