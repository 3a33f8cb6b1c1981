// See AdapterRegistry.h.
#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkMapper.h"
#include "vtkPolyDataMapper.h"
#include "vtkStreamingDemandDrivenPipeline.h"

namespace hrt
{
namespace scene
{

namespace
{

int firstPiece(vtkPolyDataMapper* mapper)
{
  return mapper->GetNumberOfSubPieces() * mapper->GetPiece();
}

int pieces(vtkPolyDataMapper* mapper)
{
  return mapper->GetNumberOfSubPieces() * mapper->GetNumberOfPieces();
}

// Whether the producer was last asked for the mapper's piece: then it need not be told again, which takes
// most of the time of an update where nothing is new.
bool asksForThatPiece(vtkAlgorithm* producer, vtkPolyDataMapper* mapper)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const output = producer->GetOutputInformation(0);
  return output && output->Has(Pipeline::UPDATE_PIECE_NUMBER()) &&
    Pipeline::GetUpdatePiece(output) == firstPiece(mapper) &&
    Pipeline::GetUpdateNumberOfPieces(output) == pieces(mapper) &&
    Pipeline::GetUpdateGhostLevel(output) == mapper->GetGhostLevel();
}

} // namespace

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
    if (surface && connection->GetIndex() == 0 && !asksForThatPiece(producer, surface))
    {
      producer->UpdatePiece(firstPiece(surface), pieces(surface), surface->GetGhostLevel());
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
