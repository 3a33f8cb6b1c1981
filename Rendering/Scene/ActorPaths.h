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

// Of the renderer's props but flat ones, in the order of its view props; props that are culled or
// hidden are among them. A prop that is neither an actor nor an assembly has a path without an actor.
std::vector<ActorPath> actorPaths(vtkRenderer* renderer);

// The key of one piece of what a path shows; the path's own for piece 0.
std::uint64_t keyOfPiece(std::uint64_t path, std::uint64_t piece);

} // namespace scene
} // namespace hrt
