// What every ray structure promises (Structure.h), tried on each of them: ties, who takes part, and what
// is a miss.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "StructureChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>

namespace
{

using namespace hrt;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Structure>
class StructureRules : public testing::Test
{
};
using Structures = testing::Types<BvhStructure, KdTreeStructure>;
TYPED_TEST_SUITE(StructureRules, Structures);

TYPED_TEST(StructureRules, EqualHitsGiveTheLargestNumber)
{
  const auto quad = scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 });
  Snapshot s;
  for (int copy = 0; copy < 9; ++copy)
  {
    scenes::addPart(s, quad);
  }
  TypeParam structure;
  structure.update(s);
  Ray ray;
  ray.origin = { 0.5, -0.5, 3 };
  EXPECT_EQ(structure.intersect(ray).triangle, 16u);
  EXPECT_EQ(structure.intersect(ray).t, 3.0);
  ray.originTriangle = 16; // the copy before is as near
  EXPECT_EQ(structure.intersect(ray).triangle, 14u);
  ray.origin = { 0.5, 0.5, 3 }; // on the diagonal, which both triangles of each copy share
  ray.originTriangle = kNoTriangle;
  EXPECT_EQ(structure.intersect(ray).triangle, 17u);
  ray.tMaximum = 3.0; // exclusive
  EXPECT_FALSE(structure.intersect(ray).valid());
  EXPECT_FALSE(structure.occluded(ray));
  ray.tMaximum = std::nextafter(3.0, 4.0);
  EXPECT_EQ(structure.intersect(ray).triangle, 17u);
  EXPECT_TRUE(structure.occluded(ray));
}

TYPED_TEST(StructureRules, PartsTakePartAsTheyAreMarked)
{
  const auto quad = scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 });
  Snapshot s;
  scenes::addPart(s, quad).visibleToRays = false;
  scenes::addPart(s, quad, glm::translate(glm::dmat4(1.0), { 0, 0, -1 })).castsShadow = false;
  TypeParam structure;
  structure.update(s);
  Ray ray;
  ray.origin = { 0.5, -0.5, 3 };
  EXPECT_EQ(structure.intersect(ray).triangle, 2u);
  EXPECT_TRUE(structure.occluded(ray));
  ray.originTriangle = 0; // without the caster nothing casts
  EXPECT_FALSE(structure.occluded(ray));
}

TYPED_TEST(StructureRules, EmptyScenesAndUnusableRaysAreMisses)
{
  TypeParam structure;
  Ray ray;
  EXPECT_FALSE(structure.intersect(ray).valid()); // before the first update
  Snapshot s;
  EXPECT_FALSE(structure.update(s).partsRebuilt);
  EXPECT_FALSE(structure.intersect(ray).valid());
  scenes::addPart(s, scenes::makeGeometry({}));
  EXPECT_EQ(structure.update(s).built, 0u);
  EXPECT_FALSE(structure.occluded(ray));

  scenes::addPart(s, scenes::sphere(16, 8));
  for (int parts = 1; parts <= 2; ++parts) // with the upper level, and without
  {
    structure.update(s);
    ASSERT_TRUE(structure.intersect(ray).valid());
    for (int axis = 0; axis < 3; ++axis)
    {
      for (double bad : { std::nan(""), kInfinity, -kInfinity })
      {
        Ray broken = ray;
        broken.origin[axis] = bad;
        EXPECT_FALSE(structure.intersect(broken).valid());
        EXPECT_FALSE(structure.occluded(broken));
        broken = ray;
        broken.direction[axis] = bad;
        EXPECT_FALSE(structure.intersect(broken).valid());
        EXPECT_FALSE(structure.occluded(broken));
      }
    }
    Ray still = ray;
    still.direction = glm::dvec3(0.0);
    EXPECT_FALSE(structure.intersect(still).valid());
    scenes::addPart(s, scenes::sphere(16, 8), glm::translate(glm::dmat4(1.0), { 5, 0, 0 }));
  }
}

// A torus in the middle, a ball merged with it, and a part that stands alone since it has moved.
Snapshot movedScene(Structure& structure, double scale = 1.0)
{
  const glm::dmat4 scaled = glm::scale(glm::dmat4(1.0), glm::dvec3(scale));
  Snapshot s;
  scenes::addPart(s, scenes::torus(24, 12, 1.5, 0.5), scaled);
  scenes::addPart(s, scenes::sphere(16, 8), scaled);
  scenes::addPart(s, scenes::sphere(24, 16), scaled);
  structure.update(s);
  s.parts[2].localToWorld[3] = glm::dvec4(scale * glm::dvec3(2, 0.3, 0.1), 1.0);
  structure.update(s);
  return s;
}

// However far away a ray begins, it meets what the exact kernel says: up to about a thousand million
// times the scene's size that is what is there, and beyond it what rounding makes of it.
TYPED_TEST(StructureRules, RaysFromFarAwayHitWhatTheKernelHits)
{
  TypeParam structure;
  const Snapshot s = movedScene(structure);
  scenes::BruteForce reference;
  reference.update(s);
  scenes::Random random(51);
  int hits = 0;
  for (int exponent = 3; exponent <= 300; exponent += exponent < 24 ? 1 : 23)
  {
    const double away = std::pow(10.0, exponent);
    std::vector<Ray> rays(160);
    for (Ray& ray : rays)
    {
      // At corners, as near as the kernel can tell from there. Along an axis two coordinates stay exact.
      const glm::dvec3 toward =
        checks::randomCorner(s, random) + random.inBox(std::min(1e-3, 1e-15 * away));
      ray.direction = random.direction();
      if (random.below(2))
      {
        ray.direction = glm::dvec3(0.0);
        ray.direction[random.below(3)] = random.below(2) ? 1.0 : -1.0;
      }
      ray.origin = toward - away * ray.direction;
      const double length = random(0.5, 50.0); // of which no quotient is exact
      ray.direction *= length;
      ray.tMaximum = random.below(3) ? kInfinity : away / length;
      hits += reference.intersect(ray).valid();
    }
    EXPECT_EQ(checks::wrongAnswers(structure, reference, rays), 0) << "1e" << exponent;
  }
  EXPECT_GT(hits, 1000);
}

// t counts in the direction's length: at the ends of the numbers the kernel refuses a t that is not
// finite, or zero, and then what lies behind must still be found.
TYPED_TEST(StructureRules, DirectionsOfAnyLength)
{
  for (double size : { 1e-8, 1.0, 100.0, 1e15 })
  {
    TypeParam structure;
    const Snapshot s = movedScene(structure, size);
    scenes::BruteForce reference;
    reference.update(s);
    scenes::Random random(52);
    for (double length :
      { 1e-307, 1e-303, 1e-290, 1e-250, 1e-205, 1e-195, 1e-100, 1e100, 1e195, 1e205, 1e290, 1.7e308 })
    {
      const glm::dvec3 eye = size * glm::dvec3(0.1, 0.2, 4.0);
      std::vector<Ray> rays(16);
      for (Ray& ray : rays)
      {
        ray.origin = eye + size * random.inBox(0.01);
        ray.direction = length * glm::normalize(size * random.inBox(0.01) - eye);
      }
      EXPECT_EQ(checks::wrongAnswers(structure, reference, rays), 0) << size << ", " << length;
    }
  }
}

// VTK and its hosts can trap these two (vtkFloatingPointExceptions); no good ray may raise them.
TYPED_TEST(StructureRules, GoodRaysRaiseNoFloatingPointException)
{
  TypeParam structure;
  const Snapshot s = movedScene(structure);
  scenes::Random random(53);
  std::vector<Ray> rays = checks::randomRays(s, random, 400);
  for (int kind = 0; kind < static_cast<int>(checks::Together::Count); ++kind)
  {
    for (int i = 0; i < 20; ++i)
    {
      const std::vector<Ray> more =
        checks::raysTogether(s, random, checks::Together(kind), 16, 0.01);
      rays.insert(rays.end(), more.begin(), more.end());
    }
  }
  for (std::size_t i = 0; i < rays.size(); i += 3)
  {
    rays[i].direction[i % 2] = 0.0; // parallel to an axis' planes
    rays[i].direction[2] += rays[i].direction[2] == 0.0 ? 1.0 : 0.0;
  }
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  for (const RayOrder order : { RayOrder::Coherent, RayOrder::Incoherent })
  {
    std::feclearexcept(FE_ALL_EXCEPT);
    structure.intersect(rays.data(), hits.data(), rays.size(), order);
    structure.occluded(rays.data(), occluded.data(), rays.size(), order);
    EXPECT_EQ(std::fetestexcept(FE_INVALID), 0) << int(order);
    EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO), 0) << int(order);
  }
  std::feclearexcept(FE_ALL_EXCEPT);
}

} // namespace
