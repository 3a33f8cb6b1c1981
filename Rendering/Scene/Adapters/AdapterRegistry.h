// The kinds of mappers that are read. A kind registers itself by the class that it reads; a module
// that knows a class which this one does not link adds its own.
#pragma once

#include "Rendering/Scene/Adapters/MapperAdapter.h"

#include "vtkHybridRenderingSceneModule.h" // For export macro

class vtkCompositeDataDisplayAttributes;

namespace hrt
{
namespace scene
{

struct AdapterKind
{
  bool (*reads)(vtkMapper*);
  std::unique_ptr<MapperAdapter> (*make)();
};

// The kinds of this folder, in the order in which they are asked.
AdapterKind glyph3DKind();
AdapterKind compositeKind();
AdapterKind dataSetKind();
AdapterKind polyDataKind();

// A composite mapper's class by name, and where it keeps what is said of single blocks. Null
// attributes are allowed. Registering a name again replaces it.
using BlockAttributes = vtkCompositeDataDisplayAttributes* (*)(vtkMapper*);
VTKHYBRIDRENDERINGSCENE_EXPORT void registerCompositeMapper(
  const char* className, BlockAttributes attributes);

} // namespace scene
} // namespace hrt
