// What floating point makes hard for a ray structure: closed meshes aimed at their edges and
// vertices, near the origin and far from it, and slivers seen at grazing angles. The counts here
// are for every run of the tests; HRT_TEST_INTENSITY multiplies them.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "StructureChecks.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace
{

using namespace hrt;
using scenes::Random;

int intensity()
{
  const char* const value = std::getenv("HRT_TEST_INTENSITY");
  return value ? std::max(1, std::atoi(value)) : 1;
}

// Rays from inside the sphere, 16 neighbours at a time.
int leaksOf(const Snapshot& s, const BvhStructure& embree, Random& random, int aim, int packets)
{
  int leaks = 0;
  for (int packet = 0; packet < packets; ++packet)
  {
    Ray rays[16];
    Hit hits[16];
    const glm::dvec3 eye = random.inBox(0.5);
    for (Ray& ray : rays)
    {
      const Corners c =
        checks::cornersOf(s, static_cast<TriangleId>(random.below(s.triangleCount)));
      const double share = random(0, 1);
      ray.origin = eye;
      ray.direction = aim == 0 ? random.direction()
        : aim == 1             ? c.a + share * (c.b - c.a) - eye
                               : c.a - eye;
      leaks += !embree.intersect(ray).valid() + !embree.occluded(ray);
    }
    embree.intersect(rays, hits, 16, RayOrder::Coherent);
    leaks +=
      static_cast<int>(std::count_if(hits, hits + 16, [](const Hit& hit) { return !hit.valid(); }));
  }
  return leaks;
}

TEST(BvhStress, NothingLeaksOutOfASphere)
{
  for (const glm::dvec3& centre : { glm::dvec3(0.0), glm::dvec3(148376, 1234, -223423) })
  {
    for (bool merged : { false, true })
    {
      Snapshot s;
      scenes::addPart(s, scenes::sphere(400, 200),
        glm::scale(glm::translate(glm::dmat4(1.0), centre), glm::dvec3(2.0)));
      if (merged)
      {
        scenes::addPart(s, scenes::sphere(16, 8),
          glm::scale(glm::translate(glm::dmat4(1.0), centre), glm::dvec3(3.0)));
      }
      s.origin = centre;
      BvhStructure embree;
      embree.update(s);
      Random random(51);
      for (int aim = 0; aim < 3; ++aim)
      {
        EXPECT_EQ(leaksOf(s, embree, random, aim, 2000 * intensity()), 0) << aim;
      }
    }
  }
}

// The same for rays that lie together: sixteen neighbouring corners, and points on the edges between
// them, from one point and from sixteen that lie as close. Every one must hit, and what single rays do.
TEST(BvhStress, NoPacketLeaksOutOfASphere)
{
  for (const glm::dvec3& centre : { glm::dvec3(0.0), glm::dvec3(148376, 1234, -223423) })
  {
    Snapshot s;
    scenes::addPart(s, scenes::sphere(400, 200),
      glm::scale(glm::translate(glm::dmat4(1.0), centre), glm::dvec3(2.0)));
    s.origin = centre;
    BvhStructure embree;
    embree.update(s);
    Random random(54);
    int leaks = 0, different = 0;
    for (int packet = 0; packet < 4000 * intensity(); ++packet)
    {
      Ray rays[16];
      Hit hits[16];
      std::uint8_t occluded[16];
      const glm::dvec3 eye = random.inBox(0.5);
      const double apart = packet % 2 == 0 ? 0.0 : 0.01;
      const std::size_t first = random.below(s.triangleCount - 16);
      for (std::size_t i = 0; i < 16; ++i)
      {
        const Corners c = checks::cornersOf(s, static_cast<TriangleId>(first + i));
        const double share = packet % 3 == 0 ? 0.0 : random(0, 1);
        rays[i].origin = eye + random.inBox(apart);
        rays[i].direction = c.a + share * (c.b - c.a) - rays[i].origin;
      }
      embree.intersect(rays, hits, 16, RayOrder::Coherent);
      embree.occluded(rays, occluded, 16, RayOrder::Coherent);
      for (std::size_t i = 0; i < 16; ++i)
      {
        leaks += !hits[i].valid() + (occluded[i] == 0);
        different += !checks::same(hits[i], embree.intersect(rays[i]));
      }
    }
    EXPECT_EQ(leaks, 0);
    EXPECT_EQ(different, 0);
  }
}

// Triangles of 11 x 10 x 0.7 seen from up to 600 at 0.02 to 2 degrees. A ray is aimed at a known
// point of the plane; whether it meets the triangle is known when that point's weights keep away
// from zero by more than the aim's own rounding.
TEST(BvhStress, SliversAreHitAndMissedRightly)
{
  Random random(52);
  int falseHits = 0, misses = 0, hits = 0;
  for (int sliver = 0; sliver < 300 * intensity(); ++sliver)
  {
    const glm::dvec3 along = random.direction();
    const glm::dvec3 across = glm::normalize(glm::cross(along, random.direction()));
    const glm::dvec3 a = random.inBox(20), b = a + 11.0 * along,
                     c = a + 10.3 * along + 0.7 * across;
    Snapshot s;
    scenes::addPart(s, scenes::makeGeometry({ glm::vec3(a), glm::vec3(b), glm::vec3(c) }));
    BvhStructure embree;
    embree.update(s);
    const Corners exact = checks::cornersOf(s, 0);
    const glm::dvec3 e1 = exact.b - exact.a, e2 = exact.c - exact.a;
    const glm::dvec3 normal = glm::normalize(glm::cross(e1, e2));
    for (int i = 0; i < 300; ++i)
    {
      const double u = random(-0.5, 1.5), v = random(-0.5, 1.5), w = 1 - u - v;
      const glm::dvec3 target = exact.a + u * e1 + v * e2;
      const double turn = random(0, 2 * scenes::kPi), angle = glm::radians(random(0.02, 2.0));
      const glm::dvec3 x = glm::normalize(e1), y = glm::cross(normal, x);
      const glm::dvec3 away =
        std::cos(angle) * (std::cos(turn) * x + std::sin(turn) * y) + std::sin(angle) * normal;
      Ray ray;
      ray.origin = target + random(20, 600) * away;
      ray.direction = target - ray.origin;
      const double margin = std::min({ u, v, w });
      const Hit hit = embree.intersect(ray);
      hits += hit.valid();
      falseHits += hit.valid() && margin < -1e-9;
      misses += !hit.valid() && margin > 1e-9;
    }
  }
  EXPECT_EQ(falseHits, 0);
  EXPECT_EQ(misses, 0);
  EXPECT_GT(hits, 1000);
}

// Slivers, needles and specks of any size together, against brute force.
TEST(BvhStress, TrianglesOfAllSizesEqualBruteForce)
{
  Random random(53);
  for (double scale : { 1e-25, 1e-12, 1.0, 1e12 })
  {
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 600; ++i)
    {
      const glm::dvec3 a = scale * random.inBox(1.0);
      const glm::dvec3 d = scale * std::pow(10.0, random(-6, 0)) * random.direction();
      const glm::dvec3 e = scale * std::pow(10.0, random(-6, 0)) * random.direction();
      for (const glm::dvec3& p : { a, a + d, a + e })
      {
        positions.push_back(glm::vec3(p));
      }
    }
    Snapshot s;
    scenes::addPart(s, scenes::makeGeometry(positions));
    scenes::addPart(
      s, scenes::makeGeometry(positions), glm::rotate(glm::dmat4(1.0), 1.0, { 1, 2, 3 }));
    BvhStructure embree;
    scenes::BruteForce reference;
    embree.update(s);
    reference.update(s);
    std::vector<Ray> rays = checks::randomRays(s, random, 1500, 2.0 * scale);
    EXPECT_EQ(checks::wrongAnswers(embree, reference, rays), 0) << scale;
    for (Ray& ray : rays)
    {
      ray.direction *= scale; // its length is no matter
    }
    EXPECT_EQ(checks::wrongAnswers(embree, reference, rays), 0) << scale;
  }
}

TEST(BvhStress, IdenticalTrianglesGiveTheLargestNumber)
{
  std::vector<glm::vec3> positions;
  for (int i = 0; i < 20000; ++i)
  {
    positions.insert(positions.end(), { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  }
  Snapshot s;
  scenes::addPart(s, scenes::makeGeometry(positions));
  BvhStructure embree;
  embree.update(s);
  Ray ray;
  ray.origin = { 0.25, 0.25, 1 };
  EXPECT_EQ(embree.intersect(ray).triangle, 19999u);
  ray.originTriangle = 19999;
  EXPECT_EQ(embree.intersect(ray).triangle, 19998u);
}

} // namespace
