// Packets of rays through the Embree structure answer as single rays do, bit by bit: of any fill,
// on any instruction set, through one level and through two.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "StructureChecks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace hrt;
using scenes::Random;

// One level: everything merged. Two: some parts have moved since.
Snapshot scene(BvhStructure& embree, bool twoLevels)
{
  Snapshot s;
  scenes::addPart(s, scenes::torus(48, 24, 1.5, 0.5));
  for (int i = 0; i < 6; ++i)
  {
    scenes::addPart(s, scenes::sphere(16, 8),
      glm::scale(
        glm::translate(glm::dmat4(1.0), { 0.5 * i - 1.5, 0.1 * i, 0.2 * i }), glm::dvec3(0.5)));
  }
  embree.update(s);
  if (twoLevels)
  {
    for (int i = 1; i < 5; ++i)
    {
      s.parts[i].localToWorld[3][1] += 0.2;
    }
    s.parts[2].castsShadow = false;
    s.parts[3].visibleToRays = false;
    embree.update(s);
  }
  return s;
}

class BvhPacket : public ::testing::TestWithParam<const char*>
{
};

TEST_P(BvhPacket, OfAnyFillEqualsBruteForce)
{
  for (bool twoLevels : { false, true })
  {
    BvhStructure embree(GetParam());
    const Snapshot s = scene(embree, twoLevels);
    scenes::BruteForce reference;
    reference.update(s);
    Random random(41);
    for (int fill = 1; fill <= 16; ++fill)
    {
      EXPECT_EQ(
        checks::wrongAnswers(embree, reference, checks::raysFromOnePoint(s, random, fill)), 0);
      EXPECT_EQ(checks::wrongAnswers(embree, reference, checks::randomRays(s, random, fill)), 0);
    }
    for (int i = 0; i < 6; ++i) // longer streams, the last packet partly filled
    {
      EXPECT_EQ(
        checks::wrongAnswers(embree, reference, checks::raysFromOnePoint(s, random, 40 + 7 * i)),
        0);
      EXPECT_EQ(
        checks::wrongAnswers(embree, reference, checks::randomRays(s, random, 40 + 7 * i)), 0);
    }
  }
}

TEST_P(BvhPacket, UnusableRaysSpoilNoOther)
{
  BvhStructure embree(GetParam());
  const Snapshot s = scene(embree, true);
  scenes::BruteForce reference;
  reference.update(s);
  Random random(42);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 20; ++i)
  {
    std::vector<Ray> rays = checks::raysFromOnePoint(s, random, 16);
    rays[random.below(16)].direction.x = nan;
    rays[random.below(16)].origin.y = infinity;
    rays[random.below(16)].direction = glm::dvec3(0.0);
    rays[random.below(16)].tMaximum = nan;
    rays[random.below(16)].tMaximum = 0.0;
    rays[random.below(16)].origin = { 1e12, 1e12, 1e12 };
    EXPECT_EQ(checks::wrongAnswers(embree, reference, rays), 0);
  }
}

// Triangles of all sizes, at random, or such that much falls together: on a grid, in a plane, nearly so.
Snapshot soup(Random& random, int shape)
{
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 40; ++i)
  {
    const glm::dvec3 at = random.inBox(0.5);
    const double size = random.below(3) ? std::pow(10.0, random(-3.0, -0.3)) : 0.5;
    for (int corner = 0; corner < 3; ++corner)
    {
      glm::dvec3 point = at + random.inBox(size);
      switch (shape)
      {
        case 1:
          point = glm::floor(point * 4.0) / 4.0;
          break;
        case 2:
          point.z = 0.25;
          break;
        case 3:
          point.x = 0.0;
          break;
        case 4:
          point.y = point.x * 1e-7;
          break;
        default:
          break;
      }
      corners.emplace_back(point);
    }
  }
  Snapshot s;
  scenes::addPart(s, scenes::makeGeometry(corners));
  return s;
}

int wrongTogether(
  const BvhStructure& embree, const Snapshot& s, Random& random, checks::Together kind, int packets)
{
  scenes::BruteForce reference;
  reference.update(s);
  int wrong = 0;
  for (int i = 0; i < packets; ++i)
  {
    const int count = random.below(3) ? 16 : 1 + static_cast<int>(random.below(16));
    const double width = std::pow(10.0, random(-7.0, -1.0));
    wrong += checks::wrongAnswers(
      embree, reference, checks::raysTogether(s, random, kind, count, width));
  }
  return wrong;
}

// Rays that are not divided: their hull decides for all of them.
TEST_P(BvhPacket, OfRaysThatLieTogetherEqualsBruteForce)
{
  Random random(44);
  BvhStructure embree(GetParam());
  for (int kind = 0; kind < static_cast<int>(checks::Together::Count); ++kind)
  {
    for (bool twoLevels : { false, true })
    {
      const Snapshot s = scene(embree, twoLevels);
      EXPECT_EQ(wrongTogether(embree, s, random, checks::Together(kind), 20), 0) << "kind " << kind;
    }
    for (int shape = 0; shape < 5; ++shape)
    {
      const Snapshot s = soup(random, shape);
      embree.update(s);
      EXPECT_EQ(wrongTogether(embree, s, random, checks::Together(kind), 200), 0)
        << "kind " << kind << ", shape " << shape;
    }
  }
}

// A ray that begins far off, or is of no ordinary length, spoils no other of its packet.
TEST_P(BvhPacket, FarRaysSpoilNoOther)
{
  for (bool twoLevels : { false, true })
  {
    BvhStructure embree(GetParam());
    const Snapshot s = scene(embree, twoLevels);
    scenes::BruteForce reference;
    reference.update(s);
    Random random(45);
    for (double away : { 1e6, 1e9, 1e12, 1e15, 1e20, 1e30, 1e60, 1e300 })
    {
      for (int i = 0; i < 8; ++i)
      {
        std::vector<Ray> rays =
          checks::raysTogether(s, random, checks::Together::FromOnePoint, 16, 0.02);
        Ray& far = rays[random.below(16)];
        far.origin -= away * glm::normalize(far.direction);
        far.tMaximum = std::numeric_limits<double>::infinity();
        rays[random.below(16)].direction *= i % 2 ? 1e-290 : 1e290;
        EXPECT_EQ(checks::wrongAnswers(embree, reference, rays), 0) << away;
      }
    }
  }
}

// What decides for a packet by its hull must hold for large triangles as well, which lie around where the
// rays begin, and at their edges, where a bound too small would show.
TEST_P(BvhPacket, AmongLargeTrianglesAlongTheirEdges)
{
  Random random(43);
  Snapshot s;
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 3 * 60; ++i)
  {
    corners.emplace_back(random.inBox(3.0));
  }
  scenes::addPart(s, scenes::makeGeometry(corners));
  BvhStructure embree(GetParam());
  embree.update(s);
  scenes::BruteForce reference;
  reference.update(s);
  for (int i = 0; i < 500; ++i)
  {
    const Corners c = checks::cornersOf(s, static_cast<TriangleId>(random.below(s.triangleCount)));
    const glm::dvec3 eye = random.inBox(2.0);
    const double from = random(0.0, 1.0);
    std::vector<Ray> rays(16);
    for (Ray& ray : rays)
    {
      ray.origin = eye + random.inBox(1e-3);
      ray.direction = glm::mix(c.a, c.b, from + random(0.0, 0.02)) - ray.origin;
    }
    EXPECT_EQ(checks::wrongAnswers(embree, reference, rays), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, BvhPacket,
  ::testing::Values("", "isa=sse2", "isa=sse4.2", "isa=avx", "isa=avx2", "isa=avx512"));

TEST(BvhPacket, EmptyStreamsAndScenes)
{
  BvhStructure embree;
  embree.intersect(nullptr, nullptr, 0, RayOrder::Coherent);
  Ray rays[3];
  Hit hits[3];
  std::uint8_t occluded[3] = { 9, 9, 9 };
  hits[1].triangle = 5;
  embree.intersect(rays, hits, 3, RayOrder::Coherent);
  embree.occluded(rays, occluded, 3, RayOrder::Coherent);
  EXPECT_FALSE(hits[1].valid());
  EXPECT_EQ(occluded[2], 0);
}

} // namespace
