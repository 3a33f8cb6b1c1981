// Every kind of light, in world coordinates.
#include "SceneTest.h"

#include "vtkMatrix4x4.h"
#include "vtkTransform.h"

#include <cmath>
#include <limits>

namespace
{

// Normalising a direction: a dot product of three, a root and a division, each rounded once.
const double kUnitTolerance = std::ldexp(8.0, -53);

class Lights : public SceneTest
{
protected:
  Lights()
  {
    vtkCamera* camera = this->renderer->GetActiveCamera();
    camera->SetPosition(3, 4, 12);
    camera->SetFocalPoint(3, 4, 2);
    camera->SetViewUp(0, 1, 0);
  }

  vtkSmartPointer<vtkLight> addLight()
  {
    auto light = vtkSmartPointer<vtkLight>::New();
    this->renderer->AddLight(light);
    return light;
  }

  static void expectNear(
    const glm::dvec3& a, const glm::dvec3& b, double tolerance = kUnitTolerance)
  {
    EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
  }
};

TEST_F(Lights, MayBeMissing)
{
  const hrt::Snapshot& s = this->update();
  EXPECT_TRUE(s.lights.empty());
  EXPECT_FALSE(s.singleHeadlight);
}

TEST_F(Lights, ThatAreDirectional)
{
  auto light = this->addLight();
  light->SetPosition(1, 2, 5);
  light->SetFocalPoint(1, -1, 1);
  light->SetDiffuseColor(0.5, 0.25, 1.0);
  light->SetSpecularColor(0, 0, 0); // VTK's shaders use the diffuse colour only
  light->SetIntensity(0.5);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.lights.size(), 1u);
  const hrt::Light& l = s.lights[0];
  EXPECT_EQ(l.kind, hrt::Light::Kind::Directional);
  EXPECT_FALSE(l.isHeadlight);
  EXPECT_FALSE(l.isSpot());
  EXPECT_FALSE(s.singleHeadlight);
  EXPECT_EQ(l.position, glm::dvec3(1, 2, 5));
  expectNear(l.direction, glm::dvec3(0, -0.6, -0.8));
  EXPECT_EQ(l.color, glm::vec3(0.25f, 0.125f, 0.5f));
}

TEST_F(Lights, ThatArePositional)
{
  auto light = this->addLight();
  light->PositionalOn();
  light->SetConeAngle(90);
  light->SetPosition(1, 2, 5);
  light->SetFocalPoint(1, 2, 4);
  light->SetAttenuationValues(0.5, 0.25, 0.125);
  light->SetExponent(3);
  const hrt::Snapshot& s = this->update();
  const hrt::Light& l = s.lights.at(0);
  EXPECT_EQ(l.kind, hrt::Light::Kind::Positional);
  EXPECT_FALSE(l.isSpot());
  EXPECT_EQ(l.position, glm::dvec3(1, 2, 5));
  EXPECT_EQ(l.direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(l.attenuation, glm::vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(l.exponent, 3.0f);
  light->SetConeAngle(20);
  EXPECT_TRUE(this->update().lights.at(0).isSpot());
  EXPECT_EQ(this->snapshot->lights[0].coneAngle, 20.0f);
}

TEST_F(Lights, OfTheSceneHonourTheirMatrix)
{
  auto light = this->addLight();
  vtkNew<vtkMatrix4x4> matrix; // a quarter turn about y, then up by 7
  const double elements[16] = { 0, 0, 1, 0, 0, 1, 0, 7, -1, 0, 0, 0, 0, 0, 0, 1 };
  matrix->DeepCopy(elements);
  light->SetTransformMatrix(matrix);
  light->SetPosition(0, 0, 2);
  light->SetFocalPoint(0, 0, 0);
  const hrt::Light& l = this->update().lights.at(0);
  EXPECT_EQ(l.position, glm::dvec3(2, 7, 0));
  EXPECT_EQ(l.direction, glm::dvec3(-1, 0, 0));
}

TEST_F(Lights, OfTheCameraMoveWithIt)
{
  auto light = this->addLight();
  light->SetLightTypeToCameraLight();
  light->SetPosition(0, 1, 1); // in a frame where the camera is at z = 1 and looks at the origin
  light->SetFocalPoint(0, 0, 0);
  const hrt::Light& l = this->update().lights.at(0);
  EXPECT_FALSE(l.isHeadlight);
  // The camera is 10 from its focal point: up by 10 from the eye. Coordinates near 10 that went
  // through two products: 64 half steps.
  expectNear(l.position, glm::dvec3(3, 14, 12), 64 * std::ldexp(16.0, -53));
  expectNear(l.direction, glm::dvec3(0, -std::sqrt(0.5), -std::sqrt(0.5)), 64 * kUnitTolerance);
}

TEST_F(Lights, AtTheHeadAreAtTheEyeAndAlone)
{
  auto light = this->addLight();
  light->SetLightTypeToHeadlight();
  const hrt::Snapshot& s = this->update();
  EXPECT_TRUE(s.singleHeadlight);
  EXPECT_TRUE(s.lights.at(0).isHeadlight);
  EXPECT_EQ(s.lights[0].position, glm::dvec3(3, 4, 12));
  expectNear(s.lights[0].direction, glm::dvec3(0, 0, -1));
}

TEST_F(Lights, AtTheHeadAreFoundBeforeTheRendererMovesThem)
{
  auto light = this->addLight();
  light->SetLightTypeToHeadlight();
  this->scene->Update(this->renderer); // without UpdateLightGeometry
  const hrt::Light& l = this->scene->GetSnapshot()->lights.at(0);
  EXPECT_EQ(l.position, glm::dvec3(3, 4, 12));
  expectNear(l.direction, glm::dvec3(0, 0, -1));
}

TEST_F(Lights, AtTheHeadShineAlongAnyView)
{
  this->addLight()->SetLightTypeToHeadlight();
  vtkCamera* camera = this->renderer->GetActiveCamera();
  camera->SetPosition(7, -2, 1);
  camera->SetFocalPoint(1, 3, -4);
  camera->Roll(33);
  const hrt::Snapshot& s = this->update();
  ASSERT_TRUE(s.singleHeadlight);
  // The view matrix is made by a handful of rotations, then inverted.
  expectNear(s.lights[0].direction, glm::normalize(glm::dvec3(-6, 5, -5)), 64 * kUnitTolerance);
}

// A view transform of the user's own turns what VTK shades by, though not the camera's line of
// sight.
TEST_F(Lights, AtTheHeadShineAlongTheViewsAxisUnderAUserTransform)
{
  this->addLight()->SetLightTypeToHeadlight();
  vtkNew<vtkTransform> turn;
  turn->RotateY(90); // takes the world's x axis to the view's -z, which is where the viewer looks
  this->renderer->GetActiveCamera()->SetUserViewTransform(turn);
  expectNear(this->update().lights.at(0).direction, glm::dvec3(1, 0, 0), 64 * kUnitTolerance);
}

// VTK chooses its formula for one headlight by the rules that each line tests.
TEST_F(Lights, AtTheHeadAreSingleAsVTKCounts)
{
  auto head = this->addLight();
  head->SetLightTypeToHeadlight();
  auto other = this->addLight();
  EXPECT_FALSE(this->update().singleHeadlight) << "two lights on";
  other->SetLightTypeToHeadlight();
  EXPECT_FALSE(this->update().singleHeadlight) << "two headlights on";
  EXPECT_TRUE(this->snapshot->lights[1].isHeadlight);
  other->SwitchOff();
  EXPECT_TRUE(this->update().singleHeadlight);
  other->PositionalOn();
  EXPECT_FALSE(this->update().singleHeadlight) << "a positional light counts even when off";
  other->PositionalOff();
  other->SetLightTypeToSceneLight();
  EXPECT_FALSE(this->update().singleHeadlight) << "so does any other light after the headlight";
  this->renderer->RemoveLight(head);
  this->renderer->AddLight(head);
  EXPECT_TRUE(this->update().singleHeadlight) << "but not before it";
  head->PositionalOn();
  EXPECT_FALSE(this->update().singleHeadlight);
}

TEST_F(Lights, ThatAreOffAreLeftOutAndOrderIsKept)
{
  vtkSmartPointer<vtkLight> lights[4];
  for (int i = 0; i < 4; ++i)
  {
    lights[i] = this->addLight();
    lights[i]->SetIntensity(0.25 * (i + 1));
  }
  const std::uint64_t keyOfLast = this->update().lights.at(3).key;
  lights[1]->SwitchOff();
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.lights.size(), 3u);
  EXPECT_EQ(s.lights[0].color.r, 0.25f);
  EXPECT_EQ(s.lights[1].color.r, 0.75f);
  EXPECT_EQ(s.lights[2].color.r, 1.0f);
  EXPECT_EQ(s.lights[2].key, keyOfLast);
}

TEST_F(Lights, WithoutDirectionShineDownZWithOneWarning)
{
  auto light = this->addLight();
  light->SetPosition(1, 2, 3);
  light->SetFocalPoint(1, 2, 3);
  EXPECT_EQ(this->update().lights.at(0).direction, glm::dvec3(0, 0, -1));
  this->update();
  ASSERT_EQ(this->messages.warnings.size(), 1u) << "not once a frame";
  EXPECT_NE(this->messages.warnings[0].find(addressOf(light)), std::string::npos);

  light->PositionalOn();
  light->SetConeAngle(120);
  this->messages.warnings.clear();
  EXPECT_EQ(this->update().lights.at(0).direction, glm::dvec3(0, 0, -1));
  EXPECT_TRUE(this->messages.warnings.empty()) << "a point light needs no direction";
  light->SetConeAngle(30);
  this->update();
  EXPECT_EQ(this->messages.warnings.size(), 1u) << "a spot light does";
}

TEST_F(Lights, ThatAreNotFiniteAreLeftOutWithOneWarning)
{
  auto light = this->addLight();
  auto good = this->addLight();
  light->SetIntensity(std::numeric_limits<double>::quiet_NaN());
  this->update();
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.lights[0].color, glm::vec3(1));
  ASSERT_EQ(this->messages.warnings.size(), 1u);
  EXPECT_NE(this->messages.warnings[0].find(addressOf(light)), std::string::npos);
}

} // anonymous namespace
