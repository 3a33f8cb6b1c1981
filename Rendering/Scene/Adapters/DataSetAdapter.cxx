// vtkDataSetMapper: the outside of any vtkDataSet. VTK's mapper extracts it when it is drawn for the
// first time, which is never where we draw it; so it is extracted here, by the filter that VTK uses.
#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDataSetMapper.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

namespace hrt
{
namespace scene
{
namespace
{

class DataSetAdapter final : public MapperAdapter
{
public:
  MapperReading read(vtkMapper* mapper, vtkActor*) override
  {
    MapperReading reading;
    vtkDataObject* const data = updatedInput(mapper);
    if (!data)
    {
      reading.problem = "the mapper has no input; nothing is drawn";
      return reading;
    }
    auto* const input = vtkDataSet::SafeDownCast(data);
    if (!input)
    {
      reading.left = LeftToVTK::OtherData;
      return reading;
    }
    SurfacePiece piece;
    piece.colors = mapper;
    piece.data = vtkPolyData::SafeDownCast(input);
    if (!piece.data)
    {
      this->extract(input);
      piece.data = this->Surface;
      piece.originalCells = this->OriginalCells;
    }
    reading.pieces.push_back(std::move(piece));
    return reading;
  }

private:
  void extract(vtkDataSet* input)
  {
    if (this->Surface && this->Input == input && this->InputTime == input->GetMTime())
    {
      return;
    }
    vtkNew<vtkDataSetSurfaceFilter> filter;
    // A copy, so that the filter is no consumer of the user's pipeline.
    const auto copy = vtkSmartPointer<vtkDataSet>::Take(input->NewInstance());
    copy->ShallowCopy(input);
    filter->SetInputData(copy);
    // Under a name that no user's array has; extracting cells leaves one of VTK's default name.
    filter->SetOriginalCellIdsName("vtkHybridOriginalCellIds");
    filter->PassThroughCellIdsOn();
    filter->Update();
    this->Surface = filter->GetOutput();
    this->OriginalCells =
      this->Surface->GetCellData()->GetArray(filter->GetOriginalCellIdsName());
    this->Input = input;
    this->InputTime = input->GetMTime();
  }

  const void* Input = nullptr; // compared only; times are unique in the process
  vtkMTimeType InputTime = 0;
  vtkSmartPointer<vtkPolyData> Surface;
  vtkSmartPointer<vtkDataArray> OriginalCells;
};

} // namespace

//------------------------------------------------------------------------------
AdapterKind dataSetKind()
{
  return { [](vtkMapper* mapper) { return vtkDataSetMapper::SafeDownCast(mapper) != nullptr; },
    [] { return std::unique_ptr<MapperAdapter>(std::make_unique<DataSetAdapter>()); } };
}

} // namespace scene
} // namespace hrt
