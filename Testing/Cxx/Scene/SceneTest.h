// What every test of this folder needs: a renderer with a window that is never drawn, the scene
// that reads it, an ear for the scene's messages, and meshes written out by hand.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Testing/Cxx/Meshes.h"
#include "vtkHybridScene.h"

#include "vtkActor.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkLight.h"
#include "vtkMapper.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// Collects the warnings and errors of one object, which are then not printed.
class Messages
{
public:
  explicit Messages(vtkObject* source)
    : Source(source)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback(
      [](vtkObject*, unsigned long event, void* self, void* text)
      {
        auto& lists = *static_cast<Messages*>(self);
        (event == vtkCommand::ErrorEvent ? lists.errors : lists.warnings)
          .emplace_back(static_cast<const char*>(text));
      });
    this->Tags = { source->AddObserver(vtkCommand::WarningEvent, this->Command),
      source->AddObserver(vtkCommand::ErrorEvent, this->Command) };
  }
  ~Messages()
  {
    for (unsigned long tag : this->Tags)
    {
      this->Source->RemoveObserver(tag);
    }
  }
  Messages(const Messages&) = delete;
  void operator=(const Messages&) = delete;

  std::vector<std::string> warnings;
  std::vector<std::string> errors;

private:
  vtkSmartPointer<vtkObject> Source;
  vtkNew<vtkCallbackCommand> Command;
  std::array<unsigned long, 2> Tags{};
};

inline std::string addressOf(const void* object)
{
  std::ostringstream text;
  text << object;
  return text.str();
}

using Cells = std::vector<std::vector<vtkIdType>>;

inline vtkSmartPointer<vtkCellArray> makeCells(const Cells& cells)
{
  auto array = vtkSmartPointer<vtkCellArray>::New();
  for (const auto& cell : cells)
  {
    array->InsertNextCell(static_cast<vtkIdType>(cell.size()), cell.data());
  }
  return array;
}

inline vtkSmartPointer<vtkPolyData> makeMesh(const std::vector<glm::dvec3>& points,
  const Cells& polygons, int precision = VTK_DOUBLE, const Cells& strips = {})
{
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataType(precision);
  for (const glm::dvec3& p : points)
  {
    coordinates->InsertNextPoint(p.x, p.y, p.z);
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(coordinates);
  mesh->SetPolys(makeCells(polygons));
  if (!strips.empty())
  {
    mesh->SetStrips(makeCells(strips));
  }
  return mesh;
}

// Two triangles of the unit square, split along the diagonal from (0, 0) to (1, 1).
inline vtkSmartPointer<vtkPolyData> makeSquare()
{
  return makeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 }, { 0, 2, 3 } });
}

inline vtkSmartPointer<vtkActor> makeActor(vtkPolyData* mesh)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

class SceneTest : public ::testing::Test
{
protected:
  SceneTest()
  {
    this->window->SetOffScreenRendering(1);
    this->window->SetSize(320, 200);
    this->window->AddRenderer(this->renderer);
    // Else VTK places the camera by the bounds of cells, for which it reads points by indices that
    // the tests of refusals spoil.
    this->renderer->GetActiveCamera();
  }

  vtkSmartPointer<vtkActor> addMesh(vtkPolyData* mesh)
  {
    auto actor = makeActor(mesh);
    this->renderer->AddActor(actor);
    return actor;
  }

  // Reads the renderer as the pass does: lights follow the camera first.
  const hrt::Snapshot& update()
  {
    this->renderer->UpdateLightsGeometryToFollowCamera();
    this->scene->Update(this->renderer);
    this->snapshot = this->scene->GetSnapshot();
    return *this->snapshot;
  }

  // The geometry of the only part, after an update.
  const hrt::Geometry& onlyGeometry()
  {
    this->update();
    if (this->snapshot->parts.size() != 1u)
    {
      throw std::runtime_error("the test expects exactly one part");
    }
    return *this->snapshot->parts[0].geometry;
  }

  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkHybridScene> scene;
  Messages messages{ this->scene };
  std::shared_ptr<const hrt::Snapshot> snapshot;
};

// Twice the area vector of a triangle, in double.
inline glm::dvec3 areaVector(const hrt::Geometry& geometry, std::size_t triangle)
{
  const auto p = geometry.cornerPositions(triangle);
  const glm::dvec3 a(p[0]);
  return glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
}
