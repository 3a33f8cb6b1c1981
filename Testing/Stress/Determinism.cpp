// Row 18, and what it rests on: the same bytes for any number of threads, any instruction set and any
// grouping of rays.
#include "Testing/Cxx/TracedImages.h"
#include "Testing/Stress/Stress.h"


#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <limits>

using namespace hrt;
using namespace hrt::stress;

namespace
{

class Determinism : public EveryEngine
{
};

Snapshot lively(int width, int height)
{
  Snapshot s;
  scenes::addPart(s, scenes::torus(64, 32, 1.0, 0.4)).material = scenes::mirror(0.4f, { 0.3f, 0.4f, 0.6f });
  Part& ball = scenes::addPart(
    s, scenes::sphere(48, 32), glm::translate(glm::dmat4(1.0), glm::dvec3(0.9, 0.2, 1.0)));
  ball.material = scenes::glass(1.5f);
  ball.castsShadow = false;
  scenes::addPart(s, scenes::quad({ -5, -1, 5 }, { 5, -1, 5 }, { 5, -1, -5 }, { -5, -1, -5 }));
  Light lamp;
  lamp.kind = Light::Kind::Positional;
  lamp.position = { 2, 5, 3 };
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(1, -2, -1));
  sun.color = glm::vec3(0.4f);
  s.lights = { lamp, sun };
  s.background = { { 0.1f, 0.2f, 0.3f }, { 0.6f, 0.7f, 0.9f }, { 0, 1, 0 } };
  s.camera = scenes::perspective({ 0, 1, 6 }, { 0, 0, 0 }, width, height);
  return s;
}

struct Frame
{
  PrimaryHits hits;
  SecondaryImage image;

  Frame(const Snapshot& s, const Structure& structure)
  {
    castPrimaryRays(s, structure, {}, this->hits);
    TracerSettings settings;
    settings.maximumDepth = 5;
    traceImage(s, structure, settings, this->hits.ids.data(), this->image);
  }

  bool operator==(const Frame& o) const
  {
    const auto same = [](const auto& a, const auto& b) {
      return a.size() == b.size() &&
        std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
    };
    return same(this->hits.ids, o.hits.ids) && same(this->hits.clipDepths, o.hits.clipDepths) &&
      same(this->image.pixels, o.image.pixels);
  }
};

} // namespace

// The exact kernel needs gradual underflow and rounding to nearest: nothing that the tests link may
// have switched either off.
TEST(FloatingPointMode, Row18GradualUnderflow)
{
  volatile double smallest = std::numeric_limits<double>::min();
  volatile double half = smallest / 2.0;
  EXPECT_GT(half, 0.0) << "flush-to-zero is on";
  EXPECT_EQ(half * 2.0, smallest) << "denormals-are-zero is on";
  volatile float smallestFloat = std::numeric_limits<float>::min();
  volatile float halfFloat = smallestFloat / 2.0f;
  EXPECT_GT(halfFloat, 0.0f);
  volatile double one = 1.0, little = 0x1p-54;
  EXPECT_EQ(one + little, 1.0) << "not rounding to nearest";
  EXPECT_EQ(-one - little, -1.0);
}

TEST_P(Determinism, Row18ThreadsDoNotShow)
{
  const int size = isFull() ? 800 : 160;
  const Snapshot s = lively(size, size * 3 / 4);
  const auto structure = built(s);
  const auto frameBy = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(threads);
    return arena.execute([&] { return Frame(s, *structure); });
  };
  const Frame first = frameBy(1);
  std::size_t different = 0, runs = 0;
  for (const int threads : { 1, 2, 8 })
  {
    for (std::size_t i = 0; i < scaled(20.0, 3.0); ++i, ++runs)
    {
      different += frameBy(threads) == first ? 0 : 1;
    }
  }
  report(18, std::string("threads ") + GetParam().name,
    "%zu of %zu pictures by 1, 2 and 8 threads differ in any byte (0 allowed)", different, runs);
  EXPECT_EQ(different, 0u);
}

TEST_P(Determinism, Row18StreamsAndSingleRays)
{
  const Snapshot s = lively(1, 1);
  const auto structure = built(s);
  scenes::Random random(18);
  std::size_t different = 0, rays = 0;
  for (const std::size_t count : { 1, 4, 8, 16, 3, 7, 33, 1000 })
  {
    for (std::size_t round = 0; round < scaled(2000.0, 40.0); ++round)
    {
      // Coherent ones: from one point into a small part of the picture; every fourth fan scattered.
      const bool scattered = round % 4 == 3;
      const glm::dvec3 eye = 6.0 * random.direction(), at = random.inBox(1.5);
      std::vector<Ray> fan(count);
      for (Ray& ray : fan)
      {
        ray = rayTo(scattered ? 6.0 * random.direction() : eye, at + random.inBox(0.2));
        ray.tMaximum = random.below(3) == 0 ? random(0.5, 1.1) : ray.tMaximum;
      }
      fan[random.below(count)].direction.x = std::numeric_limits<double>::quiet_NaN();
      for (const RayOrder order : { RayOrder::Coherent, RayOrder::Incoherent })
      {
        std::vector<Hit> hits(count);
        std::vector<std::uint8_t> blocked(count);
        structure->intersect(fan.data(), hits.data(), count, order);
        structure->occluded(fan.data(), blocked.data(), count, order);
        for (std::size_t i = 0; i < count; ++i)
        {
          different += sameHit(hits[i], structure->intersect(fan[i])) &&
              (blocked[i] != 0) == structure->occluded(fan[i])
            ? 0
            : 1;
        }
        rays += count;
      }
      if (count >= 1000 && round >= scaled(100.0, 4.0))
      {
        break;
      }
    }
  }
  report(18, std::string("streams ") + GetParam().name,
    "%zu of %zu rays answered otherwise in a stream than alone (0 allowed)", different, rays);
  EXPECT_EQ(different, 0u);
}

// Embree chooses its code by the processor, and ours goes with it; its device can be told to choose
// another. Those that the processor lacks, it refuses.
TEST(InstructionSets, Row18EmbreeByEachOfThem)
{
  const int size = isFull() ? 400 : 120;
  const Snapshot s = lively(size, size * 3 / 4);
  BvhStructure own;
  own.update(s);
  const Frame expected(s, own);
  int compared = 0;
  for (const char* set : { "sse2", "sse4.2", "avx", "avx2", "avx512" })
  {
    std::unique_ptr<BvhStructure> structure;
    try
    {
      structure = std::make_unique<BvhStructure>(std::string("isa=") + set);
    }
    catch (const std::exception& refusal)
    {
      report(18, std::string("instruction set ") + set, "refused by this processor (%s)",
        refusal.what());
      continue;
    }
    structure->update(s);
    const bool same = Frame(s, *structure) == expected;
    report(18, std::string("instruction set ") + set, "%s (the same bytes required)",
      same ? "the same bytes" : "another picture");
    EXPECT_TRUE(same) << set;
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

// All structures draw one picture: that of no structure at all.
TEST_P(Determinism, Row18EveryStructureTheSamePicture)
{
  const int width = isFull() ? 160 : 24;
  const Snapshot s = lively(width, width * 3 / 4);
  scenes::BruteForce truth;
  truth.update(s);
  const bool same = Frame(s, *built(s)) == Frame(s, truth);
  report(18, std::string("picture ") + GetParam().name, "%s (brute force's bytes required)",
    same ? "brute force's bytes" : "another picture");
  EXPECT_TRUE(same);
}

HRT_STRESS_EVERY_ENGINE(Determinism);
