// The VTK objects of an AFF scene: makes them once and moves them to a time.
#pragma once

#include "IO/BART/AFF/Scene.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

class vtkActor;
class vtkActorCollection;
class vtkCamera;
class vtkLight;
class vtkLightCollection;
class vtkMatrix4x4;
class vtkPolyData;
class vtkProperty;
class vtkTexture;

namespace hrt
{
namespace bart
{

class SceneActors
{
public:
  SceneActors();
  ~SceneActors();

  // Throws ReadError for a texture that cannot be had.
  void make(const Scene& scene, bool withTextures);
  // The scene must be the one that the objects were made from.
  void moveTo(const Scene& scene, double time);

  vtkActorCollection* actors() const { return this->Actors; }
  vtkLightCollection* lights() const { return this->Lights; }
  vtkCamera* camera() const { return this->Camera; }
  vtkIdType numberOfTriangles() const { return this->Triangles; }

private:
  using Surfaces = std::vector<vtkSmartPointer<vtkPolyData>>;

  void makeLights(const Scene& scene);
  void makeActor(const Scene& scene, const Instance& instance);
  vtkPolyData* surfaceOf(const Scene& scene, const Instance& instance);
  void moveCamera(const Scene& scene, double time);

  vtkNew<vtkActorCollection> Actors;
  vtkNew<vtkLightCollection> Lights;
  vtkSmartPointer<vtkCamera> Camera;
  vtkIdType Triangles = 0;

  std::vector<vtkSmartPointer<vtkMatrix4x4>> Matrices;  // of each node
  std::vector<vtkSmartPointer<vtkProperty>> Properties; // of each material
  std::vector<vtkSmartPointer<vtkTexture>> Textures;    // of each texture, where they are shown
  Surfaces Meshes, AnimatedTriangles, Spheres, Cones;   // each made when first used
};

} // namespace bart
} // namespace hrt
