// The order of vertices that gives triangles their numbers.
#include "Rendering/OpenGL2/VertexOrder.h"
#include "Testing/Cxx/Meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace
{

using hrt::gl::VertexOrder;

// A wavy grid, and as many triangles whose corners are picked at random among its vertices.
std::shared_ptr<hrt::Geometry> gridAndChaos(int size)
{
  std::vector<glm::vec3> corners;
  const auto point = [](int i, int j) { return glm::vec3(i, j, (i * j) % 3); };
  for (int j = 0; j < size; ++j)
  {
    for (int i = 0; i < size; ++i)
    {
      corners.insert(corners.end(), { point(i, j), point(i + 1, j), point(i + 1, j + 1) });
      corners.insert(corners.end(), { point(i, j), point(i + 1, j + 1), point(i, j + 1) });
    }
  }
  std::mt19937 random(7);
  for (std::size_t i = corners.size(); i > 0; --i)
  {
    corners.push_back(point(static_cast<int>(random() % unsigned(size)),
      static_cast<int>(random() % unsigned(size))));
  }
  return hrt::meshes::fromCorners(corners);
}

TEST(VertexOrder, EveryTriangleHasItsCornersAndEndsInItsOwnVertex)
{
  const auto mesh = gridAndChaos(12);
  const VertexOrder order(*mesh);
  std::size_t triangle = 0;
  order.forEachTriangle([&](const std::array<std::uint32_t, 3>& places) {
    EXPECT_EQ(places[2], triangle) << "whose number it gives";
    for (int k = 0; k < 3; ++k)
    {
      ASSERT_LT(places[k], order.size());
      EXPECT_EQ(order.vertexAt(places[k]), mesh->triangles[triangle][k]);
    }
    ++triangle;
  });
  EXPECT_EQ(triangle, mesh->triangleCount());
}

TEST(VertexOrder, HoldsOneVertexATriangleAndThoseThatEndNone)
{
  const auto mesh = gridAndChaos(12);
  std::vector<bool> ends(mesh->vertexCount(), false);
  for (const auto& t : mesh->triangles)
  {
    ends[t[2]] = true;
  }
  const auto others = static_cast<std::size_t>(std::count(ends.begin(), ends.end(), false));
  EXPECT_GT(others, 0u) << "else the test shows nothing";
  EXPECT_EQ(VertexOrder(*mesh).size(), mesh->triangleCount() + others);
  EXPECT_EQ(VertexOrder::sizeFor(*mesh), mesh->triangleCount() + others);
}

TEST(VertexOrder, OfNothingIsEmpty)
{
  const auto mesh = hrt::meshes::fromCorners({});
  EXPECT_EQ(VertexOrder(*mesh).size(), 0u);
  EXPECT_EQ(VertexOrder::sizeFor(*mesh), 0u);
}

} // namespace
