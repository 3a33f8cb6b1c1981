// Reads one frame of a renderer: goes through its actors, sorts them out, and puts together what
// the other parts of this folder extract. It holds what must live from one frame to the next - the
// cached triangles and which warnings the user has seen already - and knows nothing of the frame
// before: a frame is built aside, so that one that cannot be completed leaves no trace.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/ActorClassification.h"
#include "Rendering/Scene/ActorPaths.h"
#include "Rendering/Scene/AssemblyKeys.h"
#include "Rendering/Scene/Complaints.h"
#include "Rendering/Scene/GeometryCache.h"

#include "vtkProp.h"
#include "vtkWeakPointer.h"

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

class vtkMapper;
class vtkPolyData;
class vtkRenderer;

namespace hrt
{
namespace scene
{

// What the tracer does with a prop, summed over its visible paths.
struct Verdict
{
  bool drawn = true;
  LeftToVTK reason = LeftToVTK::No; // the first reason met
};

// One snapshot and what VTK objects its parts came from.
struct Frame
{
  std::shared_ptr<Snapshot> snapshot = std::make_shared<Snapshot>();
  std::vector<vtkWeakPointer<vtkProp>> props; // of the parts
  std::unordered_map<const vtkProp*, Verdict> verdicts;
};

class SceneReader
{
public:
  // Pipelines are brought up to date. May throw what memory or a pipeline does.
  Frame read(vtkRenderer* renderer, int width, int height);

  // What there is to tell of the frame, a line each; empty where there is nothing new.
  struct Messages
  {
    std::string warnings;
    std::string errors;
  };
  // The frame that was read is taken: forgets what it did not need.
  Messages endFrame();

private:
  struct Draft; // a frame that is being put together

  void addPath(const ActorPath& path, Draft& draft);
  LeftToVTK addSurface(const ActorPath& path, vtkMapper* mapper, vtkPolyData* input, Draft& draft);
  LeftToVTK addPart(const ActorPath& path, const Part& part, Draft& draft);
  LeftToVTK checkMatrix(const ActorPath& path, Part& part, Snapshot& snapshot);
  vtkPolyData* updateInput(
    vtkMapper* mapper, const ActorPath& path, Snapshot& snapshot, LeftToVTK& left);
  void addLights(vtkRenderer* renderer, Snapshot& snapshot);

  GeometryCache Geometries;
  AssemblyKeys Keys;
  Complaints Warnings;
  Complaints Errors;
};

} // namespace scene
} // namespace hrt
