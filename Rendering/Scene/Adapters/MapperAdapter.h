// What a mapper shows, told in one language. VTK has a dozen mappers that draw surfaces, each by
// rules of its own: an adapter a kind brings the mapper's pipeline up to date and yields the meshes
// that it would draw, with what each is coloured by and what it came from. The reader of the scene
// knows pieces and no mapper.
#pragma once

#include "Rendering/Core/Copies.h"
#include "Rendering/Scene/ActorClassification.h"

#include "vtkDataArray.h"
#include "vtkMapper.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkActor;
class vtkDataObject;

namespace hrt
{
namespace scene
{

// Where a piece has settings of its own that go before those of the actor's property.
struct PieceOverrides
{
  bool color = false; // one colour for ambient and diffuse light; scalars do not count
  glm::vec3 colorValue{ 1.0f };
  bool opacity = false; // in the property's place
  float opacityValue = 1.0f;
};

struct SurfacePiece
{
  vtkSmartPointer<vtkPolyData> data;
  vtkMapper* colors = nullptr; // its settings colour the data; the actor or the adapter keeps it
  // Of each cell of the data its number in the mapper's input; null: the same.
  vtkSmartPointer<vtkDataArray> originalCells;
  PieceOverrides overrides;
  // Where the data are there many times. Their bounds, which the mesh decides, are set by the reader.
  std::shared_ptr<Copies> copies;
  std::uint64_t key = 0;   // which of the mapper's pieces: the same in later frames
  std::int64_t block = -1; // flat index in composite data
};

struct MapperReading
{
  LeftToVTK left = LeftToVTK::No; // why the mapper cannot be read
  std::string problem;            // bad input, for a message; nothing is drawn
  std::vector<SurfacePiece> pieces;
};

// One an actor's path: it may keep what it has made for the next frame.
class MapperAdapter
{
public:
  virtual ~MapperAdapter() = default;
  virtual MapperReading read(vtkMapper* mapper, vtkActor* actor) = 0;
};

// The adapter of the first registered kind that reads the mapper; null when none does.
std::unique_ptr<MapperAdapter> makeAdapter(vtkMapper* mapper);

// Brings the first input of the mapper up to date as drawing it does, and returns it; null when there
// is none. Not by vtkMapper::Update: that runs the mapper too, as a consumer, after which a producer
// that releases its data (vtkAlgorithm::ReleaseDataFlagOn) has nothing to show.
vtkDataObject* updatedInput(vtkMapper* mapper);

} // namespace scene
} // namespace hrt
