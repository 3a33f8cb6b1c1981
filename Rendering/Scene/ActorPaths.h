// The actors of a renderer with the matrices that assemblies give them. One actor may be met on
// several paths; each path is a part of its own. Other props within assemblies are told too, so that
// an assembly which holds one is not taken for drawn.
#pragma once

#include "vtkType.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

class vtkActor;
class vtkProp;
class vtkRenderer;

namespace hrt
{
namespace scene
{

struct ActorPath
{
  std::vector<vtkProp*> props; // from the renderer's prop down to the actor
  vtkActor* actor = nullptr;   // the last of them; null when that is another kind of prop
  glm::dmat4 localToWorld{ 1.0 };
  bool visible = true;   // every prop on the path is
  std::uint64_t key = 0; // the same for the same path in later frames
};

// Of the renderer's actors and assemblies, in the order of its view props; props that are culled or hidden are among them.
std::vector<ActorPath> actorPaths(vtkRenderer* renderer);

} // namespace scene
} // namespace hrt
