// From vtkProperty, the actor's backface property and the keys of vtkHybridMaterial to an
// hrt::Material.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/Adapters/MapperAdapter.h"

#include <vector>

class vtkActor;
class vtkProp;

namespace hrt
{
namespace scene
{

// The keys of vtkHybridMaterial of the actor, else of the nearest assembly above it that has them.
struct RayKeys
{
  double reflectance = 0.0;
  double indexOfRefraction = 0.0;
  bool castsShadow = true;
};

// `path` leads from the renderer's prop to the actor.
RayKeys readRayKeys(const std::vector<vtkProp*>& path);

Material extractMaterial(vtkActor* actor, const RayKeys& keys, ColorSource colorSource,
  const PieceOverrides& overrides = {});

} // namespace scene
} // namespace hrt
