// Implements the making and moving of a scene's objects. What does not change is not touched: a
// renderer that watches modification times does no work for what stands still.
#include "IO/BART/SceneActors.h"

#include "IO/BART/AFF/Error.h"
#include "IO/BART/AFF/Files.h"
#include "IO/BART/AFF/Lexer.h"
#include "IO/BART/MeshConversion.h"
#include "IO/BART/RoundShapes.h"
#include "Rendering/Scene/vtkHybridMaterial.h"

#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMatrix4x4.h"
#include "vtkPNMReader.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkTexture.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace hrt
{
namespace bart
{
namespace
{

// A vtkLight shines in all directions when its cone reaches 90 degrees.
constexpr double kAllDirections = 90.0;
// What is farther away than this many times the hither distance would be lost to a depth buffer of
// 24 bits; what is nearer than the other fraction of the scene may go instead.
constexpr double kDeepest = 1e6;

//------------------------------------------------------------------------------
vtkSmartPointer<vtkProperty> toProperty(const Material& material, const glm::dvec3& ambientLight)
{
  auto property = vtkSmartPointer<vtkProperty>::New();
  const glm::dvec3 ambient = material.ambient * ambientLight;
  property->SetAmbientColor(ambient.x, ambient.y, ambient.z);
  property->SetDiffuseColor(material.diffuse.x, material.diffuse.y, material.diffuse.z);
  property->SetSpecularColor(material.specular.x, material.specular.y, material.specular.z);
  property->SetAmbient(1.0);
  property->SetDiffuse(1.0);
  property->SetSpecular(1.0);
  property->SetSpecularPower(material.shininess);
  property->SetOpacity(1.0 - std::clamp(material.transmittance, 0.0, 1.0));
  return property;
}

//------------------------------------------------------------------------------
// See the class's documentation for the mapping and its reasons.
void setRayKeys(const Material& material, vtkActor* actor)
{
  const glm::dvec3& s = material.specular;
  const double mirror = std::clamp((s.x + s.y + s.z) / 3.0, 0.0, 1.0);
  if (material.transmittance > 0.0 && material.indexOfRefraction > 1.0)
  {
    vtkHybridMaterial::SetGlass(actor, material.indexOfRefraction);
  }
  else if (mirror > 0.0 && !(material.transmittance > 0.0)) // a translucent pane is drawn by VTK
  {
    vtkHybridMaterial::SetReflectance(actor, mirror);
  }
}

//------------------------------------------------------------------------------
// VTK's readers report to observers and go on. Their text names a line of their own source, which
// helps no one who has a bad image: only that there was an error is kept.
class ErrorEar
{
public:
  explicit ErrorEar(vtkObject* source)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* self, void*)
      { static_cast<ErrorEar*>(self)->Happened = true; });
    source->AddObserver(vtkCommand::ErrorEvent, this->Command);
  }
  bool happened() const { return this->Happened; }

private:
  vtkNew<vtkCallbackCommand> Command;
  bool Happened = false;
};

//------------------------------------------------------------------------------
vtkSmartPointer<vtkTexture> readTexture(const Texture& texture)
{
  const std::string path = findTexture(texture.path, texture.name);
  if (path.empty())
  {
    throw ReadError(texture.location,
      "expected the texture " + inQuotes(texture.name) +
        " beside this file or in a folder TextureFiles there or beside that folder");
  }
  vtkNew<vtkPNMReader> reader;
  const ErrorEar error(reader);
  reader->SetFileName(path.c_str());
  const bool readable = reader->CanReadFile(path.c_str()) != 0;
  if (readable)
  {
    reader->Update();
  }
  if (!readable || error.happened() || reader->GetOutput()->GetNumberOfPoints() == 0)
  {
    throw ReadError(texture.location, "the texture " + path + " is not a right PPM image");
  }
  auto result = vtkSmartPointer<vtkTexture>::New();
  // The image, not the reader: nothing is read again, whatever becomes of the file.
  result->SetInputData(reader->GetOutput());
  result->InterpolateOn();
  result->RepeatOn();
  return result;
}

//------------------------------------------------------------------------------
void setMatrix(vtkMatrix4x4* matrix, const glm::dmat4& value)
{
  // VTK's rows are GLM's columns.
  const glm::dmat4 rows = glm::transpose(value);
  const double* elements = glm::value_ptr(rows);
  if (!std::equal(elements, elements + 16, matrix->GetData()))
  {
    matrix->DeepCopy(elements);
  }
}

//------------------------------------------------------------------------------
// Makes the surface of a shape when it is first asked for.
template <typename Shape>
vtkPolyData* madeOnce(
  std::vector<vtkSmartPointer<vtkPolyData>>& made, const std::vector<Shape>& shapes, int index)
{
  made.resize(shapes.size());
  vtkSmartPointer<vtkPolyData>& surface = made[static_cast<std::size_t>(index)];
  if (!surface)
  {
    surface = toPolyData(shapes[static_cast<std::size_t>(index)]);
  }
  return surface;
}

//------------------------------------------------------------------------------
vtkIdType countTriangles(vtkPolyData* surface)
{
  vtkCellArray* faces = surface->GetPolys();
  return faces->GetNumberOfConnectivityIds() - 2 * faces->GetNumberOfCells();
}

} // anonymous namespace

//------------------------------------------------------------------------------
SceneActors::SceneActors() = default;
SceneActors::~SceneActors() = default;

//------------------------------------------------------------------------------
void SceneActors::make(const Scene& scene, bool withTextures)
{
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
  {
    this->Matrices.push_back(vtkSmartPointer<vtkMatrix4x4>::New());
  }
  for (const Material& material : scene.materials)
  {
    this->Properties.push_back(toProperty(material, scene.ambient));
  }
  for (std::size_t i = 0; withTextures && i < scene.textures.size(); ++i)
  {
    this->Textures.push_back(readTexture(scene.textures[i]));
  }
  for (const Instance& instance : scene.instances)
  {
    this->makeActor(scene, instance);
  }
  this->makeLights(scene);
  if (scene.viewpoint || scene.camera != kNone)
  {
    this->Camera = vtkSmartPointer<vtkCamera>::New();
  }
}

//------------------------------------------------------------------------------
vtkPolyData* SceneActors::surfaceOf(const Scene& scene, const Instance& instance)
{
  switch (instance.shape)
  {
    case Instance::Shape::Mesh:
      return madeOnce(this->Meshes, scene.meshes, instance.index);
    case Instance::Shape::AnimatedTriangles:
      return madeOnce(this->AnimatedTriangles, scene.animatedTriangles, instance.index);
    case Instance::Shape::Sphere:
      return madeOnce(this->Spheres, scene.spheres, instance.index);
    default:
      return madeOnce(this->Cones, scene.cones, instance.index);
  }
}

//------------------------------------------------------------------------------
void SceneActors::makeActor(const Scene& scene, const Instance& instance)
{
  vtkPolyData* surface = this->surfaceOf(scene, instance);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(surface);
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  const std::size_t material = static_cast<std::size_t>(instance.material);
  actor->SetProperty(this->Properties[material]);
  setRayKeys(scene.materials[material], actor);
  if (instance.node != kNone)
  {
    actor->SetUserMatrix(this->Matrices[static_cast<std::size_t>(instance.node)]);
  }
  if (instance.shape == Instance::Shape::Mesh && !this->Textures.empty())
  {
    const int texture = scene.meshes[static_cast<std::size_t>(instance.index)].texture;
    actor->SetTexture(
      texture == kNone ? nullptr : this->Textures[static_cast<std::size_t>(texture)].Get());
  }
  this->Actors->AddItem(actor);
  this->Triangles += countTriangles(surface);
}

//------------------------------------------------------------------------------
void SceneActors::makeLights(const Scene& scene)
{
  for (const PointLight& source : scene.lights)
  {
    vtkNew<vtkLight> light;
    light->SetLightTypeToSceneLight();
    light->PositionalOn();
    light->SetConeAngle(kAllDirections);
    light->SetColor(source.color.x, source.color.y, source.color.z);
    this->Lights->AddItem(light);
  }
}

//------------------------------------------------------------------------------
void SceneActors::moveTo(const Scene& scene, double time)
{
  const Pose pose = poseAt(scene, time);
  for (std::size_t i = 0; i < this->Matrices.size(); ++i)
  {
    setMatrix(this->Matrices[i], pose.toWorld[i]);
  }
  vtkCollectionSimpleIterator it;
  this->Actors->InitTraversal(it);
  for (const Instance& instance : scene.instances)
  {
    vtkActor* actor = this->Actors->GetNextActor(it);
    actor->SetVisibility(
      instance.node == kNone || pose.visible[static_cast<std::size_t>(instance.node)] ? 1 : 0);
  }
  for (std::size_t i = 0; i < this->AnimatedTriangles.size(); ++i)
  {
    bart::moveTo(scene.animatedTriangles[i], time, this->AnimatedTriangles[i]);
  }
  this->Lights->InitTraversal(it);
  for (const PointLight& source : scene.lights)
  {
    vtkLight* light = this->Lights->GetNextLight(it);
    const glm::dvec3 place = lightPositionAt(scene, pose, source, time);
    light->SetPosition(place.x, place.y, place.z);
    // VTK asks for a direction although the light has none.
    light->SetFocalPoint(place.x, place.y - 1.0, place.z);
  }
  this->moveCamera(scene, time);
}

//------------------------------------------------------------------------------
void SceneActors::moveCamera(const Scene& scene, double time)
{
  if (!this->Camera)
  {
    return;
  }
  const Viewpoint view = viewpointAt(scene, time);
  this->Camera->SetPosition(view.from.x, view.from.y, view.from.z);
  this->Camera->SetFocalPoint(view.at.x, view.at.y, view.at.z);
  this->Camera->SetViewUp(view.up.x, view.up.y, view.up.z);
  this->Camera->SetViewAngle(view.angle);
  // AFF's far plane is at infinity; ours lies behind everything.
  double farthest = 0.0;
  vtkCollectionSimpleIterator it;
  this->Actors->InitTraversal(it);
  while (vtkActor* actor = this->Actors->GetNextActor(it))
  {
    const double* b = actor->GetBounds();
    for (int corner = 0; b && corner < 8; ++corner)
    {
      const glm::dvec3 p(b[corner & 1], b[2 + ((corner >> 1) & 1)], b[4 + ((corner >> 2) & 1)]);
      farthest = std::max(farthest, glm::length(p - view.from));
    }
  }
  const double far = std::max(1.01 * farthest, 2.0 * view.hither);
  this->Camera->SetClippingRange(std::max(view.hither, far / kDeepest), far);
}

} // namespace bart
} // namespace hrt
