// The Embree structure over many updates: whatever has moved, deformed, come, gone or come to rest,
// every snapshot's answers are those of a structure that sees it for the first time, bit by bit.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/Grouping.h"
#include "StructureChecks.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

namespace
{

using namespace hrt;
using scenes::Random;

void renumber(Snapshot& s)
{
  s.triangleCount = 0;
  for (Part& part : s.parts)
  {
    part.firstTriangle = s.triangleCount;
    s.triangleCount += static_cast<TriangleId>(part.geometry->triangleCount());
  }
}

glm::dmat4 at(const glm::dvec3& p)
{
  return glm::translate(glm::dmat4(1.0), p);
}

int wrongAgainstBruteForce(const BvhStructure& embree, const Snapshot& s, Random& random,
  int rays = 100, double half = 3.0)
{
  scenes::BruteForce reference;
  reference.update(s);
  return checks::wrongAnswers(embree, reference, checks::randomRays(s, random, rays, half));
}

std::shared_ptr<const Geometry> wave(double phase, double height = 0.3)
{
  std::vector<glm::vec3> positions;
  const auto point = [&](int i, int j)
  {
    const double x = i / 10.0 - 1.0, y = j / 10.0 - 1.0;
    return glm::vec3(x, y, height * std::sin(3 * x + phase) * std::cos(2 * y - phase));
  };
  for (int j = 0; j < 20; ++j)
  {
    for (int i = 0; i < 20; ++i)
    {
      for (const auto& k : { point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j),
             point(i + 1, j + 1), point(i, j + 1) })
      {
        positions.push_back(k);
      }
    }
  }
  return scenes::makeGeometry(positions);
}

// Sixteen patterns over four parts, as Embree's own update test: bit i of the pattern, part i
// moves. A part moves rigidly when even, deforms when odd; 1 to 99 rays a step.
TEST(BvhUpdate, EveryPatternOfMovesEqualsBruteForce)
{
  Random random(31);
  for (unsigned int pattern = 0; pattern < 16; ++pattern)
  {
    Snapshot s;
    for (int i = 0; i < 4; ++i)
    {
      scenes::addPart(s, wave(i), at({ 0, 0, 0.5 * i }));
    }
    BvhStructure embree;
    for (int step = 0; step < 12; ++step)
    {
      for (unsigned int i = 0; i < 4; ++i)
      {
        if ((pattern >> i & 1u) != 0 && step > 0)
        {
          s.parts[i].localToWorld =
            glm::rotate(s.parts[i].localToWorld, i % 2 ? 0.0 : 0.3, { 1, 2, 3 });
          s.parts[i].geometry = i % 2 ? wave(i + 0.2 * step) : s.parts[i].geometry;
        }
      }
      embree.update(s);
      const int rays = 1 + static_cast<int>(random.below(99));
      EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, rays), 0) << pattern << " " << step;
    }
  }
}

// 190 moving parts over a still floor; origin and numbers change as they do in an animation.
TEST(BvhUpdate, EveryFrameOfAnAnimationEqualsAFreshStructure)
{
  Random random(32);
  const auto ball = scenes::sphere(12, 6), ring = scenes::torus(12, 6, 1.0, 0.3);
  Snapshot s;
  scenes::addPart(s, scenes::torus(60, 30, 6.0, 1.0));
  for (int i = 0; i < 190; ++i)
  {
    scenes::addPart(s, i % 2 ? ball : ring);
  }
  BvhStructure embree;
  StructureReport report;
  for (int frame = 0; frame < 20; ++frame)
  {
    for (std::size_t i = 1; i < s.parts.size(); ++i)
    {
      const double a = 0.7 * i + 0.05 * frame * (1 + i % 3);
      s.parts[i].localToWorld = glm::scale(
        glm::rotate(at({ 5 * std::cos(a), 5 * std::sin(a), 0.02 * i - 2 }), a, { 1, 2, 3 }),
        glm::dvec3(0.3));
    }
    s.origin = { 0.1 * frame, 0, -0.05 * frame };
    report = embree.update(s);
    BvhStructure fresh;
    fresh.update(s);
    EXPECT_EQ(checks::wrongAnswers(embree, fresh, checks::randomRays(s, random, 400, 8.0)), 0);
    EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, 20, 8.0), 0) << frame;
  }
  EXPECT_EQ(report.built, 0u); // two geometries and the floor, all there since the second frame
  EXPECT_EQ(report.reused, 3u);
  EXPECT_TRUE(report.partsRebuilt);
}

TEST(BvhUpdate, PartsThatComeGoRestAndHideEqualBruteForce)
{
  Random random(33);
  const std::shared_ptr<const Geometry> meshes[] = { scenes::sphere(10, 5), wave(0), wave(1),
    scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 }), scenes::makeGeometry({}),
    scenes::torus(12, 6, 1, 0.4) };
  Snapshot s;
  std::uint64_t key = 1000;
  BvhStructure embree;
  for (int step = 0; step < 150; ++step)
  {
    if (step % 50 < 20) // then a rest in which all join again
    {
      const std::size_t dice = random.below(4);
      if (dice == 0 || s.parts.size() < 4)
      {
        scenes::addPart(s, meshes[random.below(6)], at(random.inBox(1.5))).key = ++key;
        std::rotate(
          s.parts.begin() + random.below(s.parts.size()), s.parts.end() - 1, s.parts.end());
      }
      Part& part = s.parts[random.below(s.parts.size())];
      part.localToWorld[3] += glm::dvec4(random.inBox(dice == 1 ? 0.3 : 0.0), 0);
      part.geometry = dice == 2 ? meshes[random.below(6)] : part.geometry;
      part.castsShadow = random.below(5) != 0;
      part.visibleToRays = random.below(5) != 0;
      if (dice == 3 && s.parts.size() > 4)
      {
        s.parts.erase(s.parts.begin() + random.below(s.parts.size()));
      }
      s.origin = random.inBox(2.0);
      renumber(s);
    }
    embree.update(s);
    ASSERT_EQ(wrongAgainstBruteForce(embree, s, random, 60), 0) << step;
  }
  s.parts.clear();
  renumber(s);
  embree.update(s);
  EXPECT_FALSE(embree.intersect(Ray()).valid());
}

TEST(BvhUpdate, DeformingMeshesAreRefittedUntilTheyDecay)
{
  Random random(34);
  Snapshot s;
  scenes::addPart(s, wave(0));
  scenes::addPart(s, scenes::sphere(32, 16), at({ 0, 0, 3 }));
  BvhStructure embree;
  embree.update(s);
  std::uint64_t built = 0, refitted = 0;
  for (int step = 1; step <= 20; ++step)
  {
    s.parts[0].geometry = wave(0.05 * step);
    const StructureReport report = embree.update(s);
    built += report.built;
    refitted += report.refitted;
    EXPECT_EQ(wrongAgainstBruteForce(embree, s, random), 0) << step;
  }
  EXPECT_LE(built, 3u); // leaves the others, which are one then
  EXPECT_GE(refitted, 18u);

  // The triangles in another order: every block now spans the mesh.
  auto shuffled = std::make_shared<Geometry>(*wave(1.0));
  shuffled->version = scenes::makeGeometry({})->version;
  const std::size_t n = shuffled->triangleCount();
  for (std::size_t i = 0; i < n; ++i)
  {
    shuffled->triangles[i] = s.parts[0].geometry->triangles[i * 37 % n];
  }
  s.parts[0].geometry = shuffled;
  const StructureReport report = embree.update(s);
  EXPECT_EQ(report.refitted, 0u);
  EXPECT_EQ(report.built, 1u);
  EXPECT_EQ(wrongAgainstBruteForce(embree, s, random), 0);
}

TEST(BvhUpdate, BuildsOnlyWhatIsNew)
{
  const auto ball = scenes::sphere(16, 8), ring = scenes::torus(16, 8, 1, 0.3);
  Snapshot s;
  scenes::addPart(s, scenes::sphere(64, 32), at({ -9, 0, 0 }));
  scenes::addPart(s, ball);
  scenes::addPart(s, ball, at({ 5, 0, 0 }));
  scenes::addPart(s, ring, at({ 0, 9, 0 }));
  BvhStructure embree;
  const auto expectReport = [&](std::uint64_t built, std::uint64_t reused, bool parts)
  {
    const StructureReport report = embree.update(s);
    EXPECT_EQ(report.built, built);
    EXPECT_EQ(report.reused, reused);
    EXPECT_EQ(report.refitted, 0u);
    EXPECT_EQ(report.partsRebuilt, parts);
  };
  expectReport(1, 0, true);  // all in one
  expectReport(0, 1, false); // nothing new
  s.parts[2].castsShadow = false;
  expectReport(0, 1, false); // still nothing to build
  s.parts[2].localToWorld[3][0] = 6;
  expectReport(1, 1, true); // a part leaves the others ...
  s.parts[2].localToWorld[3][0] = 7;
  expectReport(0, 2, true); // ... and moves on for nothing
  s.parts[1].localToWorld[3][2] = 1;
  expectReport(0, 2, true); // its copy shares what was built
  s.origin.x = 1;
  expectReport(0, 2, true);
  s.parts[3].geometry = scenes::torus(18, 8, 1, 0.2);
  renumber(s);
  expectReport(1, 2, true); // a mesh changed
  s.parts.resize(3);
  renumber(s);
  expectReport(0, 2, true); // a part left
  Ray ray;
  ray.origin = { 6.1, 0.1, 3 };
  EXPECT_TRUE(embree.intersect(ray).valid()); // where the moved part is now
  EXPECT_FALSE(embree.occluded(ray));
}

// Matrices that invert badly, beside parts that move: those must not lose hits either.
// Parts too small for a hierarchy each share a flat one. While they move on it is refitted, and the
// upper level with it; thrown together it is built anew, as when one of them goes.
TEST(BvhUpdate, TinyMovingPartsAreRefittedUntilTheyDecay)
{
  Random random(77);
  Snapshot s;
  scenes::addPart(s, wave(0.0), at({ 0, 0, -1 }));
  for (int i = 0; i < 60; ++i)
  {
    const glm::vec3 a(random(0, 0.4), 0, 0), b(0, random(0.1, 0.4), 0.1f);
    scenes::addPart(s, scenes::makeGeometry({ glm::vec3(0.0f), a + b, b }),
      at({ (i % 8) * 0.5 - 2, (i / 8) * 0.5 - 2, 0 }));
  }
  BvhStructure embree;
  embree.update(s);
  int refitted = 0, built = 0;
  for (int step = 0; step < 12; ++step)
  {
    for (std::size_t i = 1; i < s.parts.size(); ++i)
    {
      s.parts[i].localToWorld = glm::rotate(s.parts[i].localToWorld, 0.1, { 1, double(i % 3), 3 });
      if (step == 8)
      {
        s.parts[i].localToWorld[3] = glm::dvec4(random(-2, 2), random(-2, 2),
          random(-2, 2), 1.0);
      }
    }
    if (step == 10)
    {
      s.parts.pop_back();
      renumber(s);
    }
    const StructureReport report = embree.update(s);
    EXPECT_TRUE(report.partsRebuilt) << step;
    refitted += static_cast<int>(report.refitted);
    built += static_cast<int>(report.built);
    EXPECT_EQ(report.built + report.refitted, 1u) << step;
    EXPECT_TRUE(report.built == 1 || (step != 0 && step != 8 && step != 10)) << step;
    EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, 500), 0) << step;
  }
  EXPECT_EQ(refitted, 9);
  EXPECT_EQ(built, 3);
}

TEST(BvhUpdate, SkewedPartsEqualBruteForce)
{
  Random random(35);
  Snapshot s;
  for (double thin : { 1.0, 1e-3, 1e-6, 1e-9, 1e-12 })
  {
    scenes::addPart(s, scenes::torus(20, 10, 1.0, 0.4),
      glm::scale(glm::rotate(glm::dmat4(1.0), thin, { 1, 2, 3 }), { 1.0, thin, 1.0 }));
  }
  BvhStructure embree;
  for (int step = 0; step < 6; ++step)
  {
    for (Part& part : s.parts)
    {
      part.localToWorld = glm::rotate(glm::dmat4(1.0), 0.1, { 3, 1, 1 }) * part.localToWorld;
    }
    embree.update(s);
    EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, 400), 0) << step;
  }
}

TEST(BvhUpdate, AHundredThousandParts)
{
  Random random(36);
  Snapshot s;
  const auto triangle = scenes::makeGeometry({ { 0, 0, 0 }, { 0.1, 0, 0 }, { 0, 0.1, 0 } });
  for (int i = 0; i < 100000; ++i)
  {
    scenes::addPart(
      s, triangle, glm::rotate(at(random.inBox(2.0)), random(0, 6), random.direction()));
  }
  BvhStructure embree;
  EXPECT_EQ(embree.update(s).built, 1u);
  EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, 12), 0);
  for (int i = 0; i < 100000; i += 10)
  {
    s.parts[i].localToWorld[3] += glm::dvec4(random.inBox(0.1), 0);
  }
  EXPECT_EQ(embree.update(s).built, 1u); // the tenth that moves is one flat structure
  EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, 12), 0);
}

TEST(BvhUpdate, TheNumberOfThreadsDoesNotShow)
{
  for (std::size_t threads : { 1, 2, 5 })
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Random random(37);
    Snapshot s;
    scenes::addPart(s, scenes::torus(60, 30, 1.0, 0.4));
    scenes::addPart(s, wave(0));
    BvhStructure embree("threads=" + std::to_string(threads));
    embree.update(s);
    s.parts[1].localToWorld[3][0] += 0.1;
    embree.update(s);
    EXPECT_EQ(wrongAgainstBruteForce(embree, s, random, 200), 0);
  }
}

} // namespace
