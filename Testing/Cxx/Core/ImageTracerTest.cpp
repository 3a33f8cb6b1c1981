// The picture's second passes and the order of its work: whatever arrives first and whoever traces it,
// the picture is one.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Tracing/ImageTracer.h"
#include "Scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace
{

using namespace hrt;

void expectSamePicture(const SecondaryImage& a, const SecondaryImage& b)
{
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(a.pixels[0])), 0);
}

void expectSameCounts(const RayCount& a, const RayCount& b)
{
  EXPECT_EQ(a.asked, b.asked);
  EXPECT_EQ(a.answered, b.answered);
  EXPECT_EQ(a.traced, b.traced);
}

// A mirror ball and a glass ball over a lit floor, with ids by primary rays.
struct Balls
{
  Snapshot scene;
  BvhStructure structure;
  PrimaryHits hits;

  Balls(int width, int height)
  {
    const auto at = [](double x) { return glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0, 0)); };
    scenes::addPart(scene, scenes::sphere(24, 16), at(-1.2)).material = scenes::mirror(0.7f);
    scenes::addPart(scene, scenes::sphere(24, 16), at(1.2)).material = scenes::glass(1.5f);
    scenes::addPart(
      scene, scenes::quad({ -9, -1, 9 }, { 9, -1, 9 }, { 9, -1, -9 }, { -9, -1, -9 }));
    scene.lights.push_back(Light());
    scene.lights.back().kind = Light::Kind::Positional;
    scene.lights.back().position = { 3, 6, 4 };
    scene.background.top = glm::vec3(0.2f, 0.4f, 0.8f);
    scene.camera = scenes::perspective({ 0, 2, 7 }, { 0, 0, 0 }, width, height);
    structure.update(scene);
    castPrimaryRays(scene, structure, {}, hits);
  }

  SecondaryResult trace(
    const TracerSettings& settings, Wanted wanted, SecondaryImage& image, int band) const
  {
    // Rows that were not announced must not be read: they hold another triangle until then.
    std::vector<std::uint32_t> arriving(hits.ids.size(), 1);
    ImageTracer tracer(scene, structure, settings, wanted, arriving.data(), image);
    const int width = scene.camera.width, height = scene.camera.height;
    for (int row = 0; row < height; row += band)
    {
      const int end = std::min(row + band, height);
      std::copy(hits.ids.begin() + row * width, hits.ids.begin() + end * width,
        arriving.begin() + row * width);
      tracer.idsReady(end);
      if (band >= 32)
      {
        // Lets the background tasks come to what has not arrived, if they look at it.
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    return tracer.finish();
  }
};

void expectSameCounts(const SecondaryResult& a, const SecondaryResult& b)
{
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.multisampling.failed, b.multisampling.failed);
  EXPECT_EQ(a.multisampling.repaired, b.multisampling.repaired);
  EXPECT_EQ(a.multisampling.interpolated, b.multisampling.interpolated);
  EXPECT_EQ(a.multisampling.unresolved, b.multisampling.unresolved);
  EXPECT_EQ(a.interleave.traced, b.interleave.traced);
  EXPECT_EQ(a.interleave.interpolated, b.interleave.interpolated);
  expectSameCounts(a.rays.reflection, b.rays.reflection);
  expectSameCounts(a.rays.refraction, b.rays.refraction);
  expectSameCounts(a.rays.shadow, b.rays.shadow);
}

// Every seventh pixel names the triangle of a pixel two columns and two rows away.
void plantErrors(Balls& balls)
{
  const int width = balls.scene.camera.width, height = balls.scene.camera.height;
  const std::vector<std::uint32_t> right = balls.hits.ids;
  for (int row = 0; row + 2 < height; ++row)
  {
    for (int column = row % 7; column + 2 < width; column += 7)
    {
      balls.hits.ids[row * width + column] = right[(row + 2) * width + column + 2];
    }
  }
}

TEST(ImageTracer, IsTheSameForAnyBandsAndThreads)
{
  Balls balls(150, 101);
  plantErrors(balls);
  TracerSettings lazy, full, interleaved, all;
  lazy.multisampling = Multisampling::Lazy3x3;
  full.multisampling = Multisampling::Full5x5;
  interleaved.interleave = 3;
  all.multisampling = Multisampling::Lazy5x5;
  all.interleave = 2;
  for (const Wanted wanted : { Wanted::Everything, Wanted::SecondaryOnly })
  {
    for (const TracerSettings& settings : { TracerSettings(), lazy, full, interleaved, all })
    {
      SecondaryImage reference;
      const SecondaryResult expected = balls.trace(settings, wanted, reference, 101);
      EXPECT_GT(expected.rays.reflection.traced, 100u);
      EXPECT_GT(expected.rays.refraction.traced, 100u);
      EXPECT_EQ(expected.multisampling.repaired > 100, reachOf(settings.multisampling) > 0);
      EXPECT_EQ(expected.interleave.interpolated > 100, settings.interleave > 1);
      for (const int band : { 1, 7, 32, 64 })
      {
        for (const int threads : { 1, 2, 5 })
        {
          const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
          SecondaryImage image;
          expectSameCounts(balls.trace(settings, wanted, image, band), expected);
          expectSamePicture(image, reference);
        }
      }
    }
  }
}

// With many paths, ambient light and three lights behind shadow rays: whichever pixels are traced with it.
TEST(ImageTracer, APixelAloneIsThatOfThePicture)
{
  const int width = 96, height = 64;
  Balls balls(width, height);
  for (const glm::dvec3 position : { glm::dvec3(-5, 4, 3), glm::dvec3(0, 7, -2) })
  {
    balls.scene.lights.push_back(balls.scene.lights.front());
    balls.scene.lights.back().position = position;
    balls.scene.lights.back().color = { 0.3f, 0.7f, 0.1f };
  }
  balls.scene.parts[1].material.front.specular = 0.4f;
  balls.scene.parts[1].material.back = balls.scene.parts[1].material.front;
  balls.scene.parts[2].material.front.ambient = 0.37f;
  balls.scene.parts[2].material.front.ambientColor = { 0.9f, 0.3f, 0.6f };
  balls.scene.parts[2].material.reflectance = 0.3f;
  // Glass within glass: ways of equal length through the one and the other.
  for (const double size : { 0.8, 0.6 })
  {
    const glm::dmat4 place = balls.scene.parts[1].localToWorld;
    scenes::addPart(balls.scene, scenes::sphere(24, 16),
      glm::scale(place, glm::dvec3(size))).material = balls.scene.parts[1].material;
  }
  balls.structure.update(balls.scene);
  castPrimaryRays(balls.scene, balls.structure, {}, balls.hits);
  TracerSettings settings;
  settings.maximumDepth = 6;
  SecondaryImage whole;
  balls.trace(settings, Wanted::Everything, whole, 20);
  // Alone a pixel's paths stand side by side in the lanes, in the picture far from each other.
  for (int pixel = 0; pixel < width * height; pixel += 7)
  {
    const int x = pixel % width, y = pixel / width;
    settings.bounds = { x, x + 1, y, y + 1 };
    SecondaryImage alone;
    balls.trace(settings, Wanted::Everything, alone, 20);
    ASSERT_EQ(alone.pixels[pixel], whole.pixels[pixel]) << x << ", " << y;
  }
}

// Tiles that cut those of the tracer at will: put together they are the picture and its rays, and no
// tile writes a pixel of another.
TEST(ImageTracer, TracesWhatLiesWithinTheBounds)
{
  const int width = 150, height = 101;
  const Balls balls(width, height);
  const int columns[] = { 0, 1, 40, 97, width }, rows[] = { 0, 33, 64, height };
  for (const Wanted wanted : { Wanted::Everything, Wanted::SecondaryOnly })
  {
    TracerSettings settings;
    SecondaryImage whole;
    const SecondaryResult expected = balls.trace(settings, wanted, whole, height);
    const glm::vec4 nothing(0.0f, 0.0f, 0.0f, wanted == Wanted::Everything ? 0.0f : 1.0f);
    SecondaryImage together = whole;
    std::fill(together.pixels.begin(), together.pixels.end(), glm::vec4(-1.0f));
    PrimaryHits hits = balls.hits;
    std::fill(hits.ids.begin(), hits.ids.end(), 0);
    SecondaryResult sum;
    for (int tile = 0; tile < 12; ++tile)
    {
      const PixelBounds b{ columns[tile % 4], columns[tile % 4 + 1], rows[tile / 4],
        rows[tile / 4 + 1] };
      settings.bounds = b;
      SecondaryImage image;
      sum += balls.trace(settings, wanted, image, 20);
      PrimaryHits found;
      sum.rays += castPrimaryRays(balls.scene, balls.structure, settings, found);
      for (int pixel = 0; pixel < width * height; ++pixel)
      {
        const int x = pixel % width, y = pixel / width;
        const bool inside = x >= b.x0 && x < b.x1 && y >= b.y0 && y < b.y1;
        if (inside)
        {
          together.pixels[pixel] = image.pixels[pixel];
          hits.ids[pixel] = found.ids[pixel];
          hits.clipDepths[pixel] = found.clipDepths[pixel];
        }
        else
        {
          ASSERT_EQ(image.pixels[pixel], nothing) << pixel;
          ASSERT_EQ(found.ids[pixel], 0u) << pixel;
          ASSERT_EQ(found.clipDepths[pixel], 1.0) << pixel;
        }
      }
    }
    expectSamePicture(together, whole);
    EXPECT_EQ(hits.ids, balls.hits.ids);
    EXPECT_EQ(hits.clipDepths, balls.hits.clipDepths);
    EXPECT_EQ(sum.pixels, expected.pixels);
    EXPECT_EQ(sum.rays.primary.asked, std::uint64_t(width * height));
    expectSameCounts(sum.rays.reflection, expected.rays.reflection);
    expectSameCounts(sum.rays.refraction, expected.rays.refraction);
    expectSameCounts(sum.rays.shadow, expected.rays.shadow);
  }
}

// With a margin of what a pixel depends on, repairs and interpolation give a tile the pixels of the whole
// picture. Every eleventh id is a wrong one, so that there is something to repair.
TEST(ImageTracer, LooksNoFartherThanItSays)
{
  const int width = 150, height = 101;
  Balls balls(width, height);
  const std::vector<std::uint32_t> right = balls.hits.ids;
  std::vector<std::uint32_t> wrong = right;
  for (std::size_t i = 0; i < right.size(); i += 11)
  {
    wrong[i] = right[(i + 5 * width + 5) % right.size()];
  }
  const PixelBounds tiles[] = { { 0, 40, 0, 33 }, { 40, 41, 0, 101 }, { 97, 150, 33, 64 },
    { 50, 90, 60, 101 }, { 149, 150, 100, 101 } };
  for (const Multisampling mode : { Multisampling::Off, Multisampling::Clamp,
         Multisampling::Lazy3x3, Multisampling::Full3x3, Multisampling::Lazy5x5,
         Multisampling::Full5x5 })
  {
    for (const int interleave : { 1, 3, 7, -7 }) // negative: without error control
    {
      TracerSettings settings;
      settings.multisampling = mode;
      settings.interleave = std::abs(interleave);
      settings.interleaveErrorControl = interleave > 0;
      PrimaryHits cast;
      castPrimaryRays(balls.scene, balls.structure, settings, cast);
      for (const Wanted wanted : { Wanted::Everything, Wanted::SecondaryOnly })
      {
        settings.bounds = PixelBounds();
        SecondaryImage whole, part;
        balls.hits.ids = wrong;
        balls.trace(settings, wanted, whole, height);
        for (const PixelBounds& b : tiles)
        {
          settings.bounds = b.grownBy(pixelsAround(settings.multisampling, settings.interleave));
          const PixelBounds known = settings.bounds.within(width, height);
          for (int pixel = 0; pixel < width * height; ++pixel)
          {
            const int x = pixel % width, y = pixel / width;
            const bool drawn = x >= known.x0 && x < known.x1 && y >= known.y0 && y < known.y1;
            balls.hits.ids[pixel] = drawn ? wrong[pixel] : 0;
          }
          balls.trace(settings, wanted, part, 16);
          PrimaryHits found;
          castPrimaryRays(balls.scene, balls.structure, settings, found);
          for (int y = b.y0; y < b.y1; ++y)
          {
            for (int x = b.x0; x < b.x1; ++x)
            {
              const int pixel = y * width + x;
              ASSERT_EQ(part.pixels[pixel], whole.pixels[pixel])
                << int(mode) << " " << interleave << " " << x << " " << y;
              ASSERT_EQ(found.ids[pixel], cast.ids[pixel]) << interleave << " " << x << " " << y;
            }
          }
        }
      }
    }
  }
}

TEST(ImageTracer, MayBeGivenUpHalfWay)
{
  const Balls balls(150, 101);
  SecondaryImage image;
  const TracerSettings settings;
  {
    ImageTracer tracer(
      balls.scene, balls.structure, settings, Wanted::Everything, balls.hits.ids.data(), image);
    tracer.idsReady(70);
  }
  EXPECT_EQ(image.width, 150);
  EXPECT_EQ(image.height, 101);
  // Nothing writes to it any more.
  const SecondaryImage before = image;
  tbb::parallel_for(0, 100, [](int) {});
  expectSamePicture(image, before);
}

// A structure that fails, as one does that runs out of memory.
class Failing final : public Structure
{
public:
  StructureReport update(const Snapshot&) override { return {}; }
  Hit intersect(const Ray&) const override { throw std::runtime_error("no memory"); }
  void intersectAll(const Ray&, std::vector<Hit>&) const override
  {
    throw std::runtime_error("no memory");
  }
  bool occluded(const Ray&) const override { throw std::runtime_error("no memory"); }
};

TEST(ImageTracer, HandsOnWhatATaskThrew)
{
  const Balls balls(64, 64);
  SecondaryImage image;
  const Failing failing;
  const TracerSettings settings;
  ImageTracer tracer(
    balls.scene, failing, settings, Wanted::Everything, balls.hits.ids.data(), image);
  tracer.idsReady(40);
  EXPECT_THROW(tracer.finish(), std::runtime_error);
}

} // namespace
