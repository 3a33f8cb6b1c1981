// What one step of the animation of BART's robots costs a ray structure: the paper built its tree anew
// for every frame, in 2 to 2.5 s. The scene is read and moved as an application would, but nothing is
// drawn, so that no rasteriser's threads share the cores with what is measured. Prints one JSON object
// a structure, for bench.py.
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "vtkHybridBARTImporter.h"
#include "vtkHybridScene.h"

#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace
{

// A part that begins to move is given a hierarchy of its own, once: that is not what a step costs.
constexpr int kWarmUp = 3;

struct Step
{
  double milliseconds = 0.0;
  std::uint64_t built = 0;
  std::size_t moved = 0;
};

std::size_t movedParts(const hrt::Snapshot& before, const hrt::Snapshot& now)
{
  std::size_t moved = 0;
  for (std::size_t i = 0; i < std::min(before.parts.size(), now.parts.size()); ++i)
  {
    moved += before.parts[i].localToWorld != now.parts[i].localToWorld ? 1 : 0;
  }
  return moved;
}

template <class Value>
Value atShare(std::vector<Step> steps, Value Step::*member, double share)
{
  std::sort(steps.begin(), steps.end(),
    [member](const Step& a, const Step& b) { return a.*member < b.*member; });
  return steps[static_cast<std::size_t>(share * double(steps.size() - 1) + 0.5)].*member;
}

bool measure(const char* file, const char* name, hrt::Structure& structure, int frames)
{
  vtkNew<vtkHybridBARTImporter> importer;
  importer->SetFileName(file);
  importer->TexturesOff();
  if (!importer->Read())
  {
    return false;
  }
  vtkNew<vtkRenderWindow> window; // described only, never drawn
  vtkNew<vtkRenderer> renderer;
  window->SetOffScreenRendering(1);
  window->AddRenderer(renderer);
  importer->AddTo(renderer);
  vtkNew<vtkHybridScene> scene;
  scene->Update(renderer, 800, 600);
  std::shared_ptr<const hrt::Snapshot> before = scene->GetSnapshot();
  const double first = structure.update(*before).milliseconds;
  std::vector<Step> steps;
  for (int i = 1; i <= kWarmUp + frames; ++i)
  {
    importer->SetTime(importer->GetFrameTime(i));
    scene->Update(renderer, 800, 600);
    const std::shared_ptr<const hrt::Snapshot> now = scene->GetSnapshot();
    const hrt::StructureReport report = structure.update(*now);
    if (i > kWarmUp)
    {
      steps.push_back({ report.milliseconds, report.built, movedParts(*before, *now) });
    }
    before = now;
  }
  const auto ms = [&](double share) { return atShare(steps, &Step::milliseconds, share); };
  std::printf("{\"structure\": \"%s\", \"first_ms\": %.4f, \"update_ms\": [%.4f, %.4f, %.4f], "
              "\"fastest_update_ms\": %.4f, \"worst_update_ms\": %.4f, \"built\": %lu, "
              "\"moved_parts\": %zu, \"parts\": %zu, \"triangles\": %u}\n",
    name, first, ms(0.25), ms(0.5), ms(0.75), ms(0.0), ms(1.0),
    static_cast<unsigned long>(atShare(steps, &Step::built, 0.5)),
    atShare(steps, &Step::moved, 0.5), before->parts.size(), before->triangleCount);
  return true;
}

} // namespace

int main(int argc, char** argv)
{
  const int frames = argc == 3 ? std::atoi(argv[2]) : 0;
  if (frames < 1)
  {
    std::fprintf(stderr, "usage: %s Robot.aff FRAMES\n", argv[0]);
    return 2;
  }
  vtkObject::GlobalWarningDisplayOff(); // of triangles without area
  hrt::BvhStructure embree;
  hrt::KdTreeStructure tree;
  return measure(argv[1], "Embree", embree, frames) && measure(argv[1], "kd-tree", tree, frames)
    ? 0
    : 1;
}
