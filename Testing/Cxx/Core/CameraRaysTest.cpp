// Primary rays against points unprojected from clip space, for every kind of projection.
#include "Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace hrt;

// Unprojecting solves with a matrix whose condition is about far / near = 1e3 times the size of the
// coordinates, 1e2: 1e-16 * 1e5, with a hundredfold reserve.
constexpr double kTolerance = 1e-9;

double distanceToRay(const glm::dvec3& point, const glm::dvec3& origin, glm::dvec3 direction)
{
  direction = glm::normalize(direction);
  const glm::dvec3 away = point - origin;
  return glm::length(away - glm::dot(away, direction) * direction);
}

// Every point that projects to a pixel lies on the pixel's ray, farther points farther out.
void expectRaysMeetUnprojectedPoints(const CameraRays& rays, const glm::dmat4& toClip)
{
  const glm::dmat4 fromClip = glm::inverse(toClip);
  for (double x : { -1.0, -0.3, 0.0, 0.7, 1.0 })
  {
    for (double y : { -1.0, 0.2, 1.0 })
    {
      double last = -kTolerance; // parallel rays start on the near plane, depth -1
      for (double depth : { -1.0, -0.5, 0.0, 0.5, 0.9 })
      {
        const glm::dvec4 h = fromClip * glm::dvec4(x, y, depth, 1.0);
        const glm::dvec3 point = glm::dvec3(h) / h.w;
        EXPECT_LT(distanceToRay(point, rays.origin(x, y), rays.direction(x, y)), kTolerance);
        const double along = glm::dot(
          point - rays.origin(x, y), glm::normalize(rays.direction(x, y)));
        EXPECT_GT(along, last);
        last = along;
      }
    }
  }
}

void expectCameraIsRight(const Camera& camera)
{
  const glm::dvec3 origin(1.5, -2.0, 3.0);
  expectRaysMeetUnprojectedPoints(camera.viewRays(), camera.viewToClip);
  expectRaysMeetUnprojectedPoints(camera.worldRays(origin),
    camera.viewToClip * camera.worldToView * glm::translate(glm::dmat4(1.0), origin));
}

TEST(CameraRays, Perspective)
{
  const Camera camera = scenes::perspective({ 3, 4, 5 }, { 0, 1, 0 }, 640, 480);
  expectCameraIsRight(camera);
  const CameraRays rays = camera.viewRays();
  EXPECT_EQ(rays.origin(0.3, -0.8), glm::dvec3(0.0)); // the eye, for every pixel
  EXPECT_EQ(rays.originX, glm::dvec3(0.0));
  EXPECT_EQ(rays.originY, glm::dvec3(0.0));
  // Down the view's axis; the symmetric matrix has exact zeros.
  EXPECT_EQ(glm::normalize(rays.direction0), glm::dvec3(0, 0, -1));
}

TEST(CameraRays, OffCentre)
{
  Camera camera = scenes::perspective({ 3, 4, 5 }, { 0, 1, 0 }, 640, 480);
  camera.viewToClip = glm::frustum(-0.01, 0.07, 0.02, 0.05, 0.1, 100.0);
  expectCameraIsRight(camera);
}

TEST(CameraRays, Parallel)
{
  Camera camera = scenes::perspective({ 3, 4, 5 }, { 0, 1, 0 }, 640, 480);
  camera.parallel = true;
  camera.viewToClip = glm::ortho(-3.0, 5.0, -2.0, 2.0, 0.1, 100.0);
  expectCameraIsRight(camera);
  EXPECT_EQ(camera.viewRays().direction(0.5, -0.5), camera.viewRays().direction(-1, 1));
}

TEST(CameraRays, ShearedAndMirrored)
{
  // An oblique parallel projection, and a perspective that mirrors the image: explicit matrices.
  Camera camera = scenes::perspective({ 3, 4, 5 }, { 0, 1, 0 }, 640, 480);
  glm::dmat4 shear(1.0);
  shear[2][0] = 0.4;
  shear[2][1] = -0.2;
  camera.viewToClip = glm::ortho(-3.0, 5.0, -2.0, 2.0, 0.1, 100.0) * shear;
  expectCameraIsRight(camera);
  camera.viewToClip = glm::scale(glm::dmat4(1.0), { -1, 1, 1 }) *
    glm::perspective(0.7, 1.3, 0.1, 100.0);
  expectCameraIsRight(camera);
}

TEST(CameraRays, LargeCoordinatesCancel)
{
  // The same scene at the origin and far away. The far view matrix itself is rounded: its
  // translation of 3e5 to 2^-53 * 3e5 = 3e-11, which its three products bring to 1e-10.
  const glm::dvec3 remote(148376, 1234, -223423), eye(3, 4, 5), target(0, 1, 0);
  const CameraRays here = scenes::perspective(eye, target, 640, 480).worldRays(glm::dvec3(0.0));
  const CameraRays there =
    scenes::perspective(remote + eye, remote + target, 640, 480).worldRays(remote);
  EXPECT_LT(glm::length(here.origin0 - there.origin0), kTolerance);
  EXPECT_LT(glm::length(here.direction(1, 1) - there.direction(1, 1)), kTolerance);
}

} // namespace
