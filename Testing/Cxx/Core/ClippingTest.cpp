// Meshes cut by planes: what is left, of which cells, with which values, and that it stays closed.
#include "Scenes.h"

#include "Rendering/Core/Geometry/Clipping.h"

#include <gtest/gtest.h>

#include <map>

namespace hrt
{
namespace
{

double area(const Geometry& mesh)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangleCount(); ++i)
  {
    const std::array<glm::vec3, 3> p = mesh.cornerPositions(i);
    sum += 0.5 *
      glm::length(glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0])));
  }
  return sum;
}

// Edges of one triangle only.
std::size_t openEdges(const Geometry& mesh)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    }
  }
  return static_cast<std::size_t>(
    std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 1; }));
}

std::shared_ptr<Geometry> unitSquare()
{
  return scenes::quad({ 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 });
}

TEST(Clipping, KeepsTheSideThatThePlaneFaces)
{
  const Geometry left = clipped(*unitSquare(), { { 1, 0, 0, -0.25 } });
  EXPECT_NEAR(area(left), 0.75, 1e-7);
  EXPECT_EQ(left.boundsMin, glm::vec3(0.25f, 0, 0));
  EXPECT_EQ(left.boundsMax, glm::vec3(1, 1, 0));
  for (std::size_t i = 0; i < left.triangleCount(); ++i)
  {
    const std::array<glm::vec3, 3> p = left.cornerPositions(i);
    EXPECT_GT(glm::cross(p[1] - p[0], p[2] - p[0]).z, 0.0f) << "wound as before";
  }
}

TEST(Clipping, LeavesWhatLiesBeforeAllPlanesAsItIs)
{
  const auto mesh = scenes::torus(20, 10, 1.0, 0.4);
  const Geometry left = clipped(*mesh, { { 0, 0, 1, 5 }, { 0, 1, 0, 5 } });
  ASSERT_EQ(left.triangleCount(), mesh->triangleCount());
  for (std::size_t i = 0; i < left.triangleCount(); ++i)
  {
    EXPECT_EQ(left.cornerPositions(i), mesh->cornerPositions(i));
  }
  EXPECT_EQ(left.cellIds, mesh->cellIds);
  EXPECT_EQ(clipped(*mesh, { { 0, 0, 1, -5 } }).triangleCount(), 0u);
}

TEST(Clipping, PlanesThroughCornersCutNothingOff)
{
  EXPECT_EQ(clipped(*unitSquare(), { { 1, 0, 0, 0 } }).triangleCount(), 2u);
  EXPECT_EQ(clipped(*unitSquare(), { { -1, 0, 0, 0 } }).triangleCount(), 0u);
  // Along the diagonal: one of the two triangles.
  EXPECT_EQ(clipped(*unitSquare(), { { 1, -1, 0, 0 } }).triangleCount(), 1u);
}

TEST(Clipping, SeveralPlanesMeetInCorners)
{
  const Geometry left =
    clipped(*unitSquare(), { { 1, 0, 0, -0.25 }, { 0, 1, 0, -0.5 }, { -1, -1, 0, 1.5 } });
  // The corner square of 0.75 x 0.5 less the triangle beyond x + y = 1.5.
  EXPECT_NEAR(area(left), 0.375 - 0.125, 1e-7);
}

TEST(Clipping, AClosedMeshIsOpenAlongTheCutOnly)
{
  const auto mesh = scenes::torus(40, 20, 1.0, 0.4);
  ASSERT_EQ(openEdges(*mesh), 0u);
  const ClippingPlane plane(0.3, 0.9, 0.2, 0.11);
  const Geometry left = clipped(*mesh, { plane });
  EXPECT_GT(left.triangleCount(), mesh->triangleCount() / 3);
  EXPECT_GT(openEdges(left), 20u);
  std::size_t onCut = 0;
  for (const glm::vec3& p : left.positions)
  {
    const double distance = glm::dot(plane, glm::dvec4(p, 1.0));
    EXPECT_GT(distance, -1e-6);
    onCut += std::abs(distance) < 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(onCut, openEdges(left)) << "each new vertex is shared by two triangles";
}

TEST(Clipping, InterpolatesWhatVerticesHaveAndKeepsWhatTrianglesHave)
{
  auto mesh = std::make_shared<Geometry>(*unitSquare());
  mesh->origin = { 1e9, 0, 0 };
  mesh->normals.values.clear();
  for (const glm::vec3& p : mesh->positions)
  {
    mesh->normals.values.push_back({ p.x, 0, 1 });
    mesh->coordinates.values.push_back({ p.x, p.y });
  }
  mesh->colors.attachment = Attachment::Triangles;
  mesh->colors.values = { { 1, 2, 3, 255 }, { 4, 5, 6, 255 } };
  mesh->cellIds = { 10, 20 };
  const Geometry left = clipped(*mesh, { { 1, 0, 0, -1e9 - 0.5 } });
  EXPECT_NEAR(area(left), 0.5, 1e-7);
  for (std::size_t v = 0; v < left.vertexCount(); ++v)
  {
    EXPECT_EQ(left.normals.values[v].x, left.positions[v].x);
    EXPECT_EQ(left.coordinates.values[v], glm::vec2(left.positions[v]));
  }
  ASSERT_EQ(left.colors.values.size(), left.triangleCount());
  for (std::size_t i = 0; i < left.triangleCount(); ++i)
  {
    EXPECT_EQ(left.colors.values[i].x, left.cellIds[i] == 10 ? 1 : 4);
  }
}

} // namespace
} // namespace hrt
