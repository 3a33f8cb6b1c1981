// The indexed mesh: what belongs to vertices and to triangles, and cell numbers in little memory.
#include "Rendering/Core/Geometry/Geometry.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace hrt;

CellIds idsOf(const std::vector<std::int64_t>& ids)
{
  CellIds list;
  list.reserve(ids.size());
  for (const std::int64_t id : ids)
  {
    list.push_back(id);
  }
  return list;
}

TEST(CellIds, AreThoseThatWerePutIn)
{
  constexpr std::int64_t most32 = std::numeric_limits<std::uint32_t>::max();
  constexpr std::int64_t most64 = std::numeric_limits<std::int64_t>::max();
  const std::vector<std::vector<std::int64_t>> lists = { {}, { 0 }, { 7, 8, 9, 10 }, { 0, 0, 1, 1 },
    { 3, 2 }, { 5, 6, 5 }, { most32, most32 + 1, most32 + 2 }, { most32 - 1, most32, 0 },
    { 0, 1, most32 + 1 }, { 0, 2, most32, most32 + 1, 4 }, { most32 + 1, 0 }, { most64, 0, -1 } };
  for (const std::vector<std::int64_t>& ids : lists)
  {
    const CellIds list = idsOf(ids);
    ASSERT_EQ(list.size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      EXPECT_EQ(list[i], ids[i]) << i;
    }
    for (const std::vector<std::int64_t>& other : lists)
    {
      EXPECT_EQ(list == idsOf(other), ids == other);
    }
  }
}

TEST(CellIds, TakeNoMoreMemoryThanTheyNeed)
{
  std::vector<std::int64_t> triangles, quads, huge;
  for (std::int64_t i = 0; i < 1000; ++i)
  {
    triangles.push_back(20 + i); // behind 20 cells that are lines
    quads.push_back(i / 2);
    huge.push_back((std::int64_t(1) << 40) + i / 2);
  }
  EXPECT_EQ(idsOf(triangles).bytes(), 0u);
  EXPECT_EQ(idsOf(quads).bytes(), 4000u);
  EXPECT_EQ(idsOf(huge).bytes(), 8000u);
}

TEST(Geometry, HandsOutWhatBelongsToCorners)
{
  Geometry mesh;
  mesh.positions = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  mesh.triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  mesh.colors.values = { glm::u8vec4(1), glm::u8vec4(2), glm::u8vec4(3), glm::u8vec4(4) };
  mesh.normals.values = { { 0, 0, 1 }, { 0, 1, 0 } };
  mesh.normals.attachment = Attachment::Triangles;
  EXPECT_EQ(mesh.vertexCount(), 4u);
  EXPECT_EQ(mesh.triangleCount(), 2u);
  using Positions = std::array<glm::vec3, 3>;
  EXPECT_EQ(mesh.cornerPositions(1), (Positions{ { { 0, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } } }));
  EXPECT_EQ(
    mesh.cornersOf(mesh.normals, 1), (Positions{ { { 0, 1, 0 }, { 0, 1, 0 }, { 0, 1, 0 } } }));
  const std::array<glm::u8vec4, 3> colors = mesh.cornersOf(mesh.colors, 1);
  EXPECT_EQ(colors[0], glm::u8vec4(1));
  EXPECT_EQ(colors[1], glm::u8vec4(3));
  EXPECT_EQ(colors[2], glm::u8vec4(4));
}

} // namespace
