// The picture's second passes and the order of its work: whatever arrives first and whoever traces it,
// the picture is one.
#include "Rendering/Core/Structures/EmbreeStructure.h"
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
  EmbreeStructure structure;
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
