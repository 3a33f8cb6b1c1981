// The importer's VTK objects: matrices against hand-composed ones, materials, textures, lights,
// camera, and what SetTime touches and what it does not.
#include "BARTTest.h"

#include "vtkHybridBARTImporter.h"
#include "vtkHybridMaterial.h"

#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMapper.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkTexture.h"
#include "vtkTransform.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace
{

// Where the actors of everything.aff stand in the collection.
enum
{
  kSphere = 0,
  kCone = 1,
  kHollowSphere = 2,
  kPolygons = 3,
  kTexturedTriangle = 5,
  kAnimatedTriangle = 7,
  kSquare = 8,
  kMovedSquare = 10,
  kStillSquare = 12,
  kActors = 14
};

class Importer : public ::testing::Test
{
protected:
  Importer()
  {
    this->Ear->SetClientData(this);
    this->Ear->SetCallback([](vtkObject*, unsigned long, void* self, void* text)
      { static_cast<Importer*>(self)->Errors.emplace_back(static_cast<const char*>(text)); });
    this->Reader->AddObserver(vtkCommand::ErrorEvent, this->Ear);
  }

  ~Importer() override
  {
    for (const std::string& file : this->Written)
    {
      std::remove(file.c_str());
    }
  }

  bool read(const std::string& path)
  {
    this->Reader->SetFileName(path.c_str());
    return this->Reader->Read();
  }

  // Reads a scene from a text.
  bool readText(const std::string& text)
  {
    // ctest runs tests beside each other.
    const std::string path = ::testing::TempDir() + "hrt_" +
      ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".aff";
    std::ofstream(path, std::ios::binary) << text;
    this->Written.push_back(path);
    return this->read(path);
  }

  vtkActor* actor(int i) const
  {
    return vtkActor::SafeDownCast(this->Reader->GetActors()->GetItemAsObject(i));
  }

  vtkPolyData* surface(int i) const
  {
    return vtkPolyData::SafeDownCast(this->actor(i)->GetMapper()->GetInput());
  }

  vtkNew<vtkHybridBARTImporter> Reader;
  vtkNew<vtkCallbackCommand> Ear;
  std::vector<std::string> Errors;
  std::vector<std::string> Written;
};

const char* const kEverything = HRT_TEST_DATA "/everything.aff";

void expectMatrix(vtkMatrix4x4* actual, vtkMatrix4x4* expected)
{
  for (int i = 0; i < 16; ++i)
  {
    EXPECT_NEAR(actual->GetData()[i], expected->GetData()[i], 1e-12) << "element " << i;
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
TEST_F(Importer, IsEmptyBeforeItReads)
{
  EXPECT_EQ(this->Reader->GetActors()->GetNumberOfItems(), 0);
  EXPECT_EQ(this->Reader->GetLights()->GetNumberOfItems(), 0);
  EXPECT_EQ(this->Reader->GetCamera(), nullptr);
  EXPECT_EQ(this->Reader->GetNumberOfFrames(), 0);
  EXPECT_TRUE(this->Reader->GetTextures());
}

TEST_F(Importer, ReportsItsFigures)
{
  ASSERT_TRUE(this->read(kEverything));
  EXPECT_EQ(this->Reader->GetActors()->GetNumberOfItems(), kActors);
  EXPECT_EQ(this->Reader->GetNumberOfFrames(), 101);
  EXPECT_EQ(this->Reader->GetTimeRange()[1], 10.0);
  EXPECT_EQ(this->Reader->GetFrameTime(0), 0.0);
  EXPECT_DOUBLE_EQ(this->Reader->GetFrameTime(25), 2.5);
  EXPECT_EQ(this->Reader->GetFrameTime(1000), 10.0);
  EXPECT_EQ(this->Reader->GetFrameTime(-1), 0.0);
  EXPECT_EQ(this->Reader->GetResolution()[0], 320);
  EXPECT_EQ(this->Reader->GetNumberOfAnimatedTransforms(), 2);
  EXPECT_EQ(this->Reader->GetNumberOfKeyedTransforms(), 1);
  EXPECT_EQ(this->Reader->GetNumberOfTexturedTriangles(), 8);
  // The file's own 16, two spheres of 30 bands between two caps, a truncated cone.
  EXPECT_EQ(this->Reader->GetNumberOfTriangles(), 16 + 2 * (30 * 128 + 2 * 64) + 128);
}

TEST_F(Importer, ComposesTheHierarchysMatricesAtAnyTime)
{
  ASSERT_TRUE(this->read(kEverything));
  for (double time : { 0.0, 2.0, 5.0, 7.5, 10.0 })
  {
    this->Reader->SetTime(time);
    // Keys of the mover: straight lines in time for place and angle; tension 1 makes the scale a
    // smooth step from 1 to 2.
    const double u = time / 10.0;
    vtkNew<vtkTransform> expected;
    expected->Translate(time, 0.0, 0.0);
    expected->RotateY(9.0 * time);
    expected->Scale(1.0 + u * u * (3.0 - 2.0 * u), 1.0, 1.0);
    expected->Translate(1.0, 2.0, 3.0);
    expected->RotateZ(90.0);
    expected->Scale(2.0, 2.0, 2.0);
    expectMatrix(this->actor(kMovedSquare)->GetMatrix(), expected->GetMatrix());
    expectMatrix(this->actor(kMovedSquare + 1)->GetMatrix(), expected->GetMatrix());
    vtkNew<vtkMatrix4x4> identity;
    expectMatrix(this->actor(kSquare)->GetMatrix(), identity);
    expectMatrix(this->actor(kStillSquare)->GetMatrix(), identity);
    EXPECT_EQ(this->Reader->GetTime(), time);
  }
}

TEST_F(Importer, MovesMatricesAndNeverMeshes)
{
  ASSERT_TRUE(this->read(kEverything));
  std::vector<vtkMTimeType> meshes, actors;
  for (int i = 0; i < kActors; ++i)
  {
    meshes.push_back(this->surface(i)->GetMTime());
    actors.push_back(this->actor(i)->GetMTime());
  }
  this->Reader->SetTime(4.0);
  for (int i = 0; i < kActors; ++i)
  {
    EXPECT_EQ(
      this->surface(i)->GetMTime() != meshes[static_cast<std::size_t>(i)], i == kAnimatedTriangle)
      << i;
    EXPECT_EQ(this->actor(i)->GetMTime() != actors[static_cast<std::size_t>(i)],
      i == kMovedSquare || i == kMovedSquare + 1)
      << i;
  }
}

TEST_F(Importer, SwitchesVisibilityByItsKeys)
{
  ASSERT_TRUE(this->read(kEverything));
  this->Reader->SetTime(8.5);
  EXPECT_FALSE(this->actor(kMovedSquare)->GetVisibility());
  EXPECT_TRUE(this->actor(kStillSquare)->GetVisibility());
  this->Reader->SetTime(9.0);
  EXPECT_TRUE(this->actor(kMovedSquare)->GetVisibility());
}

TEST_F(Importer, MovesAnimatedTriangles)
{
  ASSERT_TRUE(this->read(kEverything));
  this->Reader->SetTime(5.0);
  double p[3];
  this->surface(kAnimatedTriangle)->GetPoint(1, p);
  EXPECT_EQ(p[0], 1.0);
  EXPECT_EQ(p[2], 6.0);
  EXPECT_EQ(
    this->surface(kAnimatedTriangle)->GetPointData()->GetNormals()->GetComponent(1, 1), 0.5);
}

TEST_F(Importer, MovesLightsAndCamera)
{
  ASSERT_TRUE(this->read(kEverything));
  this->Reader->SetTime(10.0);
  auto* lamp = vtkLight::SafeDownCast(this->Reader->GetLights()->GetItemAsObject(2));
  EXPECT_DOUBLE_EQ(lamp->GetPosition()[0], 10.0);
  EXPECT_TRUE(lamp->LightTypeIsSceneLight());
  EXPECT_TRUE(lamp->GetPositional());
  EXPECT_GE(lamp->GetConeAngle(), 90.0);
  auto* colored = vtkLight::SafeDownCast(this->Reader->GetLights()->GetItemAsObject(1));
  EXPECT_EQ(colored->GetDiffuseColor()[2], 0.125);

  vtkCamera* camera = this->Reader->GetCamera();
  ASSERT_NE(camera, nullptr);
  EXPECT_DOUBLE_EQ(camera->GetPosition()[0], 10.0);
  EXPECT_NEAR(camera->GetDirectionOfProjection()[0], -1.0, 1e-12);
  EXPECT_EQ(camera->GetViewAngle(), 40.0);
  EXPECT_EQ(camera->GetClippingRange()[0], 0.5);
  EXPECT_GT(camera->GetClippingRange()[1], 10.0);
}

TEST_F(Importer, MapsMaterials)
{
  ASSERT_TRUE(this->read(kEverything));
  vtkActor* sphere = this->actor(kSphere);
  vtkProperty* property = sphere->GetProperty();
  EXPECT_EQ(property, this->actor(kCone)->GetProperty()) << "one material, one property";
  EXPECT_NEAR(property->GetAmbientColor()[2], 0.3, 1e-15) << "times the ambient light";
  EXPECT_EQ(property->GetDiffuseColor()[1], 0.2);
  EXPECT_EQ(property->GetSpecularColor()[2], 0.9);
  EXPECT_EQ(property->GetSpecularPower(), 25.0);
  EXPECT_EQ(property->GetOpacity(), 1.0);
  EXPECT_NEAR(vtkHybridMaterial::GetReflectance(sphere), 0.6, 1e-15);
  EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(sphere), 0.0);

  vtkActor* glass = this->actor(kPolygons);
  EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(glass), 1.5);
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(glass), 0.0);
  EXPECT_NEAR(glass->GetProperty()->GetOpacity(), 0.1, 1e-15);
}

TEST_F(Importer, APaneThatBendsNoLightIsPlainTransparency)
{
  ASSERT_TRUE(this->readText("fm 1 1 1 1 1 1 5 5 5 1 0.25 0 s 0 0 0 1"));
  EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(this->actor(0)), 0.0);
  EXPECT_EQ(this->actor(0)->GetProperty()->GetOpacity(), 0.75);
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(this->actor(0)), 0.0) << "VTK draws it";
  EXPECT_TRUE(this->Errors.empty());
}

TEST_F(Importer, ReflectanceIsAtMostOne)
{
  ASSERT_TRUE(this->readText("fm 1 1 1 1 1 1 5 5 5 1 0 0 s 0 0 0 1"));
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(this->actor(0)), 1.0);
  EXPECT_TRUE(this->Errors.empty());
}

TEST_F(Importer, TexturesAreUprightAndShared)
{
  ASSERT_TRUE(this->read(kEverything));
  vtkTexture* texture = this->actor(kSquare)->GetTexture();
  ASSERT_NE(texture, nullptr);
  EXPECT_EQ(texture, this->actor(kTexturedTriangle)->GetTexture());
  EXPECT_EQ(this->actor(kSquare + 1)->GetTexture(), nullptr);
  EXPECT_TRUE(texture->GetRepeat());
  // AFF's (0, 0) is the image's upper left texel, which is red; VTK's is the lower left one.
  auto* coordinates = this->surface(kSquare)->GetPointData()->GetTCoords();
  EXPECT_EQ(coordinates->GetComponent(0, 0), 0.0);
  EXPECT_EQ(coordinates->GetComponent(0, 1), 1.0);
  vtkImageData* image = texture->GetInput();
  EXPECT_EQ(image->GetScalarComponentAsDouble(0, 1, 0, 0), 255.0);
  EXPECT_EQ(image->GetScalarComponentAsDouble(0, 1, 0, 1), 0.0);
  EXPECT_EQ(image->GetScalarComponentAsDouble(0, 0, 0, 2), 255.0);
}

TEST_F(Importer, WithoutTexturesNoneIsNeeded)
{
  const std::string text = "tt absent.ppm 0 0 0 0 0  1 0 0 1 0  0 1 0 0 1";
  EXPECT_FALSE(this->readText(text));
  ASSERT_EQ(this->Errors.size(), 1u);
  EXPECT_NE(this->Errors[0].find(".aff:1: expected the texture 'absent.ppm' beside this file"),
    std::string::npos)
    << this->Errors[0];
  this->Reader->TexturesOff();
  EXPECT_TRUE(this->readText(text));
  EXPECT_EQ(this->actor(0)->GetTexture(), nullptr);
  EXPECT_EQ(this->Reader->GetNumberOfTexturedTriangles(), 1) << "what the file says";
}

TEST_F(Importer, ATextureThatIsNoImageIsAnError)
{
  // The scene's own file is there, but is no image.
  EXPECT_FALSE(
    this->readText("\ntt hrt_ATextureThatIsNoImageIsAnError.aff 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1"));
  ASSERT_EQ(this->Errors.size(), 1u);
  EXPECT_NE(this->Errors[0].find("aff:2: the texture "), std::string::npos) << this->Errors[0];
  EXPECT_NE(this->Errors[0].find("is not a right PPM image"), std::string::npos);
}

TEST_F(Importer, AnErrorLeavesNothing)
{
  ASSERT_TRUE(this->read(kEverything));
  EXPECT_FALSE(this->readText("s 0 0 0 1\ns 0 0 0"));
  ASSERT_EQ(this->Errors.size(), 1u);
  EXPECT_NE(this->Errors[0].find(".aff:2: expected the sphere's radius"), std::string::npos)
    << this->Errors[0];
  EXPECT_EQ(this->Reader->GetActors()->GetNumberOfItems(), 0);
  EXPECT_EQ(this->Reader->GetNumberOfFrames(), 0);
  EXPECT_EQ(this->Reader->GetNumberOfTriangles(), 0);
  EXPECT_EQ(this->Reader->GetCamera(), nullptr);
  this->Reader->SetTime(3.0); // nothing to move, no harm
}

TEST_F(Importer, NeedsAFileName)
{
  EXPECT_FALSE(this->Reader->Read());
  ASSERT_EQ(this->Errors.size(), 1u);
  EXPECT_NE(this->Errors[0].find("SetFileName"), std::string::npos);
}

TEST_F(Importer, RefusesATimeThatIsNotFinite)
{
  ASSERT_TRUE(this->read(kEverything));
  this->Reader->SetTime(2.0);
  for (double bad : { std::nan(""), std::numeric_limits<double>::infinity() })
  {
    this->Reader->SetTime(bad);
    EXPECT_EQ(this->Reader->GetTime(), 2.0);
  }
  EXPECT_EQ(this->Errors.size(), 2u);
}

TEST_F(Importer, FillsARenderer)
{
  ASSERT_TRUE(this->read(kEverything));
  vtkNew<vtkRenderer> renderer;
  this->Reader->AddTo(renderer);
  EXPECT_EQ(renderer->GetActors()->GetNumberOfItems(), kActors);
  EXPECT_EQ(renderer->GetLights()->GetNumberOfItems(), 3);
  EXPECT_EQ(renderer->GetActiveCamera(), this->Reader->GetCamera());
  EXPECT_EQ(renderer->GetBackground()[1], 0.2);
  this->Reader->AddTo(nullptr);
  EXPECT_EQ(this->Errors.size(), 1u);
}

TEST_F(Importer, WithoutAViewpointShowsEverything)
{
  ASSERT_TRUE(this->readText("s 100 0 0 1"));
  EXPECT_EQ(this->Reader->GetCamera(), nullptr);
  vtkNew<vtkRenderer> renderer;
  this->Reader->AddTo(renderer);
  EXPECT_NEAR(renderer->GetActiveCamera()->GetFocalPoint()[0], 100.0, 1e-3);
}

TEST_F(Importer, RoundShapesAreOnTheirSurfaceAndTurnedOutward)
{
  ASSERT_TRUE(this->read(kEverything));
  for (int which : { kSphere, kHollowSphere })
  {
    const glm::dvec3 center(which == kSphere ? 0.0 : 3.0, 0.0, 0.0);
    const double side = which == kSphere ? 1.0 : -1.0;
    vtkPolyData* surface = this->surface(which);
    for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
    {
      vtkIdType size;
      const vtkIdType* points;
      surface->GetCellPoints(cell, size, points);
      ASSERT_EQ(size, 3);
      glm::dvec3 p[3], n;
      for (int i = 0; i < 3; ++i)
      {
        surface->GetPoint(points[i], &p[i].x);
        EXPECT_NEAR(glm::length(p[i] - center), 1.0, 1e-6);
        surface->GetPointData()->GetNormals()->GetTuple(points[i], &n.x);
        expectNear(n, side * (p[i] - center), 1e-6);
      }
      const glm::dvec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
      EXPECT_GT(side * glm::dot(face, p[0] + p[1] + p[2] - 3.0 * center), 0.0) << cell;
    }
  }
}

TEST_F(Importer, ConesMayEndInATipOrLookInward)
{
  ASSERT_TRUE(this->readText("c 0 0 0 1  0 0 2 0  c 0 0 0 0  0 0 2 1  c 0 0 0 -1  0 0 2 -1"));
  const vtkIdType triangles[] = { 64, 64, 128 };
  for (int i = 0; i < 3; ++i)
  {
    vtkPolyData* surface = this->surface(i);
    EXPECT_EQ(surface->GetNumberOfCells(), triangles[i]);
    const double side = i == 2 ? -1.0 : 1.0;
    for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
    {
      vtkIdType size;
      const vtkIdType* points;
      surface->GetCellPoints(cell, size, points);
      glm::dvec3 p[3], n;
      for (int k = 0; k < 3; ++k)
      {
        surface->GetPoint(points[k], &p[k].x);
      }
      surface->GetPointData()->GetNormals()->GetTuple(points[0], &n.x);
      const glm::dvec3 face = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
      const glm::dvec3 middle = (p[0] + p[1] + p[2]) / 3.0;
      EXPECT_GT(side * glm::dot(face, glm::dvec3(middle.x, middle.y, 0.0)), 0.0);
      EXPECT_GT(glm::dot(face, n), 0.9);
      EXPECT_NEAR(glm::length(n), 1.0, 1e-6);
    }
  }
}

TEST_F(Importer, AFormerScenesActorsAreLeftToTheirHolders)
{
  ASSERT_TRUE(this->read(kEverything));
  vtkSmartPointer<vtkActor> old = this->actor(kMovedSquare);
  ASSERT_TRUE(this->read(kEverything));
  this->Reader->SetTime(5.0);
  EXPECT_EQ(old->GetMatrix()->GetElement(0, 3), 1.0) << "as it was at time 0";
  EXPECT_NE(this->actor(kMovedSquare), old.Get());
}

TEST_F(Importer, PrintsItself)
{
  ASSERT_TRUE(this->read(kEverything));
  std::ostringstream text;
  this->Reader->Print(text);
  EXPECT_NE(text.str().find("NumberOfAnimatedTransforms: 2, 1 with keys"), std::string::npos);
}
