// Each kind of change sets its own flag and no other, and touches no geometry that is unchanged.
#include "SceneTest.h"

#include "vtkDoubleArray.h"
#include "vtkHybridMaterial.h"
#include "vtkLookupTable.h"
#include "vtkPointData.h"
#include "vtkProperty.h"

#include <set>
#include <utility>

namespace
{

class Changes : public SceneTest
{
protected:
  Changes()
    : first(this->addMesh(makeSquare()))
    , second(this->addMesh(
        makeMesh({ { -3, -3, 0 }, { 3, -3, 0 }, { 3, 3, 2 }, { -3, 3, 2 } }, { { 0, 1, 2, 3 } })))
  {
    for (auto& light : this->lights)
    {
      light->SetPosition(1, 2, 3);
      this->renderer->AddLight(light);
    }
    this->update();
  }

  // The names of the flags that the last update set.
  std::set<std::string> flags() const
  {
    const hrt::Changes& c = this->scene->GetChanges();
    std::set<std::string> names;
    const std::pair<bool, const char*> all[] = { { c.first, "first" }, { c.camera, "camera" },
      { c.geometry, "geometry" }, { c.transforms, "transforms" }, { c.materials, "materials" },
      { c.lightColors, "lightColors" }, { c.background, "background" },
      { c.lightCount, "lightCount" } };
    for (const auto& flag : all)
    {
      if (flag.first)
      {
        names.insert(flag.second);
      }
    }
    for (std::size_t i = 0; i < c.lightMoved.size(); ++i)
    {
      if (c.lightMoved[i])
      {
        names.insert("light " + std::to_string(i));
      }
    }
    return names;
  }

  // Updates; expects the flags, and every geometry to be the very same object as before.
  void expectOnly(const std::set<std::string>& expected)
  {
    const auto before = this->snapshot;
    this->update();
    EXPECT_EQ(this->flags(), expected);
    ASSERT_EQ(this->snapshot->parts.size(), before->parts.size());
    for (std::size_t i = 0; i < before->parts.size(); ++i)
    {
      EXPECT_EQ(this->snapshot->parts[i].geometry, before->parts[i].geometry) << i;
      EXPECT_EQ(this->snapshot->parts[i].key, before->parts[i].key) << i;
    }
    this->expectQuiet();
  }

  // The frame after a change is a still one.
  void expectQuiet()
  {
    this->update();
    EXPECT_EQ(this->flags(), std::set<std::string>());
    EXPECT_FALSE(this->scene->GetChanges().any());
  }

  vtkSmartPointer<vtkActor> first;
  vtkSmartPointer<vtkActor> second;
  vtkNew<vtkLight> lights[2];
};

TEST_F(Changes, CountAllTheFirstTime)
{
  EXPECT_EQ(this->flags(),
    (std::set<std::string>{ "first", "camera", "geometry", "transforms", "materials", "lightColors",
      "background", "lightCount", "light 0", "light 1" }));
}

TEST_F(Changes, AreNoneInAStillScene)
{
  this->expectQuiet();
}

TEST_F(Changes, CountAllForAnotherRenderer)
{
  vtkNew<vtkRenderer> other;
  this->scene->Update(other);
  EXPECT_TRUE(this->scene->GetChanges().first);
  this->update();
  EXPECT_TRUE(this->scene->GetChanges().first);
  this->expectQuiet();
}

TEST_F(Changes, OfTheCamera)
{
  this->renderer->GetActiveCamera()->SetPosition(1, 2, 9);
  this->expectOnly({ "camera" });
  this->window->SetSize(200, 200);
  this->expectOnly({ "camera" });
}

TEST_F(Changes, OfAMatrix)
{
  this->first->SetPosition(0.5, 0, 0); // inside the box of the second, so that no origin moves
  this->expectOnly({ "transforms" });
}

TEST_F(Changes, ThatOnlyTouchAreNone)
{
  this->first->Modified();
  this->first->SetPosition(0, 0, 0);
  this->first->GetProperty()->Modified();
  this->first->GetMapper()->Modified();
  this->first->GetMapper()->GetInputDataObject(0, 0)->Modified();
  this->lights[0]->Modified();
  this->expectOnly({});
}

TEST_F(Changes, OfAMaterial)
{
  this->first->GetProperty()->SetColor(1, 0, 0);
  this->expectOnly({ "materials" });
  this->second->GetProperty()->SetSpecularPower(20);
  this->expectOnly({ "materials" });
  vtkHybridMaterial::SetReflectance(this->second, 0.5);
  this->expectOnly({ "materials" });
}

TEST_F(Changes, OfALight)
{
  this->lights[1]->SetPosition(3, 2, 1);
  this->expectOnly({ "light 1" });
  this->lights[0]->SetIntensity(0.5);
  this->expectOnly({ "lightColors" });
  this->lights[0]->SwitchOff();
  this->expectOnly({ "lightCount" });
}

TEST_F(Changes, OfTheBackground)
{
  this->renderer->SetBackground(0, 0, 1);
  this->expectOnly({ "background" });
}

TEST_F(Changes, OfPointsReplaceOneGeometry)
{
  const auto before = this->snapshot;
  auto* mesh = vtkPolyData::SafeDownCast(this->first->GetMapper()->GetInputDataObject(0, 0));
  mesh->GetPoints()->SetPoint(1, 1.5, 0, 0);
  mesh->GetPoints()->Modified();
  this->update();
  EXPECT_EQ(this->flags(), std::set<std::string>{ "geometry" });
  EXPECT_NE(this->snapshot->parts[0].geometry, before->parts[0].geometry);
  EXPECT_NE(this->snapshot->parts[0].geometry->version, before->parts[0].geometry->version);
  EXPECT_EQ(this->snapshot->parts[0].geometry->cornerPositions(0)[1], glm::vec3(1.5f, 0, 0));
  EXPECT_EQ(before->parts[0].geometry->cornerPositions(0)[1], glm::vec3(1, 0, 0)) << "the old one is kept";
  EXPECT_EQ(this->snapshot->parts[1].geometry, before->parts[1].geometry);
  this->expectQuiet();
}

TEST_F(Changes, OfInterpolationMatterWhereNormalsAre)
{
  this->first->GetProperty()->SetInterpolationToFlat(); // no normals: nothing differs
  this->expectOnly({});
  auto* mesh = vtkPolyData::SafeDownCast(this->first->GetMapper()->GetInputDataObject(0, 0));
  vtkNew<vtkDoubleArray> normals;
  normals->SetNumberOfComponents(3);
  for (int i = 0; i < 4; ++i)
  {
    normals->InsertNextTuple3(0, 0.6, 0.8);
  }
  mesh->GetPointData()->SetNormals(normals);
  this->expectOnly({});
  this->first->GetProperty()->SetInterpolationToGouraud();
  this->update();
  EXPECT_EQ(this->flags(), std::set<std::string>{ "geometry" });
  this->expectQuiet();
}

TEST_F(Changes, OfVisibilityKeepTheGeometryForLater)
{
  const auto before = this->snapshot;
  this->first->VisibilityOff();
  this->update();
  EXPECT_TRUE(this->flags().count("geometry"));
  ASSERT_EQ(this->snapshot->parts.size(), 1u);
  EXPECT_EQ(this->snapshot->parts[0].geometry, before->parts[1].geometry);
  EXPECT_EQ(this->snapshot->parts[0].firstTriangle, 0u);
  this->update();
  this->first->VisibilityOn();
  this->update();
  ASSERT_EQ(this->snapshot->parts.size(), 2u);
  EXPECT_EQ(this->snapshot->parts[0].geometry, before->parts[0].geometry);
}

TEST_F(Changes, OfThePartsSetGeometry)
{
  auto third = this->addMesh(makeSquare());
  this->update();
  EXPECT_EQ(this->flags(), std::set<std::string>{ "geometry" });
  this->renderer->RemoveActor(third);
  this->update();
  EXPECT_EQ(this->flags(), std::set<std::string>{ "geometry" });
  this->expectQuiet();
}

// A table with an alpha of its own is modified by VTK each time that scalars are mapped.
TEST_F(Changes, AreNoneForATableThatVTKTouchesEachFrame)
{
  auto* mesh = vtkPolyData::SafeDownCast(this->first->GetMapper()->GetInputDataObject(0, 0));
  vtkNew<vtkDoubleArray> scalars;
  for (double v : { 0.0, 0.25, 0.5, 1.0 })
  {
    scalars->InsertNextValue(v);
  }
  mesh->GetPointData()->SetScalars(scalars);
  vtkNew<vtkLookupTable> table;
  table->SetAlpha(0.5);
  this->first->GetMapper()->SetLookupTable(table);
  this->update();
  this->update();
  const auto before = this->snapshot;
  table->Modified();
  this->update();
  EXPECT_EQ(this->flags(), std::set<std::string>());
  EXPECT_EQ(this->snapshot->parts[0].geometry, before->parts[0].geometry);
}

TEST_F(Changes, ActorsThatShareAMapperShareTheGeometry)
{
  vtkNew<vtkActor> twin;
  twin->SetMapper(this->first->GetMapper());
  this->renderer->AddActor(twin);
  this->update();
  EXPECT_EQ(this->snapshot->parts.at(2).geometry, this->snapshot->parts[0].geometry);
  auto* mesh = vtkPolyData::SafeDownCast(this->first->GetMapper()->GetInputDataObject(0, 0));
  mesh->GetPoints()->SetPoint(1, 1.5, 0, 0);
  mesh->GetPoints()->Modified();
  this->update();
  EXPECT_EQ(this->snapshot->parts[2].geometry, this->snapshot->parts[0].geometry);
  EXPECT_EQ(this->snapshot->parts[2].geometry->cornerPositions(0)[1], glm::vec3(1.5f, 0, 0));
}

TEST_F(Changes, TheOldSnapshotOutlivesTheScene)
{
  const auto kept = this->snapshot;
  this->renderer->RemoveAllViewProps();
  EXPECT_TRUE(this->update().empty());
  EXPECT_EQ(this->snapshot->origin, glm::dvec3(0.0));
  EXPECT_GT(this->snapshot->boundsMin.x, this->snapshot->boundsMax.x);
  EXPECT_EQ(kept->parts.size(), 2u);
}

TEST_F(Changes, TheOriginIsTheMiddleOfTheBox)
{
  EXPECT_EQ(this->snapshot->boundsMin, glm::dvec3(-3, -3, 0));
  EXPECT_EQ(this->snapshot->boundsMax, glm::dvec3(3, 3, 2));
  EXPECT_EQ(this->snapshot->origin, glm::dvec3(0, 0, 1));
}

TEST_F(Changes, AMissingRendererIsAnErrorAndKeepsTheSnapshot)
{
  const auto before = this->snapshot;
  this->scene->Update(nullptr);
  EXPECT_EQ(this->messages.errors.size(), 1u);
  EXPECT_EQ(this->scene->GetSnapshot(), before);
}

TEST(Scene, IsEmptyBeforeTheFirstUpdate)
{
  vtkNew<vtkHybridScene> scene;
  ASSERT_NE(scene->GetSnapshot(), nullptr);
  EXPECT_TRUE(scene->GetSnapshot()->empty());
  EXPECT_TRUE(scene->GetChanges().any());
  EXPECT_EQ(scene->GetProp(0), nullptr);
}

} // anonymous namespace
