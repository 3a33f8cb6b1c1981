// The rule for surfaces in one place: what rounding alone can have parted, and nothing that it cannot.
#include "Rendering/Core/Geometry/Coincidence.h"
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "Rendering/Core/Tracing/Meeting.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace
{

using namespace hrt;

// A square in the plane z = `height`, `size` to each side of the z axis; two triangles, outside up.
std::shared_ptr<Geometry> square(float height, float size = 1.0f)
{
  return scenes::quad({ -size, -size, height }, { size, -size, height }, { size, size, height },
    { -size, size, height });
}

// Two squares, each a part: triangles 0 and 1, and 2 and 3.
Snapshot twoSquares(double height, double apart)
{
  Snapshot s;
  scenes::addPart(s, square(static_cast<float>(height)));
  // By a matrix, so that heights between two floats are possible.
  scenes::addPart(s, square(static_cast<float>(height)),
    glm::translate(glm::dmat4(1.0), { 0.0, 0.0, apart }));
  return s;
}

// The bound of twoSquares: both squares' roundings, by hand. The matrix adds nothing: its translation
// is double.
double boundAt(double height)
{
  return 2.0 * (kCoordinateRounding * height + kComputedRounding * std::max(height, 1.0));
}

TEST(Coincidence, TwinsAreInOnePlaceUpToBothRoundings)
{
  for (const double height : { 1.0, 1000.0, 1e6 })
  {
    SCOPED_TRACE(height);
    const double bound = boundAt(height);
    const glm::dvec3 point(0.2, 0.3, height);
    for (const double sign : { 1.0, -1.0 })
    {
      const Coincidence within(twoSquares(height, sign * 0.99 * bound));
      EXPECT_TRUE(within.inOnePlace(0, 2, point));
      EXPECT_TRUE(within.inOnePlace(0, 3, point)) << "whatever the triangles";
      const Coincidence beyond(twoSquares(height, sign * 1.01 * bound));
      EXPECT_FALSE(beyond.inOnePlace(0, 2, point));
      EXPECT_TRUE(beyond.inOnePlace(0, 2, point, kSetMargin));
    }
  }
}

// For a floor in a plane of coordinates only its height counts.
TEST(Coincidence, HowFarAPlaneStretchesDoesNotCount)
{
  Snapshot s;
  scenes::addPart(s, square(1.0f, 1e6f));
  scenes::addPart(s, square(1.0f, 1.0f), glm::translate(glm::dmat4(1.0), { 0.0, 0.0, 1e-3 }));
  EXPECT_FALSE(Coincidence(s).inOnePlace(0, 2, { 0.1, 0.2, 1.0 }));
}

TEST(Coincidence, WallsThatMeetAreNotInOnePlaceHoweverNearTheCorner)
{
  Snapshot s;
  scenes::addPart(s, square(0.0f));
  scenes::addPart(s, square(0.0f),
    glm::rotate(glm::dmat4(1.0), 0.5 * scenes::kPi, glm::dvec3(1, 0, 0)));
  scenes::addPart(s, square(0.0f), glm::rotate(glm::dmat4(1.0), 0.01, glm::dvec3(1, 0, 0)));
  const Coincidence surfaces(s);
  EXPECT_FALSE(surfaces.inOnePlace(0, 2, { 0.2, 0.0, 0.0 }));
  EXPECT_FALSE(surfaces.inOnePlace(0, 4, { 0.2, 0.0, 0.0 })) << "0.6 degrees";
}

// VTK's depth test keeps the two sides of a thin sheet apart.
TEST(Coincidence, OfOnePartTheCoordinatesAreTakenAsGiven)
{
  const float height = 1e5f, next = std::nextafter(height, 1e6f);
  std::vector<glm::vec3> corners = meshes::cornersOf(*square(height));
  const std::vector<glm::vec3> above = meshes::cornersOf(*square(next));
  corners.insert(corners.end(), above.begin(), above.end());
  const std::vector<glm::vec3> twin = meshes::cornersOf(*square(height, 2.0f));
  corners.insert(corners.end(), twin.begin(), twin.end());
  Snapshot s;
  scenes::addPart(s, scenes::makeGeometry(corners));
  const Coincidence surfaces(s);
  EXPECT_FALSE(surfaces.inOnePlace(0, 2, { 0.2, 0.3, height }));
  EXPECT_TRUE(surfaces.inOnePlace(0, 4, { 0.2, 0.3, height })) << "with the same height";
  // Two parts of the same mesh are two computations.
  Snapshot two;
  scenes::addPart(two, square(height));
  scenes::addPart(two, square(next));
  EXPECT_TRUE(Coincidence(two).inOnePlace(0, 2, { 0.2, 0.3, height }));
}

TEST(Coincidence, CopiesAreParts)
{
  Snapshot s;
  const float height = 1e5f;
  Part& part = scenes::addPart(s, square(0.0f));
  auto copies = std::make_shared<Copies>();
  for (const float z : { height, std::nextafter(height, 1e6f), 2.0f * height })
  {
    copies->rows.push_back({ glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, z) });
  }
  boundCopies(*part.geometry, *copies);
  part.copies = copies;
  s.triangleCount = 6;
  const Coincidence surfaces(s);
  EXPECT_TRUE(surfaces.inOnePlace(0, 2, { 0.2, 0.3, height }));
  EXPECT_FALSE(surfaces.inOnePlace(0, 4, { 0.2, 0.3, height }));
}

TEST(Coincidence, TrianglesWithoutAPlaneAreNowhere)
{
  Snapshot s = twoSquares(1.0, 0.0);
  scenes::addPart(s, scenes::makeGeometry({ { 0, 0, 1 }, { 1, 0, 1 }, { 2, 0, 1 } }));
  EXPECT_FALSE(Coincidence(s).inOnePlace(0, 4, { 0.0, 0.0, 1.0 }));
  EXPECT_FALSE(Coincidence(s).passesOver(4, 0, { 0.0, 0.0, 1.0 }, { 0, 0, 1 }));
}

// A ray that leaves the lower square upwards, and whether the upper one, so far above, hides it.
bool isShadowed(const Structure& structure, const Snapshot& s, double height)
{
  const Coincidence surfaces(s);
  Ray ray;
  ray.origin = { 0.2, 0.3, height };
  ray.direction = { 1e-3, 2e-3, 1.0 };
  ray.originTriangle = 0;
  ray.twinEnd = static_cast<float>(4.0 * surfaces.twinReach(0));
  return structure.occluded(ray);
}

// A caster at ten times the bound still casts.
TEST(Coincidence, LeavingRaysPassOverTwinsAndOverNothingElse)
{
  for (const double height : { 1.0, 1e5 })
  {
    SCOPED_TRACE(height);
    const double bound = boundAt(height);
    for (const double apart : { 0.1, 0.9, 1.1, 10.0, 1000.0 })
    {
      SCOPED_TRACE(apart);
      const Snapshot s = twoSquares(height, apart * bound);
      BvhStructure embree;
      KdTreeStructure tree;
      for (Structure* structure : { static_cast<Structure*>(&embree), static_cast<Structure*>(&tree) })
      {
        structure->update(s);
        EXPECT_EQ(isShadowed(*structure, s, height), apart > 1.0);
      }
    }
  }
}

// A wall that stands on the surface where the ray begins is met.
TEST(Coincidence, LeavingRaysMeetAWallAtTheirOrigin)
{
  Snapshot s;
  scenes::addPart(s, square(0.0f));
  scenes::addPart(s, scenes::quad({ 0.2f, -1, -1 }, { 0.2f, -1, 1 }, { 0.2f, 1, 1 }, { 0.2f, 1, -1 }));
  const Coincidence surfaces(s);
  EXPECT_FALSE(surfaces.passesOver(0, 2, { 0.2, 0.0, 0.0 }, { 1.0, 0.0, 1.0 }));
  EXPECT_FALSE(surfaces.passesOver(0, 2, { 0.2, 0.0, 0.0 }, { -1.0, 0.0, 1.0 }));
}

// What all rays meet: a glass cube, standing on a floor, by what a ray is in when it comes down.
TEST(Meetings, ARayInGlassLeavesBeforeItMeetsTheFloor)
{
  Snapshot s;
  Part& glass = scenes::addPart(s, square(0.0f)); // the cube's bottom; its outside is down
  glass.localToWorld = glm::scale(glm::dmat4(1.0), { 1.0, 1.0, -1.0 });
  glass.material = scenes::glass(1.5f);
  scenes::addPart(s, square(0.0f, 2.0f)).material = scenes::glowing(glm::vec3(1.0f));
  Part& painted = scenes::addPart(s, square(0.0f, 0.5f));
  painted.material = scenes::glowing(glm::vec3(0.5f));
  for (std::size_t i = 0; i < s.parts.size(); ++i)
  {
    s.parts[i].source.prop = static_cast<std::uint32_t>(i);
  }
  BvhStructure structure;
  structure.update(s);
  const Surfaces surfaces(s);
  const Meetings meetings(s, surfaces, structure, true);
  Ray down;
  down.origin = { 0.2, 0.1, 1.0 };
  down.direction = { 0.0, 0.0, -1.0 };
  const Hit nearest = structure.intersect(down);
  ASSERT_TRUE(nearest.valid());
  EXPECT_TRUE(nearest.shared);
  std::vector<Hit> members;
  meetings.gather(down, nearest, members);
  EXPECT_EQ(members.size(), 3u);
  const auto partsInOrder = [&](const glm::dvec3& direction) {
    std::vector<Hit> ordered = members;
    meetings.order(direction, kNoTriangle, ordered);
    std::vector<std::size_t> parts;
    for (const Hit& hit : ordered)
    {
      parts.push_back(s.partOf(hit.triangle));
    }
    return parts;
  };
  // Down, out of the glass: first the glass, then what was drawn last.
  EXPECT_EQ(partsInOrder({ 0, 0, -1 }), (std::vector<std::size_t>{ 0, 2, 1 }));
  // Up, into it: the glass is a surface like others, and was drawn first.
  EXPECT_EQ(partsInOrder({ 0, 0, 1 }), (std::vector<std::size_t>{ 2, 1, 0 }));
}

TEST(Meetings, TrianglesOfOneFaceAreOneSurfaceOnTheirEdge)
{
  Snapshot s;
  scenes::addPart(s, square(0.0f)).material = scenes::glass(1.5f);
  BvhStructure structure;
  structure.update(s);
  const Surfaces surfaces(s);
  const Meetings meetings(s, surfaces, structure, true);
  Ray down;
  down.origin = { 0.0, 0.0, 1.0 }; // through the diagonal
  down.direction = { 0.0, 0.0, -1.0 };
  std::vector<Hit> members;
  structure.intersectAll(down, members);
  ASSERT_EQ(members.size(), 2u);
  std::vector<Hit> byDefault = members, named = members;
  meetings.order(down.direction, kNoTriangle, byDefault);
  ASSERT_EQ(byDefault.size(), 1u);
  EXPECT_EQ(byDefault[0].triangle, 1u) << "that drawn last";
  meetings.order(down.direction, kNoTriangle, named, 0);
  ASSERT_EQ(named.size(), 1u);
  EXPECT_EQ(named[0].triangle, 0u);
}

TEST(Meetings, WhatIsFartherBehindIsNoMember)
{
  const double bound = boundAt(1.0);
  for (const double apart : { 0.9, 10.0 })
  {
    Snapshot s = twoSquares(1.0, apart * bound);
    for (const auto& make : { 0, 1 })
    {
      BvhStructure embree;
      KdTreeStructure tree;
      Structure& structure = make ? static_cast<Structure&>(embree) : tree;
      structure.update(s);
      const Surfaces surfaces(s);
      const Meetings meetings(s, surfaces, structure, true);
      Ray down;
      down.origin = { 0.2, 0.1, 3.0 };
      down.direction = { 0.1, 0.0, -1.0 };
      std::vector<Hit> members;
      meetings.gather(down, structure.intersect(down), members);
      EXPECT_EQ(members.size(), apart < 1.0 ? 2u : 1u);
      std::vector<Hit> all;
      structure.intersectAll(down, all);
      EXPECT_EQ(all.size(), 2u);
      EXPECT_LT(all[0].t, all[1].t);
    }
  }
}

} // namespace
