// The grouping policy, one test a rule.
#include "Rendering/Core/Structures/Grouping.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace hrt;

// Parts in a row, none touching the next. They share a geometry unless told.
Snapshot row(int count, const std::shared_ptr<const Geometry>& geometry)
{
  Snapshot s;
  for (int i = 0; i < count; ++i)
  {
    scenes::addPart(s, geometry, glm::translate(glm::dmat4(1.0), { 4.0 * i, 0, 0 }));
  }
  return s;
}

const std::shared_ptr<const Geometry> kBall = scenes::sphere(16, 8);

void move(Part& part)
{
  part.localToWorld[3][1] += 0.25;
}

std::ptrdiff_t count(const Grouping& grouping, Place place)
{
  return std::count_if(grouping.parts.begin(), grouping.parts.end(),
    [=](const GroupedPart& part) { return part.place == place; });
}

// The grouping after so many updates with the same snapshot.
Grouping rest(const Snapshot& s, Grouping grouping, unsigned int updates)
{
  for (unsigned int i = 0; i < updates; ++i)
  {
    grouping = groupParts(s, grouping);
  }
  return grouping;
}

TEST(Grouping, TheFirstSnapshotIsMerged)
{
  Snapshot s = row(5, kBall);
  const Grouping first = groupParts(s, {});
  EXPECT_EQ(count(first, Place::Merged), 5);
  EXPECT_TRUE(first.mergedAnew);
  EXPECT_FALSE(first.flatAnew);
  EXPECT_EQ(first.mergedTriangles, s.triangleCount);
  EXPECT_EQ(first.parts[2].before, kNewPart);
  const Grouping second = groupParts(s, first);
  EXPECT_EQ(count(second, Place::Merged), 5);
  EXPECT_FALSE(second.mergedAnew);
  EXPECT_EQ(second.parts[2].before, 2u);
}

TEST(Grouping, WhatMeetsNoRaysHasNoPlace)
{
  Snapshot s = row(3, kBall);
  scenes::addPart(s, scenes::makeGeometry({}));
  s.parts[1].visibleToRays = s.parts[1].castsShadow = false;
  s.parts[2].visibleToRays = false; // still a caster
  const Grouping grouping = groupParts(s, {});
  EXPECT_EQ(grouping.parts[1].place, Place::None);
  EXPECT_EQ(grouping.parts[2].place, Place::Merged);
  EXPECT_EQ(grouping.parts[3].place, Place::None);
  EXPECT_FALSE(groupParts({}, {}).mergedAnew);
}

TEST(Grouping, TheOriginIsNoMovement)
{
  Snapshot s = row(5, kBall);
  const Grouping first = groupParts(s, {});
  s.origin = { 10, 20, 30 };
  const Grouping second = groupParts(s, first);
  EXPECT_FALSE(second.mergedAnew);
  EXPECT_EQ(count(second, Place::Merged), 5);
}

TEST(Grouping, AMovingPartLeavesOnceAndStandsAlone)
{
  Snapshot s = row(10, kBall);
  Grouping grouping = groupParts(s, {});
  for (int frame = 0; frame < 5; ++frame)
  {
    move(s.parts[3]);
    grouping = groupParts(s, grouping);
    EXPECT_EQ(grouping.parts[3].place, Place::Alone);
    EXPECT_EQ(count(grouping, Place::Merged), 9);
    EXPECT_FALSE(grouping.mergedAnew); // a tenth of the triangles is no reason
  }
}

TEST(Grouping, MuchGoneIsBuiltAnewOnce)
{
  Snapshot s = row(8, kBall);
  Grouping grouping = groupParts(s, {});
  int anew = 0;
  for (int frame = 0; frame < 5; ++frame)
  {
    for (int part = 0; part < 3; ++part)
    {
      move(s.parts[part]);
    }
    grouping = groupParts(s, grouping);
    anew += grouping.mergedAnew;
  }
  EXPECT_EQ(anew, 1);
  EXPECT_EQ(grouping.mergedTriangles, 5 * kBall->triangleCount());
}

TEST(Grouping, ARemovedPartIsGoneToo)
{
  Snapshot s = row(8, kBall);
  const Grouping first = groupParts(s, {});
  s.parts.erase(s.parts.begin() + 1);
  const Grouping second = groupParts(s, first);
  EXPECT_FALSE(second.mergedAnew);
  EXPECT_EQ(second.parts[1].before, 2u); // found by key behind the gap
  s.parts.erase(s.parts.begin(), s.parts.begin() + 2);
  EXPECT_TRUE(groupParts(s, second).mergedAnew);
}

TEST(Grouping, APartJoinsAgainAfterARest)
{
  Snapshot s = row(10, kBall);
  Grouping grouping = groupParts(s, {});
  unsigned int needed = kUpdatesToRest;
  for (int departure = 0; departure < 3; ++departure)
  {
    move(s.parts[3]);
    needed *= 2; // each departure doubles the rest
    grouping = rest(s, groupParts(s, grouping), needed - 1);
    EXPECT_EQ(grouping.parts[3].place, Place::Alone);
    grouping = groupParts(s, grouping);
    EXPECT_EQ(grouping.parts[3].place, Place::Merged);
    EXPECT_TRUE(grouping.mergedAnew);
  }
}

TEST(Grouping, ALargeStructureIsNotBuiltForASmallPart)
{
  const auto large = scenes::torus(300, 120, 1.0, 0.4), small = scenes::sphere(16, 8);
  ASSERT_GT(large->triangleCount(), kCheapTriangles);
  Snapshot s = row(1, large);
  scenes::addPart(s, small, glm::translate(glm::dmat4(1.0), { 9, 0, 0 }));
  Grouping grouping = groupParts(s, {});
  EXPECT_EQ(count(grouping, Place::Merged), 2);
  move(s.parts[1]);
  grouping = rest(s, groupParts(s, grouping), 10 * kUpdatesToRest);
  EXPECT_EQ(grouping.parts[1].place, Place::Alone);
}

TEST(Grouping, LightNewPartsRestFirstHeavyOnesJoinAtOnce)
{
  Snapshot s = row(4, kBall);
  Grouping grouping = groupParts(s, {});
  scenes::addPart(s, kBall, glm::translate(glm::dmat4(1.0), { 0, 9, 0 }));
  grouping = groupParts(s, grouping);
  EXPECT_EQ(grouping.parts[4].place, Place::Alone);
  EXPECT_FALSE(grouping.mergedAnew);
  scenes::addPart(s, scenes::sphere(64, 32), glm::translate(glm::dmat4(1.0), { 0, 13, 0 }));
  grouping = groupParts(s, grouping);
  EXPECT_EQ(grouping.parts[4].place, Place::Alone);
  EXPECT_EQ(grouping.parts[5].place, Place::Merged);
}

TEST(Grouping, ADeformedPartLeavesAndIsMarked)
{
  Snapshot s = row(6, kBall);
  const Grouping first = groupParts(s, {});
  s.parts[0].geometry = scenes::sphere(16, 8); // as many triangles
  s.parts[1].geometry = scenes::sphere(18, 8);
  const Grouping second = groupParts(s, first);
  EXPECT_EQ(second.parts[0].place, Place::Alone);
  EXPECT_TRUE(second.parts[0].deformed);
  EXPECT_EQ(second.parts[1].place, Place::Alone);
  EXPECT_FALSE(second.parts[1].deformed);
  EXPECT_FALSE(groupParts(s, second).parts[0].deformed);
}

TEST(Grouping, CrowdsAreFlatAndBuiltOnlyWhenTheyMove)
{
  Snapshot s = row(30, kBall);
  for (int i = 0; i < 20; ++i)
  {
    s.parts[i].localToWorld = glm::translate(glm::dmat4(1.0), { 0.01 * i, 0, 0 });
  }
  Grouping grouping = groupParts(s, {});
  EXPECT_EQ(count(grouping, Place::Merged), 30); // at rest the crowd does not matter
  for (int i = 0; i < 25; ++i)
  {
    move(s.parts[i]);
  }
  grouping = groupParts(s, grouping);
  EXPECT_EQ(count(grouping, Place::Flat), 20);
  EXPECT_EQ(count(grouping, Place::Alone), 5);
  EXPECT_TRUE(grouping.flatAnew);
  move(s.parts[24]); // of those that stand alone
  grouping = groupParts(s, grouping);
  EXPECT_EQ(count(grouping, Place::Flat), 20);
  EXPECT_FALSE(grouping.flatAnew);
  move(s.parts[0]);
  EXPECT_TRUE(groupParts(s, grouping).flatAnew);
}

TEST(Grouping, TinyMovingPartsAreFlat)
{
  const auto quad = scenes::quad({ 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 });
  Snapshot s = row(10, quad);
  Grouping grouping = groupParts(s, {});
  move(s.parts[0]);
  grouping = groupParts(s, grouping);
  EXPECT_EQ(grouping.parts[0].place, Place::Flat);
  EXPECT_TRUE(grouping.flatAnew);
  s.parts.erase(s.parts.begin());
  grouping = groupParts(s, grouping);
  EXPECT_TRUE(grouping.flatAnew); // nothing is left of it
  EXPECT_FALSE(groupParts(s, grouping).flatAnew);
}

TEST(Grouping, CopiesAreNotMultiplied)
{
  const auto mesh = scenes::torus(300, 120, 1.0, 0.4);
  Snapshot s = row(20, mesh);
  ASSERT_GT(s.triangleCount, kMostCopiedTriangles);
  scenes::addPart(s, kBall, glm::translate(glm::dmat4(1.0), { 0, 9, 0 }));
  scenes::addPart(s, kBall, glm::translate(glm::dmat4(1.0), { 0, 19, 0 }));
  const Grouping grouping = rest(s, {}, 2 * kUpdatesToRest);
  EXPECT_EQ(count(grouping, Place::Alone), 20);
  EXPECT_EQ(count(grouping, Place::Merged), 2);
}

TEST(Grouping, SkewedMatricesNeverStandAlone)
{
  Snapshot s = row(10, kBall);
  s.parts[0].localToWorld[0] *= 1e-9;
  Grouping grouping = groupParts(s, {});
  move(s.parts[0]);
  grouping = groupParts(s, grouping);
  EXPECT_EQ(grouping.parts[0].place, Place::Flat);
  s.parts.resize(1); // a single part at rest, neither
  EXPECT_EQ(rest(s, {}, 1).parts[0].place, Place::Merged);
}

TEST(Grouping, ASinglePartStandsAlone)
{
  Snapshot s = row(1, kBall);
  Grouping grouping = groupParts(s, {});
  EXPECT_EQ(grouping.parts[0].place, Place::Alone);
  EXPECT_FALSE(grouping.mergedAnew);
  for (unsigned int i = 0; i < 3 * kUpdatesToRest; ++i)
  {
    grouping = groupParts(s, grouping);
    EXPECT_EQ(grouping.parts[0].place, Place::Alone);
    EXPECT_FALSE(grouping.mergedAnew);
  }
}

TEST(Grouping, OneKeyTwiceIsTwoParts)
{
  Snapshot s = row(4, kBall);
  s.parts[2].key = s.parts[1].key;
  const Grouping first = groupParts(s, {});
  std::swap(s.parts[0], s.parts[3]);
  const Grouping second = groupParts(s, first);
  EXPECT_NE(second.parts[1].before, second.parts[2].before);
  EXPECT_EQ(second.parts[0].before, 3u);
}

} // namespace
