// What every ray structure promises (Structure.h), tried on each of them: ties, who takes part, and what
// is a miss.
#include "Rendering/Core/Structures/EmbreeStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "Scenes.h"

#include <gtest/gtest.h>

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
using Structures = testing::Types<EmbreeStructure, KdTreeStructure>;
TYPED_TEST_SUITE(StructureRules, Structures);

TYPED_TEST(StructureRules, EqualHitsGiveTheSmallestNumber)
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
  EXPECT_EQ(structure.intersect(ray).triangle, 0u);
  EXPECT_EQ(structure.intersect(ray).t, 3.0);
  ray.originTriangle = 0; // the next copy is as near
  EXPECT_EQ(structure.intersect(ray).triangle, 2u);
  ray.origin = { 0.5, 0.5, 3 }; // on the diagonal, which both triangles of each copy share
  ray.originTriangle = kNoTriangle;
  EXPECT_EQ(structure.intersect(ray).triangle, 0u);
  ray.tMaximum = 3.0; // exclusive
  EXPECT_FALSE(structure.intersect(ray).valid());
  EXPECT_FALSE(structure.occluded(ray));
  ray.tMaximum = std::nextafter(3.0, 4.0);
  EXPECT_EQ(structure.intersect(ray).triangle, 0u);
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

} // namespace
