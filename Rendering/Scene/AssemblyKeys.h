// vtkAssembly replaces the property keys of its parts by its own each time it is drawn or asked for
// translucency. A mirror or a glass body inside an assembly would last for one frame; this memory
// gives the parts back what was theirs.
#pragma once

#include "Rendering/Scene/ActorPaths.h"

#include "vtkActor.h"
#include "vtkInformation.h"
#include "vtkSmartPointer.h"

#include <unordered_map>
#include <utility>

namespace hrt
{
namespace scene
{

class AssemblyKeys
{
public:
  // To be called for every path of a frame, before the actor's keys are read.
  void restore(const ActorPath& path)
  {
    vtkProp* root = path.props.front();
    if (root == path.actor || !root->IsA("vtkAssembly"))
    {
      return;
    }
    vtkInformation* keys = path.actor->GetPropertyKeys();
    const auto own = this->Own.find(path.key);
    const bool replaced = keys == root->GetPropertyKeys();
    if (replaced && own != this->Own.end())
    {
      path.actor->SetPropertyKeys(own->second);
      this->Next.insert(*own);
    }
    else if (!replaced && keys)
    {
      this->Next[path.key] = keys;
    }
  }

  // Forgets the paths that did not come up since the last call.
  void endFrame()
  {
    this->Own = std::move(this->Next);
    this->Next.clear();
  }

private:
  using Memory = std::unordered_map<std::uint64_t, vtkSmartPointer<vtkInformation>>;
  Memory Own;
  Memory Next;
};

} // namespace scene
} // namespace hrt
