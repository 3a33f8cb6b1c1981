// The camera: a world point lands in the snapshot's clip space where VTK puts it. The background:
// what rays see that leave the scene.
#include "SceneTest.h"

#include "vtkMatrix4x4.h"

#include <cmath>

namespace
{

class CameraAndBackground : public SceneTest
{
protected:
  CameraAndBackground()
    : camera(this->renderer->GetActiveCamera())
  {
    this->camera->SetPosition(3, -4, 12);
    this->camera->SetFocalPoint(1, 0.5, -2);
    this->camera->SetViewUp(0.1, 1, 0.2);
    this->camera->SetClippingRange(2, 40);
  }

  // Compares x and y, which VTK maps to [-1, 1] as clip space does. (VTK's z is in [0, 1] here.)
  void expectSameProjection()
  {
    const hrt::Camera& c = this->update().camera;
    for (const glm::dvec3& world :
      { glm::dvec3(0, 0, 0), glm::dvec3(1, 2, -3), glm::dvec3(-2.5, 0.25, 1) })
    {
      this->renderer->SetWorldPoint(world.x, world.y, world.z, 1.0);
      this->renderer->WorldToView();
      const double* expected = this->renderer->GetViewPoint();
      const glm::dvec4 clip = c.viewToClip * (c.worldToView * glm::dvec4(world, 1.0));
      // Sums of a dozen products of numbers below 2^6 in either way, divided by a w of 2 or more.
      const double tolerance = 12 * std::ldexp(64.0, -53);
      EXPECT_NEAR(clip.x / clip.w, expected[0], tolerance);
      EXPECT_NEAR(clip.y / clip.w, expected[1], tolerance);
    }
  }

  vtkCamera* camera;
};

TEST_F(CameraAndBackground, Perspective)
{
  this->expectSameProjection();
  EXPECT_FALSE(this->snapshot->camera.parallel);
  EXPECT_EQ(this->snapshot->camera.width, 320);
  EXPECT_EQ(this->snapshot->camera.height, 200);
}

TEST_F(CameraAndBackground, MatricesAreVTKsTransposed)
{
  const hrt::Camera& c = this->update().camera;
  vtkMatrix4x4* view = this->camera->GetModelViewTransformMatrix();
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      EXPECT_EQ(c.worldToView[j][i], view->GetElement(i, j));
    }
  }
  vtkMatrix4x4* projection = this->camera->GetProjectionTransformMatrix(320.0 / 200.0, -1, 1);
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      EXPECT_EQ(c.viewToClip[j][i], projection->GetElement(i, j));
    }
  }
}

TEST_F(CameraAndBackground, NearAndFarPlanesAreMinusOneAndOne)
{
  const hrt::Camera& c = this->update().camera;
  for (double distance : { 2.0, 40.0 })
  {
    const glm::dvec4 clip = c.viewToClip * glm::dvec4(0, 0, -distance, 1);
    // Two products and a sum of numbers up to 40 x 42 / 38 < 2^6, divided by the distance.
    EXPECT_NEAR(clip.z / clip.w, distance == 2.0 ? -1.0 : 1.0, 4 * std::ldexp(64.0, -53));
  }
}

TEST_F(CameraAndBackground, Parallel)
{
  this->camera->ParallelProjectionOn();
  this->camera->SetParallelScale(5);
  this->expectSameProjection();
  EXPECT_TRUE(this->snapshot->camera.parallel);
}

TEST_F(CameraAndBackground, OffCentreWindow)
{
  this->update();
  const hrt::Camera before = this->snapshot->camera;
  this->camera->SetWindowCenter(0.25, -0.5);
  this->expectSameProjection();
  EXPECT_FALSE(this->snapshot->camera == before);
}

TEST_F(CameraAndBackground, OffAxisProjection)
{
  this->camera->SetScreenBottomLeft(-1, -1, -2);
  this->camera->SetScreenBottomRight(2, -1, -2);
  this->camera->SetScreenTopRight(2, 1.5, -2);
  // Newer releases take the eye from here and not from the position. It is 3 or more in front of
  // every point tested, because a point in the eye's own plane has no projection.
  double eye[3] = { 0.5, 0.25, 4 };
  this->camera->SetEyePosition(eye);
  this->camera->UseOffAxisProjectionOn();
  this->expectSameProjection();
}

TEST_F(CameraAndBackground, ExplicitProjection)
{
  vtkNew<vtkMatrix4x4> matrix;
  const double elements[16] = { 1.5, 0.1, 0.2, 0, 0, 2.5, -0.1, 0, 0, 0, -1.1, -2.2, 0, 0, -1, 0 };
  matrix->DeepCopy(elements);
  this->camera->SetExplicitProjectionTransformMatrix(matrix);
  this->camera->UseExplicitProjectionTransformMatrixOn();
  this->expectSameProjection();
  EXPECT_EQ(this->snapshot->camera.viewToClip[1][0], 0.1);
  EXPECT_FALSE(this->snapshot->camera.parallel);
}

TEST_F(CameraAndBackground, ViewportsHaveTheirOwnSize)
{
  this->renderer->SetViewport(0.5, 0.0, 1.0, 0.5);
  const hrt::Camera& c = this->update().camera;
  EXPECT_EQ(c.width, 160);
  EXPECT_EQ(c.height, 100);
}

TEST_F(CameraAndBackground, SolidBackground)
{
  this->renderer->SetBackground(0.25, 0.5, 0.75);
  this->renderer->SetBackground2(1, 1, 1);
  const hrt::Background& b = this->update().background;
  EXPECT_EQ(b.bottom, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(b.top, b.bottom);
}

TEST_F(CameraAndBackground, GradientBackgroundRisesAlongTheOrthogonalViewUp)
{
  this->renderer->SetBackground(0.25, 0.5, 0.75);
  this->renderer->SetBackground2(1, 0.5, 0);
  this->renderer->GradientBackgroundOn();
  const hrt::Background& b = this->update().background;
  EXPECT_EQ(b.bottom, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(b.top, glm::vec3(1, 0.5f, 0));
  const glm::dvec3 sight = glm::normalize(glm::dvec3(1, 0.5, -2) - glm::dvec3(3, -4, 12));
  const glm::dvec3 viewUp(0.1, 1, 0.2);
  const glm::dvec3 expected = glm::normalize(viewUp - glm::dot(viewUp, sight) * sight);
  // Rounded to float at the end.
  EXPECT_LE(glm::length(glm::dvec3(b.up) - expected), std::ldexp(2.0, -24));
}

TEST_F(CameraAndBackground, TexturedBackgroundIsSolidToRays)
{
  this->renderer->SetBackground(0.25, 0.5, 0.75);
  this->renderer->SetBackground2(1, 0.5, 0);
  this->renderer->GradientBackgroundOn();
  this->renderer->TexturedBackgroundOn();
  const hrt::Background& b = this->update().background;
  EXPECT_EQ(b.top, b.bottom);
}

TEST_F(CameraAndBackground, ARendererWithoutWindowIsRead)
{
  vtkNew<vtkRenderer> lonely;
  lonely->AddActor(makeActor(makeSquare()));
  this->scene->Update(lonely);
  EXPECT_EQ(this->scene->GetSnapshot()->triangleCount, 2u);
}

} // anonymous namespace
