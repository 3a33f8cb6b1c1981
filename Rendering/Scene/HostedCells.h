// The vertex and line cells of data whose surface is traced. VTK draws them over it: an actor of
// their own shows them by the properties of the one that they belong to.
#pragma once

#include "Rendering/Scene/Adapters/MapperAdapter.h"

#include "vtkActor.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <glm/glm.hpp>

#include <tuple>
#include <vector>

class vtkProperty;

namespace hrt
{
namespace scene
{

class HostedCells
{
public:
  // Whether the piece has such cells, or the actor shows the vertices of its surface.
  static bool neededFor(const SurfacePiece& piece, vtkActor* actor);

  // The actors that show them, one or two. What has not changed is not touched, so that VTK does not
  // prepare it anew.
  std::vector<vtkActor*> update(
    const SurfacePiece& piece, vtkActor* actor, const glm::dmat4& localToWorld);

private:
  // What an actor has been made from; addresses are compared only, times are unique in the process.
  using Signature = std::tuple<const void*, vtkMTimeType, const void*, vtkMTimeType, const void*,
    vtkMTimeType, bool, float, float, float>;
  struct Shown
  {
    vtkSmartPointer<vtkActor> actor;
    Signature signature;
  };
  void make(Shown& shown, bool vertices, const SurfacePiece& piece, vtkProperty* property);

  Shown Cells, Vertices;
};

} // namespace scene
} // namespace hrt
