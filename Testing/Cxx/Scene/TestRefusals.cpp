// Every kind of bad input: what is bad is counted and left out, the rest is kept, and the user is
// told once, by a message that names the actor, or the first of many.
#include "SceneTest.h"

#include <limits>

namespace
{

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

class Refusals : public SceneTest
{
protected:
  // Three frames of the same scene give one message.
  void expectOneWarning(vtkProp* about, const std::string& phrase)
  {
    for (int frame = 0; frame < 3; ++frame)
    {
      this->update();
    }
    ASSERT_EQ(this->messages.warnings.size(), 1u);
    EXPECT_NE(this->messages.warnings[0].find(addressOf(about)), std::string::npos);
    EXPECT_NE(this->messages.warnings[0].find(phrase), std::string::npos)
      << this->messages.warnings[0];
    EXPECT_TRUE(this->messages.errors.empty());
  }

  const std::vector<glm::dvec3> points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
};

TEST_F(Refusals, PointsThatAreNotFinite)
{
  for (double bad : { kNaN, kInfinity, -kInfinity })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      SCOPED_TRACE(bad);
      auto broken = this->points;
      broken[3][axis] = bad;
      this->renderer->RemoveAllViewProps();
      this->messages.warnings.clear();
      auto actor = this->addMesh(makeMesh(broken, { { 0, 1, 2 }, { 0, 2, 3 }, { 1, 2, 3 } }));
      const hrt::Geometry& g = this->onlyGeometry();
      EXPECT_EQ(g.cellIds, (hrt::CellIds{ 0 }));
      EXPECT_EQ(g.boundsMax, glm::vec3(1, 1, 0));
      EXPECT_EQ(this->snapshot->refusals.nonFinitePoints, 2u);
      EXPECT_EQ(this->snapshot->refusals.total(), 2u);
      this->expectOneWarning(actor, "2 triangles with points that are not finite");
      EXPECT_EQ(this->snapshot->refusals.nonFinitePoints, 2u) << "counted in every frame";
    }
  }
}

TEST_F(Refusals, ActorsWithPointsThatAreTooLargeAreLeftToVTKAsAWhole)
{
  for (double bad : { 1.9e18, -1.9e18, 1e300 })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      SCOPED_TRACE(bad);
      auto broken = this->points;
      broken[3][axis] = bad;
      this->renderer->RemoveAllViewProps();
      this->update(); // the next actor may come to live at the last one's address
      this->messages.errors.clear();
      auto actor = this->addMesh(makeMesh(broken, { { 0, 1, 2 }, { 0, 2, 3 } }));
      this->update();
      EXPECT_TRUE(this->snapshot->parts.empty());
      EXPECT_STREQ(this->scene->GetReasonLeftToVTK(actor),
        "its points or its bounds in the world are too large");
      EXPECT_EQ(this->snapshot->refusals.outOfRangeParts, 1u);
      EXPECT_EQ(this->snapshot->refusals.total(), 1u);
      EXPECT_TRUE(this->messages.warnings.empty());
      EXPECT_TRUE(this->messages.errors.empty()) << "VTK draws them without a word";
    }
  }
}

TEST_F(Refusals, CoordinatesUpToTheLimitAreKept)
{
  auto large = this->points;
  large[1].x = 1.844e18;
  this->addMesh(makeMesh(large, { { 0, 1, 3 } }));
  EXPECT_EQ(this->onlyGeometry().triangleCount(), 1u);
}

TEST_F(Refusals, BadPointsThatNoTriangleNamesDoNotMatter)
{
  auto broken = this->points;
  broken.emplace_back(kNaN, 0, 0);
  this->addMesh(makeMesh(broken, { { 0, 1, 2 } }));
  EXPECT_EQ(this->onlyGeometry().triangleCount(), 1u);
  EXPECT_EQ(this->snapshot->refusals.total(), 0u);
  EXPECT_TRUE(this->messages.warnings.empty());
}

TEST_F(Refusals, IndicesOutOfRange)
{
  auto actor =
    this->addMesh(makeMesh(this->points, { { 0, 1, 2 }, { 0, 2, 4 }, { -1, 2, 3 }, { 0, 2, 3 } }));
  EXPECT_EQ(this->onlyGeometry().cellIds, (hrt::CellIds{ 0, 3 }));
  EXPECT_EQ(this->snapshot->refusals.invalidIndices, 2u);
  EXPECT_EQ(this->snapshot->refusals.total(), 2u);
  this->expectOneWarning(actor, "2 triangles that name points that do not exist");
}

TEST_F(Refusals, APolygonIsRefusedAsAWhole)
{
  this->addMesh(makeMesh(this->points, { { 0, 1, 2, 3, 99 }, { 0, 1, 2 } }));
  EXPECT_EQ(this->onlyGeometry().cellIds, (hrt::CellIds{ 1 }));
  EXPECT_EQ(this->snapshot->refusals.invalidIndices, 3u) << "a pentagon is three triangles";
}

TEST_F(Refusals, AStripLosesOnlyTheTrianglesThatAreBroken)
{
  auto broken = this->points;
  broken.insert(broken.end(), { { 2, 0, 0 }, { kNaN, 0, 0 } });
  this->addMesh(makeMesh(broken, {}, VTK_DOUBLE, { { 0, 1, 3, 2, 4, 77 }, { 0, 1, 3, 5 } }));
  EXPECT_EQ(this->onlyGeometry().cellIds, (hrt::CellIds{ 0, 0, 0, 1 }));
  EXPECT_EQ(this->snapshot->refusals.invalidIndices, 1u);
  EXPECT_EQ(this->snapshot->refusals.nonFinitePoints, 1u);
}

TEST_F(Refusals, TrianglesWithoutArea)
{
  auto broken = this->points;
  broken.insert(broken.end(), { { 0.5, 0.5, 0 }, { 0, 0, 0 } });
  this->addMesh(makeMesh(broken,
    { { 0, 1, 1 },     // a point twice
      { 0, 1, 5 },     // two points in one place
      { 0, 4, 2 },     // three in a line
      { 0, 1, 2 } })); // good
  EXPECT_EQ(this->onlyGeometry().cellIds, (hrt::CellIds{ 3 }));
  EXPECT_EQ(this->snapshot->refusals.degenerateTriangles, 3u);
  EXPECT_EQ(this->snapshot->refusals.total(), 3u);
  EXPECT_TRUE(this->messages.warnings.empty()) << "VTK draws nothing of them and says nothing";
}

TEST_F(Refusals, SliversHaveAnArea)
{
  this->addMesh(makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1e-30, 0 } }, { { 0, 1, 2 } }));
  EXPECT_EQ(this->onlyGeometry().triangleCount(), 1u);
}

TEST_F(Refusals, AllKindsGiveOneMessageWithEveryCount)
{
  auto broken = this->points;
  broken[3].x = kNaN;
  auto actor =
    this->addMesh(makeMesh(broken, { { 0, 1, 2 }, { 0, 1, 9 }, { 0, 1, 3 }, { 0, 0, 1 } }));
  this->expectOneWarning(actor, "1 triangle with points that are not finite");
  EXPECT_NE(this->messages.warnings[0].find("1 triangle that name"), std::string::npos);
  EXPECT_EQ(this->messages.warnings[0].find("area"), std::string::npos);
  EXPECT_EQ(this->snapshot->refusals.total(), 3u);
  EXPECT_EQ(this->snapshot->triangleCount, 1u);
}

TEST_F(Refusals, AreToldAgainWhenTheDataChange)
{
  auto mesh = makeMesh(this->points, { { 0, 1, 2 }, { 0, 1, 8 } });
  this->addMesh(mesh);
  this->update();
  EXPECT_EQ(this->messages.warnings.size(), 1u);
  mesh->Modified(); // the same data once more
  this->update();
  EXPECT_EQ(this->messages.warnings.size(), 1u);
  mesh->SetPolys(makeCells({ { 0, 1, 2 }, { 0, 1, 8 }, { 1, 2, 9 } }));
  this->update();
  EXPECT_EQ(this->messages.warnings.size(), 2u);
  EXPECT_EQ(this->snapshot->refusals.invalidIndices, 2u);
}

TEST_F(Refusals, OneMessageSpeaksOfEachPart)
{
  auto good = this->addMesh(makeSquare());
  auto bad = this->addMesh(makeMesh(this->points, { { 0, 1, 2 }, { 0, 1, 7 } }));
  auto worse = this->addMesh(makeMesh(this->points, { { 0, 1, 2 }, { 0, 1, 8 }, { 0, 1, 9 } }));
  this->expectOneWarning(bad, addressOf(bad) + "): refused 1 triangle that name points that do not exist. ");
  const std::string& text = this->messages.warnings[0];
  EXPECT_NE(text.find(addressOf(worse) + "): refused 2 triangles that name"), std::string::npos);
  EXPECT_EQ(text.find(addressOf(good)), std::string::npos);
  EXPECT_EQ(text.find("more"), std::string::npos);
  EXPECT_EQ(this->snapshot->parts.size(), 3u);
  EXPECT_EQ(this->snapshot->refusals.invalidIndices, 3u);
}

TEST_F(Refusals, ManyBadPartsTakeOneLine)
{
  std::vector<vtkSmartPointer<vtkActor>> actors;
  for (int i = 0; i < 8; ++i)
  {
    actors.push_back(this->addMesh(makeMesh(this->points, { { 0, 1, 9 } })));
  }
  actors.push_back(this->addMesh(makeSquare()));
  actors.back()->SetScale(1, 1, 0);
  this->expectOneWarning(actors[0], ". And 6 more of the like");
  const std::string& text = this->messages.warnings[0];
  for (std::size_t i = 0; i < actors.size(); ++i)
  {
    EXPECT_EQ(text.find(addressOf(actors[i])) != std::string::npos, i < 3) << i;
  }
  EXPECT_EQ(this->snapshot->refusals.emptyParts, 8u);
  EXPECT_EQ(this->snapshot->refusals.singularMatrices, 1u);

  // What comes later is told by itself, although it is like what was told before.
  auto late = this->addMesh(makeMesh(this->points, { { 1, 2, 9 } }));
  this->update();
  ASSERT_EQ(this->messages.warnings.size(), 2u);
  EXPECT_NE(this->messages.warnings[1].find(addressOf(late)), std::string::npos);
  EXPECT_EQ(this->messages.warnings[1].find("more"), std::string::npos);
}

TEST_F(Refusals, PartsWithNothingLeftAreEmpty)
{
  auto actor = this->addMesh(makeMesh(this->points, { { 0, 0, 1 } }));
  auto good = this->addMesh(makeSquare());
  this->update();
  EXPECT_TRUE(this->messages.warnings.empty());
  ASSERT_EQ(this->snapshot->parts.size(), 1u);
  EXPECT_EQ(this->scene->GetProp(0), good.Get());
  EXPECT_EQ(this->snapshot->refusals.emptyParts, 1u);
  EXPECT_EQ(this->snapshot->refusals.degenerateTriangles, 1u);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(actor)) << "VTK has nothing better to draw";
}

TEST_F(Refusals, DataWithoutPointsOrCellsAreEmptyWithoutAMessage)
{
  vtkNew<vtkPolyData> nothing;
  this->addMesh(nothing);
  this->addMesh(makeMesh(this->points, {}));
  EXPECT_TRUE(this->update().parts.empty());
  EXPECT_EQ(this->snapshot->refusals.emptyParts, 2u);
  EXPECT_EQ(this->snapshot->refusals.total(), 2u);
  EXPECT_TRUE(this->messages.warnings.empty());
}

TEST_F(Refusals, CellsWithoutPointsAreRefused)
{
  vtkNew<vtkPolyData> mesh;
  mesh->SetPolys(makeCells({ { 0, 1, 2 } }));
  auto actor = this->addMesh(mesh);
  this->expectOneWarning(actor, "1 triangle that name points that do not exist");
  EXPECT_EQ(this->snapshot->refusals.invalidIndices, 1u);
  EXPECT_EQ(this->snapshot->refusals.emptyParts, 1u);
}

TEST_F(Refusals, AMapperWithoutInput)
{
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  this->renderer->AddActor(actor);
  this->addMesh(makeSquare());
  this->expectOneWarning(actor, "no input");
  EXPECT_EQ(this->snapshot->refusals.emptyParts, 1u);
  EXPECT_EQ(this->snapshot->parts.size(), 1u);
}

TEST_F(Refusals, MatricesThatCannotBeUsed)
{
  for (double z : { 0.0, kNaN, kInfinity })
  {
    SCOPED_TRACE(z);
    this->renderer->RemoveAllViewProps();
    this->update(); // the next actor may come to live at the last one's address
    this->messages.warnings.clear();
    auto actor = this->addMesh(makeSquare());
    auto good = this->addMesh(makeSquare());
    actor->SetScale(1, 1, z);
    this->expectOneWarning(actor, "matrix");
    EXPECT_EQ(this->snapshot->refusals.singularMatrices, 1u);
    EXPECT_EQ(this->snapshot->refusals.total(), 1u);
    ASSERT_EQ(this->snapshot->parts.size(), 1u);
    EXPECT_EQ(this->scene->GetProp(0), good.Get());
    EXPECT_FALSE(this->scene->IsDrawnByTracer(actor));
  }
}

TEST_F(Refusals, AMatrixThatRecoversIsUsedAndWarnedAboutAgain)
{
  auto actor = this->addMesh(makeSquare());
  actor->SetScale(1, 0, 1);
  this->update();
  EXPECT_EQ(this->messages.warnings.size(), 1u);
  actor->SetScale(1, 1, 1);
  EXPECT_EQ(this->update().parts.size(), 1u);
  actor->SetScale(1, 0, 1);
  this->update();
  EXPECT_EQ(this->messages.warnings.size(), 2u);
}

TEST_F(Refusals, PartsThatTheirMatrixCarriesOutOfRange)
{
  const double beyond[][4] = { // translation, scale
    { 1.9e18, 0, 0, 1 }, { 0, -1.9e18, 0, 1 }, { 0, 0, 0, 1.9e18 }, { 0, 0, 1.8e18, 1e17 } };
  for (const auto& by : beyond)
  {
    SCOPED_TRACE(by[3]);
    this->renderer->RemoveAllViewProps();
    this->update(); // the next actor may come to live at the last one's address
    this->messages.errors.clear();
    auto far = this->addMesh(makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 1 } }, { { 0, 1, 2 } }));
    far->SetPosition(by[0], by[1], by[2]);
    far->SetScale(by[3]);
    auto good = this->addMesh(makeSquare());
    for (int frame = 0; frame < 3; ++frame)
    {
      this->update();
    }
    EXPECT_TRUE(this->messages.warnings.empty());
    EXPECT_TRUE(this->messages.errors.empty()) << "VTK draws them without a word";
    EXPECT_EQ(this->snapshot->refusals.outOfRangeParts, 1u);
    EXPECT_EQ(this->snapshot->refusals.total(), 1u);
    ASSERT_EQ(this->snapshot->parts.size(), 1u);
    EXPECT_EQ(this->scene->GetProp(0), good.Get());
    EXPECT_EQ(this->snapshot->boundsMax, glm::dvec3(1, 1, 0)) << "the scene's box is that of the rest";
    EXPECT_FALSE(this->scene->IsDrawnByTracer(far));
    EXPECT_STRNE(this->scene->GetReasonLeftToVTK(far), "");
  }
}

TEST_F(Refusals, PartsUpToTheLimitAreKeptAndCountedWhileTheyAreNot)
{
  auto actor = this->addMesh(makeSquare());
  actor->SetScale(1.84e18);
  EXPECT_EQ(this->update().parts.size(), 1u);
  EXPECT_TRUE(this->messages.errors.empty());
  const hrt::Geometry* const before = this->snapshot->parts[0].geometry.get();
  actor->SetScale(1.85e18);
  EXPECT_TRUE(this->update().parts.empty());
  EXPECT_EQ(this->snapshot->refusals.outOfRangeParts, 1u);
  actor->SetScale(1.0);
  ASSERT_EQ(this->update().parts.size(), 1u);
  EXPECT_EQ(this->snapshot->parts[0].geometry.get(), before) << "not extracted again";
  EXPECT_EQ(this->snapshot->refusals.outOfRangeParts, 0u);
  actor->SetScale(1.85e18);
  this->update();
  EXPECT_EQ(this->snapshot->refusals.outOfRangeParts, 1u);
}

} // anonymous namespace
