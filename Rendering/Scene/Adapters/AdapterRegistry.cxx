// See AdapterRegistry.h.
#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkMapper.h"
#include "vtkPolyDataMapper.h"

namespace hrt
{
namespace scene
{

//------------------------------------------------------------------------------
std::unique_ptr<MapperAdapter> makeAdapter(vtkMapper* mapper)
{
  // The last one takes every vtkPolyDataMapper that the others have not.
  static const AdapterKind kinds[] = { glyph3DKind(), compositeKind(), dataSetKind(),
    polyDataKind() };
  for (const AdapterKind& kind : kinds)
  {
    if (kind.reads(mapper))
    {
      return kind.make();
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
vtkDataObject* updatedInput(vtkMapper* mapper)
{
  if (mapper->GetNumberOfInputConnections(0) == 0)
  {
    return nullptr;
  }
  if (!mapper->GetStatic())
  {
    vtkAlgorithmOutput* const connection = mapper->GetInputConnection(0, 0);
    vtkAlgorithm* const producer = connection->GetProducer();
    auto* const surface = vtkPolyDataMapper::SafeDownCast(mapper);
    if (surface && connection->GetIndex() == 0)
    {
      producer->UpdatePiece(surface->GetNumberOfSubPieces() * surface->GetPiece(),
        surface->GetNumberOfSubPieces() * surface->GetNumberOfPieces(), surface->GetGhostLevel());
    }
    else
    {
      producer->Update(connection->GetIndex());
    }
  }
  return mapper->GetInputDataObject(0, 0);
}

} // namespace scene
} // namespace hrt
