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

// How composite mappers of a class are asked.
struct CompositeMapperClass
{
  // Where it keeps what is said of single blocks; may be null.
  vtkCompositeDataDisplayAttributes* (*attributes)(vtkMapper*);
  // Whether blocks that lack the array by which it colours have the lookup table's colour for NaN.
  bool (*missingArraysAreNaN)(vtkMapper*);
};

// By the class' name. Registering it again replaces it.
VTKHYBRIDRENDERINGSCENE_EXPORT void registerCompositeMapper(
  const char* className, const CompositeMapperClass& how);

} // namespace scene
} // namespace hrt
