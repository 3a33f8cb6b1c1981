// Reads the results of vtkMapper::MapScalars by the rules of vtkOpenGLPolyDataMapper's
// BuildBufferObjects, which decides what the colours belong to.

#include "Rendering/Scene/ColorExtraction.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkMapper.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include "vtkVersion.h"

#include <algorithm>
#include <cmath>

// Before VTK 9.3 the coordinates of scalars in their lookup table take the place of those of textures.
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
#define HRT_ONE_SET_OF_COORDINATES 1
#else
#define HRT_ONE_SET_OF_COORDINATES 0
#endif

namespace hrt
{
namespace scene
{
namespace
{

// What the mapper's colours are attached to.
enum class Mapped
{
  Points,
  Cells,
  OneTuple // the whole part has the colour of one tuple of field data
};

//------------------------------------------------------------------------------
Mapped whatIsMapped(vtkMapper* mapper, vtkPolyData* input)
{
  const int mode = mapper->GetScalarMode();
  if (mode == VTK_SCALAR_MODE_USE_FIELD_DATA && mapper->GetFieldDataTupleId() > -1)
  {
    return Mapped::OneTuple;
  }
  if (mode == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA)
  {
    return Mapped::Points;
  }
  const bool cells = mode == VTK_SCALAR_MODE_USE_CELL_DATA ||
    mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA || mode == VTK_SCALAR_MODE_USE_FIELD_DATA;
  return cells || !input->GetPointData()->GetScalars() ? Mapped::Cells : Mapped::Points;
}

//------------------------------------------------------------------------------
vtkIdType tuplesNeeded(Mapped mapped, vtkMapper* mapper, vtkPolyData* input)
{
  switch (mapped)
  {
    case Mapped::Points:
      return input->GetNumberOfPoints();
    case Mapped::Cells:
      return input->GetNumberOfCells();
    case Mapped::OneTuple:
      return mapper->GetFieldDataTupleId() + 1;
  }
  return 0;
}

//------------------------------------------------------------------------------
// One to four components: grey, grey and alpha, RGB, RGBA, as in a texture.
glm::u8vec4 readColor(vtkUnsignedCharArray* colors, vtkIdType tuple)
{
  const int components = colors->GetNumberOfComponents();
  const unsigned char* c = colors->GetPointer(tuple * components);
  switch (components)
  {
    case 1:
      return glm::u8vec4(c[0], c[0], c[0], 255);
    case 2:
      return glm::u8vec4(c[0], c[0], c[0], c[1]);
    case 3:
      return glm::u8vec4(c[0], c[1], c[2], 255);
    default:
      return glm::u8vec4(c[0], c[1], c[2], c[3]);
  }
}

//------------------------------------------------------------------------------
bool writeCorners(vtkUnsignedCharArray* colors, vtkMapper* mapper, vtkPolyData* input,
  const VertexPoints& pointOf, Geometry& geometry)
{
  const Mapped mapped = whatIsMapped(mapper, input);
  if (colors->GetNumberOfTuples() < tuplesNeeded(mapped, mapper, input))
  {
    return false;
  }
  geometry.colorSource = ColorSource::Corner;
  std::vector<glm::u8vec4>& values = geometry.colors.values;
  if (mapped == Mapped::Points)
  {
    values.reserve(pointOf.size());
    for (const PointNumber point : pointOf)
    {
      values.push_back(readColor(colors, point));
    }
    return true;
  }
  geometry.colors.attachment = Attachment::Triangles;
  values.reserve(geometry.triangleCount());
  for (std::size_t i = 0; i < geometry.triangleCount(); ++i)
  {
    values.push_back(readColor(
      colors, mapped == Mapped::Cells ? geometry.cellIds[i] : mapper->GetFieldDataTupleId()));
  }
  return true;
}

//------------------------------------------------------------------------------
// VTK gives a scalar that is not a number a place in the table's row of the NaN colour. A scalar or a
// range that is infinite gives it coordinates that are no numbers themselves, and no texel: they are
// given the same place.
glm::vec2 readCoordinates(vtkFloatArray* coordinates, vtkIdType point)
{
  const float* st = coordinates->GetPointer(2 * point);
  return std::isfinite(st[0]) && std::isfinite(st[1]) ? glm::vec2(st[0], st[1])
                                                      : glm::vec2(0.5f, 1.0f);
}

//------------------------------------------------------------------------------
// Scalars are interpolated before they are mapped: coordinates at the points into a table of
// texels.
bool writeLookup(vtkFloatArray* coordinates, vtkImageData* table, vtkPolyData* input,
  const VertexPoints& pointOf, Geometry& geometry)
{
  auto* texels = vtkUnsignedCharArray::SafeDownCast(table->GetPointData()->GetScalars());
  const int* size = table->GetDimensions();
  const vtkIdType count = static_cast<vtkIdType>(size[0]) * size[1];
  if (!texels || texels->GetNumberOfTuples() < count || count == 0 ||
    coordinates->GetNumberOfComponents() != 2 ||
    coordinates->GetNumberOfTuples() < input->GetNumberOfPoints())
  {
    return false;
  }
  geometry.colorSource = ColorSource::Lookup;
  geometry.lookupWidth = size[0];
  geometry.lookupHeight = size[1];
  geometry.lookup.reserve(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    geometry.lookup.push_back(readColor(texels, i));
  }
  geometry.coordinates.values.reserve(pointOf.size());
  for (const PointNumber point : pointOf)
  {
    geometry.coordinates.values.push_back(readCoordinates(coordinates, point));
  }
  return true;
}

} // anonymous namespace

//------------------------------------------------------------------------------
bool writeColors(
  vtkMapper* mapper, vtkPolyData* input, const VertexPoints& pointOf, Geometry& geometry)
{
  // Opacity 1: the property's opacity is multiplied in when shading, as in VTK's shaders.
  mapper->MapScalars(input, 1.0);
  vtkUnsignedCharArray* colors = mapper->GetColorMapColors();
  vtkFloatArray* coordinates = mapper->GetColorCoordinates();
  if (colors && colors->GetNumberOfTuples() > 0)
  {
    return writeCorners(colors, mapper, input, pointOf, geometry);
  }
  if (coordinates && mapper->GetColorTextureMap())
  {
    return writeLookup(coordinates, mapper->GetColorTextureMap(), input, pointOf, geometry);
  }
  geometry.colorSource = ColorSource::Property;
  return true;
}

//------------------------------------------------------------------------------
void writeTextureCoordinates(
  vtkPolyData* input, const VertexPoints& pointOf, Geometry& geometry)
{
  if (HRT_ONE_SET_OF_COORDINATES && geometry.colorSource == ColorSource::Lookup)
  {
    geometry.textureCoordinates = geometry.coordinates;
    return;
  }
  vtkDataArray* array = input->GetPointData()->GetTCoords();
  const int components = array ? array->GetNumberOfComponents() : 0;
  if ((components != 1 && components != 2) ||
    array->GetNumberOfTuples() < input->GetNumberOfPoints())
  {
    return;
  }
  const auto read = [array](PointNumber point, int component)
  {
    const auto value = static_cast<float>(array->GetComponent(point, component));
    return std::isfinite(value) ? value : 0.0f;
  };
  std::vector<glm::vec2>& values = geometry.textureCoordinates.values;
  values.reserve(pointOf.size());
  for (const PointNumber point : pointOf)
  {
    values.emplace_back(read(point, 0), components == 2 ? read(point, 1) : 0.0f);
  }
}

} // namespace scene
} // namespace hrt
