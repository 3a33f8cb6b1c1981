// The smallest program that draws with the pass: one sphere, 64 x 64 pixels, off screen. It returns
// success only if the middle of the picture shows the sphere and the corner the background, so that
// a package which links but draws nothing is caught.

#include "vtkHybridBARTImporter.h"
#include "vtkHybridMaterial.h"
#include "vtkHybridRayTracingPass.h"

#include "vtkActor.h"
#include "vtkNew.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"

#include <iostream>

namespace
{
constexpr int kSize = 64;

// The three channels of a pixel added up.
int Brightness(vtkUnsignedCharArray* pixels, int x, int y)
{
  int sum = 0;
  for (int channel = 0; channel < 3; ++channel)
  {
    sum += static_cast<int>(pixels->GetComponent(y * kSize + x, channel));
  }
  return sum;
}
}

int main()
{
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(sphere->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);

  vtkNew<vtkHybridRayTracingPass> pass;
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetPass(pass);

  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(kSize, kSize);
  window->AddRenderer(renderer);
  window->Render();

  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, kSize - 1, kSize - 1, 0, pixels);
  const int middle = Brightness(pixels, kSize / 2, kSize / 2);
  const int corner = Brightness(pixels, 0, 0);
  if (middle <= 3 * 100 || corner != 0)
  {
    std::cerr << "no sphere on black: middle " << middle << ", corner " << corner << "\n";
    return 1;
  }

  vtkNew<vtkHybridBARTImporter> importer;
  if (importer->GetNumberOfFrames() != 0)
  {
    std::cerr << "an importer that has read nothing has frames\n";
    return 1;
  }
  return 0;
}
