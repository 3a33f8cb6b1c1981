// See HostedCells.h.
#include "Rendering/Scene/HostedCells.h"

#include "Rendering/Scene/VTKConversions.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkMapper.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
// Cells are numbered verts, lines, polygons, strips: the first ones are what is wanted.
void copyFirstCells(vtkPolyData* from, vtkIdType count, vtkPolyData* to)
{
  vtkCellData* const source = from->GetCellData();
  vtkCellData* const target = to->GetCellData();
  target->CopyAllOn();
  target->CopyAllocate(source, count);
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    target->CopyData(source, cell, cell);
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> vertsAndLines(vtkPolyData* from)
{
  auto to = vtkSmartPointer<vtkPolyData>::New();
  to->SetPoints(from->GetPoints());
  to->GetPointData()->ShallowCopy(from->GetPointData());
  to->GetFieldData()->ShallowCopy(from->GetFieldData());
  to->SetVerts(from->GetVerts());
  to->SetLines(from->GetLines());
  copyFirstCells(from, from->GetNumberOfVerts() + from->GetNumberOfLines(), to);
  return to;
}

//------------------------------------------------------------------------------
void copySettings(vtkMapper* from, vtkMapper* to)
{
  to->vtkMapper::ShallowCopy(from); // not the input, which the mappers' own kind copies too
  double factor = 0.0, units = 0.0;
  from->GetRelativeCoincidentTopologyLineOffsetParameters(factor, units);
  to->SetRelativeCoincidentTopologyLineOffsetParameters(factor, units);
  from->GetRelativeCoincidentTopologyPointOffsetParameter(units);
  to->SetRelativeCoincidentTopologyPointOffsetParameter(units);
}

//------------------------------------------------------------------------------
bool hasVertsOrLines(const SurfacePiece& piece)
{
  return piece.data->GetNumberOfVerts() > 0 || piece.data->GetNumberOfLines() > 0;
}

} // namespace

//------------------------------------------------------------------------------
bool HostedCells::neededFor(const SurfacePiece& piece, vtkActor* actor)
{
  return hasVertsOrLines(piece) || actor->GetProperty()->GetVertexVisibility();
}

//------------------------------------------------------------------------------
// The vertices of a surface are its data drawn as points, in one colour.
void HostedCells::make(
  Shown& shown, bool vertices, const SurfacePiece& piece, vtkProperty* property)
{
  const glm::vec3& color = piece.overrides.colorValue;
  const Signature signature(piece.data.GetPointer(), piece.data->GetMTime(),
    piece.colors, piece.colors->GetMTime(), property, property->GetMTime(),
    piece.overrides.color, color.x, color.y, color.z);
  if (shown.actor && shown.signature == signature)
  {
    return;
  }
  shown.signature = signature;
  vtkNew<vtkPolyDataMapper> mapper;
  if (vertices)
  {
    mapper->SetInputData(piece.data);
  }
  else
  {
    mapper->SetInputData(vertsAndLines(piece.data));
  }
  copySettings(piece.colors, mapper);
  vtkNew<vtkProperty> own;
  own->DeepCopy(property);
  own->VertexVisibilityOff();
  if (vertices || piece.overrides.color)
  {
    mapper->ScalarVisibilityOff();
    own->SetColor(color.x, color.y, color.z);
  }
  if (vertices)
  {
    own->SetRepresentationToPoints();
    own->SetColor(property->GetVertexColor());
  }
  shown.actor = vtkSmartPointer<vtkActor>::New();
  shown.actor->SetMapper(mapper);
  shown.actor->SetProperty(own);
  shown.actor->PickableOff();
}

//------------------------------------------------------------------------------
std::vector<vtkActor*> HostedCells::update(
  const SurfacePiece& piece, vtkActor* actor, const glm::dmat4& localToWorld)
{
  vtkProperty* const property = actor->GetProperty();
  std::vector<vtkActor*> actors;
  if (hasVertsOrLines(piece))
  {
    this->make(this->Cells, false, piece, property);
    actors.push_back(this->Cells.actor);
  }
  if (property->GetVertexVisibility())
  {
    this->make(this->Vertices, true, piece, property);
    actors.push_back(this->Vertices.actor);
  }
  for (vtkActor* shown : actors)
  {
    shown->SetTexture(actor->GetTexture());
    if (!shown->GetUserMatrix() || toMatrix(shown->GetUserMatrix()) != localToWorld)
    {
      shown->SetUserMatrix(fromMatrix(localToWorld));
    }
  }
  return actors;
}

} // namespace scene
} // namespace hrt
