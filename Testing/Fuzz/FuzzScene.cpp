// The scene's door under fire: bytes become actors whose meshes, arrays, colours and matrices may be
// anything that vtkPolyData can hold, the scene is read twice with a change in between, and what comes
// out must keep the snapshot's promises and be fit for the ray structure and the tracer.
#include "Testing/Cxx/TracedImages.h"
#include "Testing/Fuzz/Bytes.h"
#include "Testing/Fuzz/SnapshotInvariants.h"

#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Scene/vtkHybridMaterial.h"
#include "Rendering/Scene/vtkHybridScene.h"

#include "vtkActor.h"
#include "vtkActorCollection.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkLight.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using hrt::fuzz::Bytes;

namespace
{

constexpr unsigned int kMostPoints = 24, kMostCells = 24, kMostCorners = 9, kMostActors = 4;

// Mostly a point that exists.
vtkIdType index(Bytes& bytes, vtkIdType points)
{
  const unsigned int kind = bytes.byte();
  return kind >= 250 ? static_cast<vtkIdType>(bytes.take<std::int32_t>())
                     : static_cast<vtkIdType>(kind) % (points > 0 ? points : 1);
}

vtkSmartPointer<vtkCellArray> cells(Bytes& bytes, vtkIdType points)
{
  auto array = vtkSmartPointer<vtkCellArray>::New();
  const unsigned int count = bytes.below(kMostCells);
  for (unsigned int i = 0; i < count; ++i)
  {
    // Mostly triangles.
    const unsigned int kind = bytes.byte();
    std::vector<vtkIdType> ids(kind < 128 ? 3 : kind % kMostCorners);
    for (vtkIdType& id : ids)
    {
      id = index(bytes, points);
    }
    array->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  return array;
}

// Of any number of components and any length, the right ones among them.
vtkSmartPointer<vtkDataArray> attributes(Bytes& bytes, vtkIdType expected)
{
  vtkSmartPointer<vtkDataArray> array;
  switch (bytes.below(3))
  {
    case 0:
      array = vtkSmartPointer<vtkFloatArray>::New();
      break;
    case 1:
      array = vtkSmartPointer<vtkDoubleArray>::New();
      break;
    default:
      array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  }
  const int components = 1 + static_cast<int>(bytes.below(4));
  const vtkIdType tuples = bytes.below(8) == 0 ? bytes.below(2 * kMostPoints) : expected;
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  const bool bytesOnly = array->GetDataType() == VTK_UNSIGNED_CHAR;
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      array->SetComponent(i, k, bytesOnly ? double(bytes.byte()) : bytes.number());
    }
  }
  return array;
}

vtkSmartPointer<vtkPolyData> mesh(Bytes& bytes)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const unsigned int flags = bytes.byte();
  if (flags != 255)
  {
    vtkNew<vtkPoints> points;
    points->SetDataType(flags & 1 ? VTK_DOUBLE : VTK_FLOAT);
    const unsigned int count = bytes.below(kMostPoints);
    for (unsigned int i = 0; i < count; ++i)
    {
      const double x = bytes.number(), y = bytes.number(), z = bytes.number();
      points->InsertNextPoint(x, y, z);
    }
    data->SetPoints(points);
  }
  const vtkIdType points = data->GetNumberOfPoints();
  data->SetPolys(cells(bytes, points));
  if (flags & 2)
  {
    data->SetStrips(cells(bytes, points));
  }
  if (flags & 4)
  {
    data->GetPointData()->SetNormals(attributes(bytes, points));
  }
  if (flags & 8)
  {
    data->GetPointData()->SetScalars(attributes(bytes, points));
  }
  if (flags & 16)
  {
    data->GetCellData()->SetScalars(attributes(bytes, data->GetNumberOfCells()));
  }
  if (flags & 32)
  {
    data->GetCellData()->SetNormals(attributes(bytes, data->GetNumberOfCells()));
  }
  return data;
}

vtkSmartPointer<vtkActor> actor(Bytes& bytes)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh(bytes));
  const unsigned int coloring = bytes.byte();
  mapper->SetScalarVisibility(coloring & 1);
  mapper->SetInterpolateScalarsBeforeMapping((coloring >> 1) & 1);
  mapper->SetColorMode(static_cast<int>((coloring >> 2) % 3));
  mapper->SetScalarMode(static_cast<int>((coloring >> 4) % 3));
  if (coloring & 128)
  {
    const double low = bytes.number(), high = bytes.number();
    mapper->SetScalarRange(low, high);
  }
  auto made = vtkSmartPointer<vtkActor>::New();
  made->SetMapper(mapper);
  const unsigned int look = bytes.byte();
  made->GetProperty()->SetInterpolation(static_cast<int>(look % 3));
  made->GetProperty()->SetOpacity(look & 4 ? 0.5 : 1.0);
  made->GetProperty()->SetFrontfaceCulling((look >> 3) & 1);
  if (look & 16)
  {
    vtkHybridMaterial::SetReflectance(made, 0.5);
  }
  if (look & 32)
  {
    vtkHybridMaterial::SetGlass(made, 1.5);
  }
  if (look & 64)
  {
    vtkNew<vtkMatrix4x4> matrix;
    for (int i = 0; i < 12; ++i)
    {
      matrix->SetElement(i / 4, i % 4, bytes.number());
    }
    made->SetUserMatrix(matrix);
  }
  return made;
}

void require(const std::string& broken)
{
  if (!broken.empty())
  {
    std::fprintf(stderr, "broken promise: %s\n", broken.c_str());
    std::abort();
  }
}

// The snapshot keeps its promises, and the engines can work with it.
void check(const hrt::Snapshot& snapshot, hrt::BvhStructure& structure)
{
  require(hrt::invariants::broken(snapshot));
  structure.update(snapshot);
  hrt::PrimaryHits hits;
  hrt::castPrimaryRays(snapshot, structure, {}, hits);
  for (const std::uint32_t id : hits.ids)
  {
    require(id <= snapshot.triangleCount ? "" : "a pixel's id is out of range");
  }
  hrt::SecondaryImage image;
  hrt::traceImage(snapshot, structure, hrt::TracerSettings(), hits.ids.data(), image);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  // Refusals are announced by warnings: thousands a second.
  vtkObject::GlobalWarningDisplayOff();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  window->SetOffScreenRendering(1);
  window->SetSize(8, 6);
  window->AddRenderer(renderer);
  renderer->GetActiveCamera()->SetPosition(0.5, 1.0, 12.0);
  renderer->GetActiveCamera()->SetClippingRange(0.1, 100.0);
  vtkNew<vtkLight> light;
  light->SetPositional(true);
  light->SetPosition(3, 5, 4);
  renderer->AddLight(light);
  for (unsigned int i = 0; i < kMostActors && !bytes.empty(); ++i)
  {
    renderer->AddActor(actor(bytes));
  }

  vtkNew<vtkHybridScene> scene;
  hrt::BvhStructure structure;
  scene->Update(renderer);
  check(*scene->GetSnapshot(), structure);

  // A second frame, in which one mesh is another and one actor has gone.
  if (vtkActor* first = renderer->GetActors()->GetLastActor())
  {
    vtkPolyDataMapper::SafeDownCast(first->GetMapper())->SetInputData(mesh(bytes));
    if (bytes.below(2))
    {
      renderer->RemoveActor(first);
    }
    scene->Update(renderer);
    check(*scene->GetSnapshot(), structure);
  }
  return 0;
}
