// The public face of the reader: switches, figures, and errors in VTK's way. What makes and moves
// the actors stands in SceneActors.cxx.

#include "vtkHybridBARTImporter.h"

#include "IO/BART/AFF/Error.h"
#include "IO/BART/AFF/Parser.h"
#include "IO/BART/SceneActors.h"

#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkCamera.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkObjectFactory.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cmath>
#include <new>

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkHybridBARTImporter);

struct vtkHybridBARTImporter::Internals
{
  hrt::bart::Scene scene;
  hrt::bart::SceneActors objects;
};

//------------------------------------------------------------------------------
vtkHybridBARTImporter::vtkHybridBARTImporter()
  : Inside(new Internals)
{
}

//------------------------------------------------------------------------------
vtkHybridBARTImporter::~vtkHybridBARTImporter()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
bool vtkHybridBARTImporter::Read()
{
  this->Inside.reset(new Internals);
  std::string problem;
  if (!this->FileName || !*this->FileName)
  {
    problem = "SetFileName was not called.";
  }
  else
  {
    try
    {
      hrt::bart::DiskFiles files;
      this->Inside->scene = hrt::bart::readScene(this->FileName, files);
      this->Inside->objects.make(this->Inside->scene, this->Textures);
    }
    catch (const hrt::bart::ReadError& error)
    {
      problem = error.what();
    }
    catch (const std::bad_alloc&)
    {
      problem = std::string(this->FileName) + ": not enough memory for this scene";
    }
  }
  if (!problem.empty())
  {
    this->Inside.reset(new Internals);
  }
  this->TakeFigures();
  this->NumberOfFrames = problem.empty() ? this->NumberOfFrames : 0;
  this->Modified();
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
    return false;
  }
  this->SetTime(this->TimeRange[0]);
  return true;
}

//------------------------------------------------------------------------------
void vtkHybridBARTImporter::TakeFigures()
{
  const hrt::bart::Scene& scene = this->Inside->scene;
  this->Time = this->TimeRange[0] = scene.startTime;
  this->TimeRange[1] = scene.endTime;
  this->NumberOfFrames = scene.frames;
  const hrt::bart::Viewpoint view = scene.viewpoint.value_or(hrt::bart::Viewpoint());
  this->Resolution[0] = view.width;
  this->Resolution[1] = view.height;
  this->NumberOfTriangles = this->Inside->objects.numberOfTriangles();
  this->NumberOfTexturedTriangles =
    static_cast<vtkIdType>(hrt::bart::countTriangles(scene).textured);
  this->NumberOfAnimatedTransforms = 0;
  this->NumberOfKeyedTransforms = 0;
  for (const hrt::bart::Node& node : scene.nodes)
  {
    this->NumberOfAnimatedTransforms += node.animated ? 1 : 0;
    this->NumberOfKeyedTransforms += node.animation != hrt::bart::kNone ? 1 : 0;
  }
}

//------------------------------------------------------------------------------
void vtkHybridBARTImporter::AddTo(vtkRenderer* renderer)
{
  if (!renderer)
  {
    vtkErrorMacro("AddTo needs a renderer.");
    return;
  }
  vtkCollectionSimpleIterator it;
  vtkActorCollection* actors = this->GetActors();
  actors->InitTraversal(it);
  while (vtkActor* actor = actors->GetNextActor(it))
  {
    renderer->AddActor(actor);
  }
  vtkLightCollection* lights = this->GetLights();
  lights->InitTraversal(it);
  while (vtkLight* light = lights->GetNextLight(it))
  {
    renderer->AddLight(light);
  }
  renderer->SetBackground(&this->Inside->scene.background.x);
  if (vtkCamera* camera = this->GetCamera())
  {
    renderer->SetActiveCamera(camera);
  }
  else
  {
    renderer->ResetCamera();
  }
}

//------------------------------------------------------------------------------
vtkActorCollection* vtkHybridBARTImporter::GetActors()
{
  return this->Inside->objects.actors();
}

//------------------------------------------------------------------------------
vtkLightCollection* vtkHybridBARTImporter::GetLights()
{
  return this->Inside->objects.lights();
}

//------------------------------------------------------------------------------
vtkCamera* vtkHybridBARTImporter::GetCamera()
{
  return this->Inside->objects.camera();
}

//------------------------------------------------------------------------------
void vtkHybridBARTImporter::SetTime(double time)
{
  if (!std::isfinite(time))
  {
    vtkErrorMacro("A time must be finite; " << time << " is refused and nothing moves.");
    return;
  }
  this->Inside->objects.moveTo(this->Inside->scene, time);
  if (time != this->Time)
  {
    this->Time = time;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
double vtkHybridBARTImporter::GetFrameTime(int frame)
{
  const int last = this->NumberOfFrames - 1;
  if (last < 1)
  {
    return this->TimeRange[0];
  }
  const double u = static_cast<double>(std::min(std::max(frame, 0), last)) / last;
  return (1.0 - u) * this->TimeRange[0] + u * this->TimeRange[1];
}

//------------------------------------------------------------------------------
void vtkHybridBARTImporter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Textures: " << (this->Textures ? "On" : "Off") << "\n";
  os << indent << "Time: " << this->Time << " of [" << this->TimeRange[0] << ", "
     << this->TimeRange[1] << "]\n";
  os << indent << "NumberOfFrames: " << this->NumberOfFrames << "\n";
  os << indent << "Actors: " << this->GetActors()->GetNumberOfItems() << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << ", "
     << this->NumberOfTexturedTriangles << " textured\n";
  os << indent << "NumberOfAnimatedTransforms: " << this->NumberOfAnimatedTransforms << ", "
     << this->NumberOfKeyedTransforms << " with keys\n";
  os << indent << "Resolution: " << this->Resolution[0] << " x " << this->Resolution[1] << "\n";
}

VTK_ABI_NAMESPACE_END
