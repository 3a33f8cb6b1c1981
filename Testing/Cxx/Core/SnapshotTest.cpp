// Whose triangle an id is, what is new between two snapshots, and the boxes of parts.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

namespace
{

using namespace hrt;

std::shared_ptr<Geometry> triangles(int count)
{
  std::vector<glm::vec3> positions;
  for (int i = 0; i < count; ++i)
  {
    const float x = static_cast<float>(i);
    positions.insert(positions.end(), { { x, 0, 0 }, { x + 1, 0, 0 }, { x, 1, 0 } });
  }
  return scenes::makeGeometry(positions);
}

Snapshot twoPartsTwoLights()
{
  Snapshot s;
  scenes::addPart(s, triangles(2));
  scenes::addPart(s, triangles(3));
  s.lights.resize(2);
  s.lights[0].key = 10;
  s.lights[1].key = 20;
  s.camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 64, 48);
  return s;
}

TEST(Snapshot, PartOfSkipsEmptyParts)
{
  Snapshot s;
  const int counts[] = { 0, 2, 0, 0, 3, 1, 0 };
  for (int count : counts)
  {
    scenes::addPart(s, triangles(count));
  }
  const std::size_t expected[] = { 1, 1, 4, 4, 4, 5 };
  ASSERT_EQ(s.triangleCount, 6u);
  for (TriangleId id = 0; id < 6; ++id)
  {
    EXPECT_EQ(s.partOf(id), expected[id]) << id;
  }
}

TEST(Snapshot, FirstComparisonChangesEverything)
{
  const Changes c = compareSnapshots(nullptr, twoPartsTwoLights());
  EXPECT_TRUE(c.first && c.camera && c.geometry && c.transforms && c.materials && c.culling &&
    c.lightColors && c.background && c.lightCount);
  EXPECT_EQ(c.lightMoved, std::vector<bool>({ true, true }));
}

TEST(Snapshot, EqualSnapshotsHaveNoChanges)
{
  const Snapshot s = twoPartsTwoLights();
  const Changes c = compareSnapshots(&s, s);
  EXPECT_FALSE(c.any());
  EXPECT_FALSE(c.culling);
  EXPECT_EQ(c.lightMoved, std::vector<bool>({ false, false }));
}

// The names of all flags that a change to the snapshot raises.
std::string flagsAfter(const std::function<void(Snapshot&)>& change)
{
  const Snapshot before = twoPartsTwoLights();
  Snapshot now = before;
  change(now);
  const Changes c = compareSnapshots(&before, now);
  std::string flags;
  const auto add = [&flags](bool raised, const char* name) {
    flags += raised ? (flags.empty() ? "" : " ") + std::string(name) : "";
  };
  add(c.first, "first");
  add(c.camera, "camera");
  add(c.geometry, "geometry");
  add(c.transforms, "transforms");
  add(c.materials, "materials");
  add(c.culling, "culling");
  add(c.lightColors, "lightColors");
  add(c.background, "background");
  add(c.lightCount, "lightCount");
  for (std::size_t i = 0; i < c.lightMoved.size(); ++i)
  {
    add(c.lightMoved[i], ("moved" + std::to_string(i)).c_str());
  }
  return flags;
}

TextureLayer layer(std::uint64_t version)
{
  auto texture = std::make_shared<Texture>();
  texture->version = version;
  return { texture, TextureBlend::None };
}

// A texture with holes says what is seen where; another one only how it looks.
TEST(Snapshot, AnotherSetOfHolesIsAnotherSurface)
{
  for (const bool perforated : { false, true })
  {
    Snapshot before, now;
    for (Snapshot* s : { &before, &now })
    {
      Part& part = scenes::addPart(*s, triangles(1));
      part.geometry = before.parts[0].geometry;
      part.perforated = perforated;
    }
    before.parts[0].material.textures.layers = { layer(1) };
    now.parts[0].material.textures.layers = { layer(1) };
    Changes same = compareSnapshots(&before, now);
    EXPECT_FALSE(same.geometry || same.materials);
    now.parts[0].material.textures.layers = { layer(2) };
    Changes other = compareSnapshots(&before, now);
    EXPECT_TRUE(other.materials);
    EXPECT_EQ(other.geometry, perforated);
  }
}

TEST(Snapshot, EachChangeRaisesItsFlagAlone)
{
  const struct
  {
    const char* flags;
    std::function<void(Snapshot&)> change;
  } table[] = {
    { "camera", [](Snapshot& s) { s.camera.width = 65; } },
    { "camera", [](Snapshot& s) { s.camera.worldToView[3][0] += 1; } },
    { "geometry", [](Snapshot& s) { s.parts[0].geometry = triangles(2); } },
    { "geometry", [](Snapshot& s) { s.parts[1].visibleToCamera = false; } },
    { "geometry", [](Snapshot& s) { s.parts[1].visibleToRays = false; } },
    { "geometry", [](Snapshot& s) { s.parts[1].castsShadow = false; } },
    { "geometry", [](Snapshot& s) { s.parts[1].perforated = true; } },
    { "geometry", [](Snapshot& s) { s.parts[1].firstTriangle = 7; } },
    { "geometry", [](Snapshot& s) { s.parts.pop_back(); } },
    { "geometry", [](Snapshot& s) { std::swap(s.parts[0], s.parts[1]); } },
    { "transforms", [](Snapshot& s) { s.parts[1].localToWorld[3][2] = 4; } },
    { "transforms", [](Snapshot& s) { s.origin.x = 1; } },
    { "materials", [](Snapshot& s) { s.parts[0].material.front.diffuse = 0.5f; } },
    { "materials", [](Snapshot& s) { s.parts[0].material.reflectance = 0.5f; } },
    { "materials", [](Snapshot& s) { s.parts[0].material.textures.onBack = false; } },
    { "materials", [](Snapshot& s) { s.parts[0].material.textures.layers = { layer(1) }; } },
    { "materials culling", [](Snapshot& s) { s.parts[0].material.cullBack = true; } },
    { "lightColors", [](Snapshot& s) { s.lights[1].color.g = 0.5f; } },
    { "lightColors", [](Snapshot& s) { s.lights[1].attenuation.y = 0.5f; } },
    { "lightColors", [](Snapshot& s) { s.lights[1].exponent = 3; } },
    { "lightColors", [](Snapshot& s) { s.singleHeadlight = true; } },
    { "moved1", [](Snapshot& s) { s.lights[1].position.x = 3; } },
    { "moved1", [](Snapshot& s) { s.lights[1].direction = { 1, 0, 0 }; } },
    { "moved0", [](Snapshot& s) { s.lights[0].coneAngle = 20; } },
    { "moved0", [](Snapshot& s) { s.lights[0].kind = Light::Kind::Positional; } },
    { "moved0", [](Snapshot& s) { s.lights[0].isHeadlight = true; } },
    { "lightCount", [](Snapshot& s) { s.lights.pop_back(); } },
    { "lightCount moved1", [](Snapshot& s) { s.lights[1].key = 30; } },
    { "lightCount", [](Snapshot& s) { std::swap(s.lights[0], s.lights[1]); } },
    { "background", [](Snapshot& s) { s.background.top.b = 0.5f; } },
  };
  int row = 0;
  for (const auto& line : table)
  {
    EXPECT_EQ(flagsAfter(line.change), line.flags) << "row " << row;
    ++row;
  }
}

TEST(Snapshot, WorldBoundsFollowTheMatrix)
{
  Snapshot s;
  auto geometry = std::make_shared<Geometry>(*triangles(2)); // box (0,0,0) - (2,1,0)
  geometry->origin = { 1024, 0, 0 };
  glm::dmat4 m(1.0); // a quarter turn about z, then up by 5: exact in binary
  m[0] = { 0, 1, 0, 0 };
  m[1] = { -1, 0, 0, 0 };
  m[3] = { 0, 0, 5, 1 };
  glm::dvec3 lower, upper;
  worldBounds(scenes::addPart(s, geometry, m), lower, upper);
  EXPECT_EQ(lower, glm::dvec3(-1, 1024, 5));
  EXPECT_EQ(upper, glm::dvec3(0, 1026, 5));
  worldBounds(scenes::addPart(s, triangles(0)), lower, upper);
  EXPECT_GT(lower.x, upper.x);
}

} // namespace
