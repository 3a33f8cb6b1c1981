// The renderer's lights in world coordinates, with exactly the terms that VTK's shaders use.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <string>
#include <vector>

class vtkLight;
class vtkRenderer;

namespace hrt
{
namespace scene
{

struct LightRig
{
  std::vector<Light> lights;    // those that are switched on, in the renderer's order
  bool singleHeadlight = false; // see Snapshot::singleHeadlight

  // Lights that could not be taken as they are, each with what was done instead.
  struct Issue
  {
    std::uint64_t key;
    std::string text;
  };
  std::vector<Issue> issues;
};

LightRig extractLights(vtkRenderer* renderer, const Camera& camera, bool headlightShadows);

} // namespace scene
} // namespace hrt
