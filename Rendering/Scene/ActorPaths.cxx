// Walks the view props by their assembly paths. The paths are collected before anything is done
// with them, so that the walk itself is over when pipelines are updated.

#include "Rendering/Scene/ActorPaths.h"

#include "Rendering/Scene/VTKConversions.h"

#include "vtkActor.h"
#include "vtkAssembly.h"
#include "vtkAssemblyNode.h"
#include "vtkAssemblyPath.h"
#include "vtkFollower.h"
#include "vtkProp3D.h"
#include "vtkPropAssembly.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"

#include <utility>

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input moves every bit.
std::uint64_t mix(std::uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

//------------------------------------------------------------------------------
std::uint64_t keyOf(const std::vector<vtkProp*>& props)
{
  std::uint64_t key = 0x9e3779b97f4a7c15ull; // the increment of SplitMix64
  for (vtkProp* prop : props)
  {
    key = mix(key + reinterpret_cast<std::uintptr_t>(prop));
  }
  return key;
}

//------------------------------------------------------------------------------
glm::dmat4 matrixOf(vtkAssemblyNode* node)
{
  return node && node->GetMatrix() ? toMatrix(node->GetMatrix()) : glm::dmat4(1.0);
}

//------------------------------------------------------------------------------
// Reads a path; without an actor when it ends in another kind of prop.
ActorPath readPath(vtkAssemblyPath* source)
{
  ActorPath path;
  vtkAssemblyNode* parent = nullptr;
  vtkAssemblyNode* last = nullptr;
  vtkCollectionSimpleIterator it;
  source->InitTraversal(it);
  while (auto* node = vtkAssemblyNode::SafeDownCast(source->GetNextItemAsObject(it)))
  {
    parent = last;
    last = node;
    path.props.push_back(node->GetViewProp());
    path.visible = path.visible && node->GetViewProp()->GetVisibility();
  }
  path.actor = last ? vtkActor::SafeDownCast(last->GetViewProp()) : nullptr;
  path.key = keyOf(path.props);
  if (!path.actor)
  {
    return path;
  }
  path.localToWorld = matrixOf(last);
  if (parent && path.actor->IsA("vtkFollower"))
  {
    // Assemblies keep their paths until a part is modified, which a follower is not when the camera
    // that it faces moves.
    path.actor->ComputeMatrix();
    path.localToWorld = matrixOf(parent) * toMatrix(path.actor->GetMatrix());
  }
  return path;
}

//------------------------------------------------------------------------------
// An actor of the renderer itself, which most are: without the lists that a traversal makes.
ActorPath readActor(vtkActor* actor)
{
  ActorPath path;
  path.props = { actor };
  path.actor = actor;
  path.visible = actor->GetVisibility();
  path.key = keyOf(path.props);
  actor->ComputeMatrix();
  path.localToWorld = toMatrix(actor->GetMatrix());
  return path;
}

//------------------------------------------------------------------------------
// Other props draw themselves by rules of their own, also where they offer paths.
bool isAssembly(vtkProp* prop)
{
  return vtkAssembly::SafeDownCast(prop) || vtkPropAssembly::SafeDownCast(prop);
}

//------------------------------------------------------------------------------
ActorPath otherProp(vtkProp* prop)
{
  ActorPath path;
  path.props = { prop };
  path.visible = prop->GetVisibility();
  path.key = keyOf(path.props);
  return path;
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::uint64_t keyOfPiece(std::uint64_t path, std::uint64_t piece)
{
  return piece == 0 ? path : mix(path + piece);
}

//------------------------------------------------------------------------------
std::vector<ActorPath> actorPaths(vtkRenderer* renderer)
{
  std::vector<ActorPath> paths;
  vtkPropCollection* props = renderer->GetViewProps();
  paths.reserve(static_cast<std::size_t>(props->GetNumberOfItems()));
  vtkCollectionSimpleIterator it;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    if (auto* const actor = vtkActor::SafeDownCast(prop))
    {
      paths.push_back(readActor(actor));
    }
    else if (isAssembly(prop))
    {
      prop->InitPathTraversal();
      while (vtkAssemblyPath* source = prop->GetNextPath())
      {
        paths.push_back(readPath(source));
      }
    }
    else if (vtkProp3D::SafeDownCast(prop))
    {
      paths.push_back(otherProp(prop));
    }
  }
  return paths;
}

} // namespace scene
} // namespace hrt
