// Triangulation: which triangles come out of which cells, in which order, with which coordinates.
#include "SceneTest.h"

#include "vtkSphereSource.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace
{

using Triangles = SceneTest;

double totalArea(const hrt::Geometry& geometry)
{
  double area = 0.0;
  for (std::size_t t = 0; t < geometry.triangleCount(); ++t)
  {
    area += 0.5 * glm::length(areaVector(geometry, t));
  }
  return area;
}

// No triangle is turned over relative to the polygon's side.
bool allFace(const hrt::Geometry& geometry, const glm::dvec3& side)
{
  for (std::size_t t = 0; t < geometry.triangleCount(); ++t)
  {
    if (!(glm::dot(areaVector(geometry, t), side) > 0.0))
    {
      return false;
    }
  }
  return true;
}

TEST_F(Triangles, AreTakenCornerByCorner)
{
  this->addMesh(makeSquare());
  const hrt::Geometry& g = this->onlyGeometry();
  const std::vector<glm::vec3> expected = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 0, 0 },
    { 1, 1, 0 }, { 0, 1, 0 } };
  EXPECT_EQ(hrt::meshes::cornersOf(g), expected);
  EXPECT_EQ(g.vertexCount(), 4u) << "what triangles share is stored once";
  EXPECT_EQ(g.cellIds, (hrt::CellIds{ 0, 1 }));
  EXPECT_EQ(g.boundsMin, glm::vec3(0, 0, 0));
  EXPECT_EQ(g.boundsMax, glm::vec3(1, 1, 0));
  EXPECT_EQ(g.origin, glm::dvec3(0.0));
  EXPECT_NE(g.version, 0u);
  EXPECT_TRUE(this->messages.warnings.empty());
}

TEST_F(Triangles, QuadsAndConvexPolygonsAreFansAsInVTKsMapper)
{
  this->addMesh(makeMesh({ { 0, 0, 0 }, { 2, 0, 0 }, { 3, 1, 0 }, { 2, 2, 0 }, { 0, 2, 0 } },
    { { 0, 1, 3, 4 }, { 0, 1, 2, 3, 4 } }));
  const hrt::Geometry& g = this->onlyGeometry();
  ASSERT_EQ(g.cellIds, (hrt::CellIds{ 0, 0, 1, 1, 1 }));
  for (std::size_t t = 0; t < 5; ++t)
  {
    EXPECT_EQ(g.cornerPositions(t)[0], glm::vec3(0)) << "every triangle of a fan starts at point 0";
  }
  EXPECT_EQ(g.cornerPositions(2)[1], glm::vec3(2, 0, 0));
  EXPECT_EQ(g.cornerPositions(2)[2], glm::vec3(3, 1, 0));
}

TEST_F(Triangles, ATwistedQuadKeepsVTKsDiagonal)
{
  this->addMesh(
    makeMesh({ { 0, 0, 0 }, { 1, 0, 0.3 }, { 1, 1, 0 }, { 0, 1, 0.3 } }, { { 0, 1, 2, 3 } }));
  const hrt::Geometry& g = this->onlyGeometry();
  ASSERT_EQ(g.triangleCount(), 2u);
  EXPECT_EQ(g.cornerPositions(0)[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(g.cornerPositions(1)[1], glm::vec3(1, 1, 0));
}

// An arrow head: the second triangle of the fan from point 0 would be turned over.
TEST_F(Triangles, AConcaveQuadIsCutAlongItsInnerDiagonal)
{
  this->addMesh(
    makeMesh({ { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 }, { 3, 3, 0 } }, { { 0, 1, 2, 3 } }));
  const hrt::Geometry& g = this->onlyGeometry();
  ASSERT_EQ(g.triangleCount(), 2u);
  EXPECT_TRUE(allFace(g, glm::dvec3(0, 0, 1)));
  EXPECT_EQ(totalArea(g), 4.0) << "shoelace: (16 + 16 - 12 - 12) / 2; small integers, hence exact";
}

TEST_F(Triangles, AConcavePolygonIsCoveredOnce)
{
  // A comb with three teeth, listed both ways round and in a tilted plane.
  const std::vector<glm::dvec2> comb = { { 0, 0 }, { 5, 0 }, { 5, 3 }, { 4, 3 }, { 4, 1 }, { 3, 1 },
    { 3, 3 }, { 2, 3 }, { 2, 1 }, { 1, 1 }, { 1, 3 }, { 0, 3 } };
  for (bool reversed : { false, true })
  {
    std::vector<glm::dvec3> points;
    for (const glm::dvec2& p : comb)
    {
      points.emplace_back(p.x, p.y, p.x + p.y); // the plane z = x + y, area factor sqrt(3)
    }
    std::vector<vtkIdType> cell(points.size());
    std::iota(cell.begin(), cell.end(), 0);
    if (reversed)
    {
      std::reverse(cell.begin(), cell.end());
    }
    SCOPED_TRACE(reversed);
    this->renderer->RemoveAllViewProps();
    this->addMesh(makeMesh(points, { cell }));
    const hrt::Geometry& g = this->onlyGeometry();
    EXPECT_EQ(g.triangleCount(), comb.size() - 2);
    EXPECT_TRUE(allFace(g, (reversed ? -1.0 : 1.0) * glm::dvec3(-1, -1, 1)));
    // 3 x 5 less two notches of 1 x 2. Ten square roots and sums of relative error 2^-53 each.
    EXPECT_NEAR(totalArea(g), 11.0 * std::sqrt(3.0), 1e-13);
  }
}

// A U as map makers write rings: the first corner once more at the end, by number or by place, either
// way round, a corner twice, one in a line, a way there and back, corners a hair off the plane.
TEST_F(Triangles, RingsAsMapMakersWriteThemAreCoveredOnce)
{
  const std::vector<glm::dvec3> u = { { -5, -5, 0 }, { 5, -5, 0 }, { 5, 5, 0 }, { 3, 5, 0 },
    { 3, -3, 0 }, { -3, -3, 0 }, { -3, 5, 0 }, { -5, 5, 0 } };
  const std::vector<vtkIdType> all = { 0, 1, 2, 3, 4, 5, 6, 7 };
  struct Ring
  {
    const char* name;
    std::vector<glm::dvec3> points;
    std::vector<vtkIdType> ids;
  };
  std::vector<Ring> rings = { { "plain", u, all }, { "closed by number", u, all },
    { "closed by place", u, all }, { "a corner twice", u, all }, { "a corner in line", u, all },
    { "there and back", u, all }, { "there and back at the beginning", u, all },
    { "there and back twice", u, all }, { "nearly plane", u, all } };
  rings[1].ids.push_back(0);
  rings[2].points.push_back(u[0]);
  rings[2].ids.push_back(8);
  rings[3].ids = { 0, 1, 2, 3, 4, 4, 5, 6, 7 };
  rings[4].points.emplace_back(0, -5, 0);
  rings[4].ids = { 0, 8, 1, 2, 3, 4, 5, 6, 7 };
  rings[5].points.emplace_back(8, -5, 0);
  rings[5].ids = { 0, 1, 8, 1, 2, 3, 4, 5, 6, 7 };
  rings[6].points.emplace_back(-8, -5, 0);
  rings[6].ids = { 8, 0, 1, 2, 3, 4, 5, 6, 7, 0 };
  rings[7].points.insert(rings[7].points.end(), { { 7, -5, 0 }, { 7, -8, 0 } });
  rings[7].ids = { 0, 1, 8, 9, 8, 1, 2, 3, 4, 5, 6, 7 };
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    rings[8].points[i].z = i % 2 ? 0.005 : 0.0;
  }
  for (const Ring& ring : rings)
  {
    for (bool reversed : { false, true })
    {
      SCOPED_TRACE(std::string(ring.name) + (reversed ? ", reversed" : ""));
      auto cell = ring.ids;
      if (reversed)
      {
        std::reverse(cell.begin(), cell.end());
      }
      this->renderer->RemoveAllViewProps();
      this->addMesh(makeMesh(ring.points, { cell }));
      const hrt::Geometry& g = this->onlyGeometry();
      // 10 x 10 less 6 x 8; the corners off the plane add a few millionths.
      EXPECT_NEAR(totalArea(g), 52.0, 1e-3);
      EXPECT_TRUE(this->messages.warnings.empty());
    }
  }
}

// A bow tie cannot be triangulated; its fan is what VTK's mapper draws.
TEST_F(Triangles, ASelfCrossingPolygonFallsBackToTheFan)
{
  this->addMesh(
    makeMesh({ { 0, 0, 0 }, { 2, 2, 0 }, { 2, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2, 3 } }));
  const hrt::Geometry& g = this->onlyGeometry();
  ASSERT_EQ(g.triangleCount(), 2u);
  EXPECT_EQ(g.cellIds, (hrt::CellIds{ 0, 0 }));
}

TEST_F(Triangles, StripsAlternateTheirWinding)
{
  this->addMesh(makeMesh({ { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 2, 0, 0 } }, {},
    VTK_FLOAT, { { 0, 1, 2, 3, 4 } }));
  const hrt::Geometry& g = this->onlyGeometry();
  ASSERT_EQ(g.triangleCount(), 3u);
  EXPECT_TRUE(allFace(g, glm::dvec3(0, 0, -1)));
  EXPECT_EQ(totalArea(g), 1.5);
  EXPECT_EQ(g.cellIds, (hrt::CellIds{ 0, 0, 0 }));
}

TEST_F(Triangles, CellIdsCountVertsLinesPolygonsAndStrips)
{
  auto mesh = makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } }, { { 0, 1, 2 } },
    VTK_FLOAT, { { 0, 1, 2, 3 } });
  mesh->SetVerts(makeCells({ { 0 }, { 1 } }));
  mesh->SetLines(makeCells({ { 0, 1 }, { 1, 2 }, { 2, 3 } }));
  this->addMesh(mesh);
  EXPECT_EQ(this->onlyGeometry().cellIds, (hrt::CellIds{ 5, 6, 6 }));
}

TEST_F(Triangles, PlaceHolderPolygonsKeepTheirNumber)
{
  this->addMesh(makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1 }, { 0, 1, 2 } }));
  EXPECT_EQ(this->onlyGeometry().cellIds, (hrt::CellIds{ 1 }));
  EXPECT_EQ(this->snapshot->refusals.total(), 0u);
}

TEST_F(Triangles, NumbersFollowThePartsAndTheSphereHasItsArea)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(64);
  sphere->SetPhiResolution(64);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(sphere->GetOutputPort());
  vtkNew<vtkActor> ball;
  ball->SetMapper(mapper);
  auto square = this->addMesh(makeSquare());
  this->renderer->AddActor(ball);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_EQ(s.parts[0].firstTriangle, 0u);
  EXPECT_EQ(s.parts[1].firstTriangle, 2u);
  const std::size_t triangles = s.parts[1].geometry->triangleCount();
  EXPECT_EQ(triangles, static_cast<std::size_t>(sphere->GetOutput()->GetNumberOfPolys()))
    << "the pipeline was brought up to date";
  EXPECT_EQ(s.triangleCount, 2 + triangles);
  EXPECT_EQ(this->scene->GetProp(0), square.Get());
  EXPECT_EQ(this->scene->GetProp(1), ball.Get());
  EXPECT_EQ(this->scene->GetProp(2), nullptr);
  // An inscribed mesh of 64 steps is 1 - O((2 pi / 64)^2) = 1 - 0.01 of pi, the sphere's area.
  EXPECT_NEAR(totalArea(*s.parts[1].geometry), std::acos(-1.0), 0.01 * std::acos(-1.0));
}

TEST_F(Triangles, StaticMappersAreNotUpdated)
{
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(sphere->GetOutputPort());
  mapper->StaticOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  this->renderer->AddActor(actor);
  EXPECT_EQ(this->update().triangleCount, 0u) << "the sphere was never made";
  mapper->StaticOff();
  EXPECT_GT(this->update().triangleCount, 0u);
}

TEST_F(Triangles, VerticesAreThePointsThatTrianglesUseInTheirOrder)
{
  // Of the points, 0 is used by nobody and 4 only by a triangle without area.
  this->addMesh(makeMesh(
    { { 9, 9, 9 }, { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 1, 1, 0 } },
    { { 5, 3, 2 }, { 1, 2, 4 }, { 1, 2, 3 } }));
  const hrt::Geometry& g = this->onlyGeometry();
  EXPECT_EQ(g.positions,
    (std::vector<glm::vec3>{ { 1, 1, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 0 } }));
  EXPECT_EQ(g.triangles,
    (std::vector<std::array<std::uint32_t, 3>>{ { { 0, 1, 2 } }, { { 3, 2, 1 } } }));
  EXPECT_EQ(g.cellIds, (hrt::CellIds{ 0, 2 }));
  EXPECT_EQ(this->snapshot->refusals.degenerateTriangles, 1u);
}

// Points at one place with values of their own, as where colours or normals break, stay apart.
TEST_F(Triangles, PointsAtOnePlaceStayApart)
{
  this->addMesh(makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 0, 0 }, { 1, 1, 0 },
                           { 0, 1, 0 } },
    { { 0, 1, 2 }, { 3, 4, 5 } }));
  EXPECT_EQ(this->onlyGeometry().vertexCount(), 6u);
}

// Float coordinates survive exactly, however far from zero they lie.
TEST_F(Triangles, FarFloatCoordinatesAreExact)
{
  std::vector<glm::dvec3> points;
  for (const glm::vec3& offset : { glm::vec3(0.1f, -0.3f, 0.7f), glm::vec3(1.7f, 0.2f, -0.9f),
         glm::vec3(-1.3f, 1.1f, 0.4f), glm::vec3(0.6f, -1.9f, 1.2f) })
  {
    points.emplace_back(glm::vec3(148376.0f, 1234.0f, -223423.0f) + offset);
  }
  this->addMesh(makeMesh(points, { { 0, 1, 2 }, { 0, 2, 3 } }, VTK_FLOAT));
  const hrt::Geometry& g = this->onlyGeometry();
  EXPECT_NE(g.origin.x, 0.0);
  EXPECT_NE(g.origin.z, 0.0);
  // The box' diagonal lies in (4, 8], hence g = 8 and the origin is a multiple of 8 near the
  // centre.
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_EQ(std::fmod(g.origin[k], 8.0), 0.0) << k;
  }
  const vtkIdType byPoint[] = { 0, 1, 2, 0, 2, 3 };
  const std::vector<glm::vec3> corners = hrt::meshes::cornersOf(g);
  ASSERT_EQ(corners.size(), 6u);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(g.origin + glm::dvec3(corners[i]), points[byPoint[i]]) << i;
    EXPECT_LE(glm::length(corners[i]), 3.0f * 8.0f);
  }
}

TEST_F(Triangles, CoordinatesNearZeroNeedNoOrigin)
{
  this->addMesh(makeMesh({ { 1, 1, 0 }, { 3, 1, 0 }, { 1, 3, 0 } }, { { 0, 1, 2 } }, VTK_FLOAT));
  EXPECT_EQ(this->onlyGeometry().origin, glm::dvec3(0.0));
}

// Double coordinates of a survey: metres in a national grid with tenths of a millimetre.
TEST_F(Triangles, LargeDoubleCoordinatesKeepTheirDetails)
{
  const std::vector<glm::dvec3> points = { { 500000.1234, 4649776.2203, 0.0001 },
    { 500001.0, 4649776.0001, 0.0 }, { 500000.5, 4649777.7777, 0.5 } };
  this->addMesh(makeMesh(points, { { 0, 1, 2 } }, VTK_DOUBLE));
  const hrt::Geometry& g = this->onlyGeometry();
  // Relative to the origin |x| <= 4, where a float's half step is 2^-22; the sum adds a half step
  // of the double at 4.6e6, 2^-31.
  const double tolerance = std::ldexp(1.0, -22) + std::ldexp(1.0, -31);
  for (int i = 0; i < 3; ++i)
  {
    const glm::dvec3 error =
      glm::abs(g.origin + glm::dvec3(g.cornerPositions(0)[i]) - points[i]);
    EXPECT_LE(glm::max(error.x, glm::max(error.y, error.z)), tolerance) << i;
  }
  EXPECT_LT(glm::length(this->snapshot->origin - points[0]), 4.0);
}

} // anonymous namespace
