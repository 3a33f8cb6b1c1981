// The object intersection buffer against the brute-force reference, pixel by pixel: the wrong ids of
// rasterised visibility are few and counted, and where the id is right (t, u, v) has the precision
// that each of the paper's two ways promises.
#include "Rendering/Core/Snapshot.h"
#include "Rendering/OpenGL2/vtkHybridRayTracingPass.h"
#include "Rendering/Scene/vtkHybridScene.h"
#include "Testing/Cxx/Reference/BruteForce.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPLYReader.h"
#include "vtkParametricFunctionSource.h"
#include "vtkParametricTorus.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>

namespace
{

// Largest share of wrong ids among hit pixels that rasterised visibility may have.
constexpr double kWrongShare = 0.002;

// Errors of (u, v) are given in pixels: multiplied by the triangle's smallest height in the picture,
// which removes the amplification that small triangles and grazing views cause.
//
// Computed from ray and triangle in double: matrix, ray and intersection round some 128 times in all,
// relative to the largest number involved, which is the distance from the eye or, far from the
// origin, the coordinates themselves.
constexpr double kRoundings = 128 * 1.2e-16;

// As rasterised: vertices are snapped to 1/256 of a pixel, three of them, each by at most half a step
// in both directions, and as much again for the interpolation in float.
constexpr double kRasterisedPixels = 4.0 / 256.0;

struct Scene
{
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkActor> actor;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkHybridRayTracingPass> pass;

  Scene()
  {
    this->actor->SetMapper(this->mapper);
    this->renderer->AddActor(this->actor);
    this->window->SetOffScreenRendering(true);
    this->window->SetMultiSamples(0);
    this->window->SetSize(800, 600);
    this->window->AddRenderer(this->renderer);
    this->pass->SetShadowModeToOff();
    this->pass->SetBuffers({ "triangle", "barycentric" });
    this->renderer->SetPass(this->pass);
  }

  void look(double x, double y, double z)
  {
    this->renderer->GetActiveCamera()->SetPosition(x, y, z);
    this->renderer->ResetCamera();
    this->renderer->GetActiveCamera()->Zoom(1.4);
    this->renderer->ResetCameraClippingRange();
  }
};

struct Figures
{
  std::size_t hits = 0;
  std::size_t wrong = 0;
  double worstBarycentrics = 0.0; // pixels
  double exactBound = 0.0;        // pixels
};

// Smallest height of a triangle in the picture, in pixels: what one unit of (u, v) spans.
double heightInPixels(const hrt::Snapshot& snapshot, hrt::TriangleId id)
{
  const hrt::Part& part = snapshot.parts[snapshot.partOf(id)];
  const glm::dmat4 toClip =
    snapshot.camera.viewToClip * snapshot.camera.worldToView * part.positionsToWorld();
  const auto corners = part.geometry->cornerPositions(id - part.firstTriangle);
  glm::dvec2 p[3];
  for (int k = 0; k < 3; ++k)
  {
    const glm::dvec4 clip = toClip * glm::dvec4(glm::dvec3(corners[k]), 1.0);
    p[k] = glm::dvec2(clip) / clip.w * 0.5 *
      glm::dvec2(snapshot.camera.width, snapshot.camera.height);
  }
  const glm::dvec2 e1 = p[1] - p[0];
  const glm::dvec2 e2 = p[2] - p[0];
  const double area = std::abs(e1.x * e2.y - e1.y * e2.x);
  return area / std::max({ glm::length(e1), glm::length(e2), glm::length(p[2] - p[1]) });
}

// The largest number that positions and rays are computed from, in pixels' widths at the object.
double largestNumberInPixels(const hrt::Snapshot& snapshot)
{
  const glm::dmat4 toWorld = glm::inverse(snapshot.camera.worldToView);
  const glm::dvec3 eye(toWorld[3]);
  const double distance = glm::length(eye - snapshot.origin);
  const double pixel = 2.0 * distance / snapshot.camera.viewToClip[1][1] / snapshot.camera.height;
  return (distance + glm::length(eye)) / pixel;
}

Figures compare(Scene& scene)
{
  vtkNew<vtkHybridScene> reader;
  reader->Update(scene.renderer);
  const hrt::Snapshot& snapshot = *reader->GetSnapshot();
  const std::vector<hrt::reference::Pixel> truth = hrt::reference::bruteForce(snapshot);

  vtkDataArray* ids = scene.pass->GetBuffer("triangle")->GetPointData()->GetScalars();
  vtkDataArray* uv = scene.pass->GetBuffer("barycentric")->GetPointData()->GetScalars();
  Figures figures;
  figures.exactBound = kRoundings * largestNumberInPixels(snapshot);
  for (std::size_t i = 0; i < truth.size(); ++i)
  {
    const auto at = static_cast<vtkIdType>(i);
    const double shown = ids->GetComponent(at, 0);
    const double expected =
      truth[i].triangle == hrt::kNoTriangle ? -1.0 : double(truth[i].triangle);
    figures.hits += expected >= 0 || shown >= 0 ? 1 : 0;
    if (shown != expected)
    {
      ++figures.wrong;
    }
    else if (expected >= 0)
    {
      const double error = std::max(std::abs(uv->GetComponent(at, 0) - truth[i].u),
        std::abs(uv->GetComponent(at, 1) - truth[i].v));
      figures.worstBarycentrics = std::max(
        figures.worstBarycentrics, error * heightInPixels(snapshot, truth[i].triangle));
    }
  }
  return figures;
}

void check(const std::string& name, Scene& scene)
{
  for (const bool direct : { false, true })
  {
    scene.pass->SetVisibility(direct ? vtkHybridRayTracingPass::DirectRendering
                                     : vtkHybridRayTracingPass::ItemBuffer);
    scene.window->Render();
    const Figures figures = compare(scene);
    std::cout << "OIB " << name << (direct ? ", direct rendering: " : ", item buffer: ")
              << figures.wrong << " wrong ids of " << figures.hits << " hit pixels ("
              << 100.0 * double(figures.wrong) / double(figures.hits) << " %), worst (u, v) error "
              << figures.worstBarycentrics << " pixels" << std::endl;
    EXPECT_GT(figures.hits, 60000u);
    EXPECT_LE(double(figures.wrong), kWrongShare * double(figures.hits));
    EXPECT_LE(figures.worstBarycentrics, direct ? kRasterisedPixels : figures.exactBound);
  }
}

} // namespace

TEST(ObjectIntersectionBuffer, Torus)
{
  vtkNew<vtkParametricTorus> torus;
  vtkNew<vtkParametricFunctionSource> source;
  source->SetParametricFunction(torus);
  source->SetUResolution(32);
  source->SetVResolution(16);
  Scene scene;
  scene.mapper->SetInputConnection(source->GetOutputPort());
  scene.mapper->ScalarVisibilityOff();
  scene.look(1.0, -2.0, 2.0);
  scene.window->Render();
  check("torus", scene);
}

TEST(ObjectIntersectionBuffer, Bunny)
{
  const char* root = std::getenv("HRT_DATA_ROOT");
  const std::string file = std::string(root ? root : HRT_DEFAULT_DATA_ROOT) + "/bunny/bunny.ply";
  if (!std::ifstream(file).good())
  {
    GTEST_SKIP() << "scene data bunny/bunny.ply is absent (see Data/README.md)";
  }
  vtkNew<vtkPLYReader> reader;
  reader->SetFileName(file.c_str());
  Scene scene;
  scene.mapper->SetInputConnection(reader->GetOutputPort());
  scene.look(0.1, 0.2, 1.0);
  scene.window->Render();
  check("bunny", scene);
}

// A closed mesh whose corners are moved by a matrix far from the origin: ids do not suffer.
TEST(ObjectIntersectionBuffer, FarFromTheOrigin)
{
  vtkNew<vtkParametricTorus> torus;
  vtkNew<vtkParametricFunctionSource> source;
  source->SetParametricFunction(torus);
  Scene scene;
  scene.mapper->SetInputConnection(source->GetOutputPort());
  scene.mapper->ScalarVisibilityOff();
  scene.actor->SetPosition(148376.0, 1234.0, -223423.0);
  scene.actor->RotateX(30.0);
  scene.look(1.0, 2.0, 3.0);
  scene.window->Render();
  check("far torus", scene);
}
