// See SideExtraction.h.
#include "Rendering/Scene/SideExtraction.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace hrt
{
namespace scene
{
namespace
{

constexpr std::uint32_t kAllSides = 7;

// A side of one of a cell's triangles, by the points at its ends.
struct Side
{
  std::pair<PointNumber, PointNumber> ends; // the lower number first
  std::size_t triangle;
  unsigned side;
};

//------------------------------------------------------------------------------
// Points may say that the border that starts at them is not to be shown.
vtkUnsignedCharArray* edgeFlags(vtkPolyData* input)
{
  auto* flags = vtkUnsignedCharArray::SafeDownCast(
    input->GetPointData()->GetAttribute(vtkDataSetAttributes::EDGEFLAG));
  return flags && flags->GetNumberOfComponents() == 1 &&
      flags->GetNumberOfTuples() >= input->GetNumberOfPoints()
    ? flags
    : nullptr;
}

// The triangles of one polygon: a diagonal is a side of two of them, a border of one.
class Polygon
{
public:
  Polygon(const VertexPoints& pointOf, vtkUnsignedCharArray* flags, Geometry& geometry)
    : PointOf(pointOf)
    , Flags(flags)
    , Mesh(geometry)
  {
  }

  void mark(std::size_t first, std::size_t end)
  {
    this->Sides.clear();
    for (std::size_t i = first; i < end; ++i)
    {
      for (unsigned side = 0; side < 3; ++side)
      {
        const PointNumber a = this->point(i, side), b = this->point(i, (side + 1) % 3);
        this->Sides.push_back({ std::minmax(a, b), i, side });
      }
    }
    std::sort(this->Sides.begin(), this->Sides.end(),
      [](const Side& a, const Side& b) { return a.ends < b.ends; });
    for (std::size_t i = 0; i < this->Sides.size();)
    {
      std::size_t next = i + 1;
      while (next < this->Sides.size() && this->Sides[next].ends == this->Sides[i].ends)
      {
        ++next;
      }
      if (next == i + 1 && this->isShown(this->Sides[i]))
      {
        this->Mesh.sides[this->Sides[i].triangle].edges |= 1u << this->Sides[i].side;
      }
      i = next;
    }
  }

private:
  PointNumber point(std::size_t triangle, unsigned corner) const
  {
    return this->PointOf[this->Mesh.triangles[triangle][corner]];
  }
  bool isShown(const Side& side) const
  {
    return !this->Flags || this->Flags->GetValue(this->point(side.triangle, side.side)) != 0;
  }

  const VertexPoints& PointOf;
  vtkUnsignedCharArray* Flags;
  Geometry& Mesh;
  std::vector<Side> Sides;
};

} // anonymous namespace

//------------------------------------------------------------------------------
void writeSides(vtkPolyData* input, const VertexPoints& pointOf, Geometry& geometry)
{
  const std::int64_t firstStrip =
    input->GetNumberOfVerts() + input->GetNumberOfLines() + input->GetNumberOfPolys();
  Polygon polygon(pointOf, edgeFlags(input), geometry);
  geometry.sides.assign(geometry.triangleCount(), TriangleSides());
  for (std::size_t first = 0; first < geometry.triangleCount();)
  {
    const std::int64_t cell = geometry.cellIds[first];
    std::size_t end = first + 1;
    while (end < geometry.triangleCount() && geometry.cellIds[end] == cell)
    {
      ++end;
    }
    if (cell < firstStrip)
    {
      polygon.mark(first, end);
    }
    for (std::size_t i = first; i < end && cell >= firstStrip; ++i)
    {
      geometry.sides[i].edges = kAllSides;
    }
    first = end;
  }
  connectSides(geometry);
}

} // namespace scene
} // namespace hrt
