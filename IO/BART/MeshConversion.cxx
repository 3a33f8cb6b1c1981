// Implements the conversion of meshes. Points are made in the order in which the corners first name
// them, so that the same file always gives the same points.
#include "IO/BART/MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>

namespace hrt
{
namespace bart
{
namespace
{

//------------------------------------------------------------------------------
vtkSmartPointer<vtkFloatArray> makeArray(const char* name, int components)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  return array;
}

//------------------------------------------------------------------------------
// One point for each combination of indices that occurs.
class PointMaker
{
public:
  explicit PointMaker(const Mesh& mesh)
    : Source(mesh)
  {
    this->Normals = mesh.normals.empty() ? nullptr : makeArray("Normals", 3);
    this->Coordinates = mesh.coordinates.empty() ? nullptr : makeArray("TextureCoordinates", 2);
  }

  vtkIdType pointOf(const Corner& corner)
  {
    const std::array<int, 3> key = { corner.vertex, corner.normal, corner.coordinate };
    const auto [known, isNew] = this->Known.emplace(key, this->Points->GetNumberOfPoints());
    if (isNew)
    {
      this->add(corner);
    }
    return known->second;
  }

  void give(vtkPolyData* surface)
  {
    surface->SetPoints(this->Points);
    surface->GetPointData()->SetNormals(this->Normals);
    surface->GetPointData()->SetTCoords(this->Coordinates);
  }

private:
  void add(const Corner& corner)
  {
    this->Points->InsertNextPoint(
      &this->Source.vertices[static_cast<std::size_t>(corner.vertex)].x);
    if (this->Normals)
    {
      this->Normals->InsertNextTuple(
        &this->Source.normals[static_cast<std::size_t>(corner.normal)].x);
    }
    if (this->Coordinates)
    {
      // AFF's v begins at the image's top row, VTK's at the bottom one.
      const glm::vec2& uv = this->Source.coordinates[static_cast<std::size_t>(corner.coordinate)];
      this->Coordinates->InsertNextTuple2(uv.x, 1.0 - uv.y);
    }
  }

  const Mesh& Source;
  std::map<std::array<int, 3>, vtkIdType> Known;
  vtkNew<vtkPoints> Points;
  vtkSmartPointer<vtkFloatArray> Normals;
  vtkSmartPointer<vtkFloatArray> Coordinates;
};

//------------------------------------------------------------------------------
void setTuple(vtkFloatArray* array, vtkIdType index, const glm::vec3& value, bool& changed)
{
  float* tuple = array->GetPointer(3 * index);
  changed = changed || !std::equal(tuple, tuple + 3, &value.x);
  std::copy_n(&value.x, 3, tuple);
}

} // anonymous namespace

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> toPolyData(const Mesh& mesh)
{
  PointMaker points(mesh);
  vtkNew<vtkCellArray> faces;
  std::size_t corner = 0;
  for (std::size_t face = 0; corner < mesh.corners.size(); ++face)
  {
    const std::size_t end = mesh.faceEnds.empty() ? corner + 3 : mesh.faceEnds[face];
    faces->InsertNextCell(static_cast<int>(end - corner));
    for (; corner < end; ++corner)
    {
      faces->InsertCellPoint(points.pointOf(mesh.corners[corner]));
    }
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPolys(faces);
  points.give(surface);
  return surface;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> toPolyData(const AnimatedTriangles& triangles)
{
  const vtkIdType size = 3 * static_cast<vtkIdType>(triangles.size());
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(size);
  std::fill_n(vtkFloatArray::SafeDownCast(points->GetData())->GetPointer(0), 3 * size, 0.0f);
  auto normals = makeArray("Normals", 3);
  normals->SetNumberOfTuples(size);
  normals->FillValue(0.0f);
  vtkNew<vtkCellArray> faces;
  for (vtkIdType first = 0; first < size; first += 3)
  {
    faces->InsertNextCell({ first, first + 1, first + 2 });
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(faces);
  surface->GetPointData()->SetNormals(normals);
  return surface;
}

//------------------------------------------------------------------------------
bool moveTo(const AnimatedTriangles& triangles, double time, vtkPolyData* surface)
{
  auto* points = vtkFloatArray::SafeDownCast(surface->GetPoints()->GetData());
  auto* normals = vtkFloatArray::SafeDownCast(surface->GetPointData()->GetNormals());
  bool changed = false;
  vtkIdType point = 0;
  for (const AnimatedTriangle& triangle : triangles)
  {
    const AnimatedTriangle::Corners corners = cornersAt(triangle, time);
    for (std::size_t i = 0; i < 3; ++i, ++point)
    {
      setTuple(points, point, corners.positions[i], changed);
      setTuple(normals, point, corners.normals[i], changed);
    }
  }
  if (changed)
  {
    points->Modified();
    normals->Modified();
    surface->GetPoints()->Modified();
    surface->Modified();
  }
  return changed;
}

} // namespace bart
} // namespace hrt
