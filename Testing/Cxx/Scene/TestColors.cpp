// Scalar colours, each compared with what vtkMapper itself gives for the same settings.
#include "SceneTest.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <limits>

namespace
{

class Colors : public SceneTest
{
protected:
  Colors()
    : mesh(makeSquare())
    , actor(this->addMesh(this->mesh))
    , mapper(this->actor->GetMapper())
  {
    this->mapper->SetScalarRange(0.0, 3.0);
  }

  static vtkSmartPointer<vtkDoubleArray> scalars(
    const char* name, const std::vector<double>& values)
  {
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(name);
    for (double v : values)
    {
      array->InsertNextValue(v);
    }
    return array;
  }

  // The mapper's own colour of a tuple.
  glm::u8vec4 mapped(vtkIdType tuple)
  {
    vtkUnsignedCharArray* colors = this->mapper->MapScalars(1.0);
    EXPECT_NE(colors, nullptr);
    EXPECT_EQ(colors->GetNumberOfComponents(), 4);
    const unsigned char* c = colors->GetPointer(4 * tuple);
    return glm::u8vec4(c[0], c[1], c[2], c[3]);
  }

  // Corner colours of the square's triangles 0 1 2 and 0 2 3 by the given tuples.
  void expectCorners(const std::vector<vtkIdType>& tuples)
  {
    const hrt::Geometry& g = this->onlyGeometry();
    EXPECT_EQ(g.colorSource, hrt::ColorSource::Corner);
    const std::vector<glm::u8vec4> colors = hrt::meshes::atCorners(g, g.colors);
    ASSERT_EQ(colors.size(), tuples.size());
    for (std::size_t i = 0; i < tuples.size(); ++i)
    {
      EXPECT_EQ(colors[i], this->mapped(tuples[i])) << i;
    }
    EXPECT_EQ(g.vertexCount(), 4u) << "no vertex is multiplied for its colour";
    EXPECT_TRUE(g.coordinates.empty());
  }

  const std::vector<vtkIdType> byPoint = { 0, 1, 2, 0, 2, 3 };
  const std::vector<vtkIdType> byCell = { 0, 0, 0, 1, 1, 1 };
  vtkSmartPointer<vtkPolyData> mesh;
  vtkSmartPointer<vtkActor> actor;
  vtkMapper* mapper;
};

TEST_F(Colors, AreThePropertysWithoutScalars)
{
  const hrt::Geometry& g = this->onlyGeometry();
  EXPECT_EQ(g.colorSource, hrt::ColorSource::Property);
  EXPECT_TRUE(g.colors.empty());
}

TEST_F(Colors, AreThePropertysWhenScalarsAreOff)
{
  this->mesh->GetPointData()->SetScalars(scalars("s", { 0, 1, 2, 3 }));
  this->mapper->ScalarVisibilityOff();
  EXPECT_EQ(this->onlyGeometry().colorSource, hrt::ColorSource::Property);
}

TEST_F(Colors, OfPointScalars)
{
  this->mesh->GetPointData()->SetScalars(scalars("s", { 0, 1, 2, 3 }));
  this->expectCorners(this->byPoint);
  EXPECT_NE(this->mapped(0), this->mapped(3)) << "else the test shows nothing";
}

TEST_F(Colors, OfCellScalars)
{
  this->mesh->GetCellData()->SetScalars(scalars("s", { 0, 3 }));
  this->expectCorners(this->byCell);
  EXPECT_NE(this->mapped(0), this->mapped(1));
}

TEST_F(Colors, OfPointsWinUnlessCellsAreAskedFor)
{
  this->mesh->GetPointData()->SetScalars(scalars("p", { 0, 1, 2, 3 }));
  this->mesh->GetCellData()->SetScalars(scalars("c", { 2, 1 }));
  this->expectCorners(this->byPoint);
  this->mapper->SetScalarModeToUseCellData();
  this->expectCorners(this->byCell);
}

TEST_F(Colors, OfSelectedArrays)
{
  this->mesh->GetPointData()->AddArray(scalars("p", { 3, 1, 2, 0 }));
  this->mesh->GetCellData()->AddArray(scalars("c", { 2, 1 }));
  this->mapper->SetScalarModeToUsePointFieldData();
  this->mapper->SelectColorArray("p");
  this->expectCorners(this->byPoint);
  this->mapper->SetScalarModeToUseCellFieldData();
  this->mapper->SelectColorArray("c");
  this->expectCorners(this->byCell);
}

TEST_F(Colors, OfFieldDataPerCellOrOneTuple)
{
  this->mesh->GetFieldData()->AddArray(scalars("f", { 0, 3 }));
  this->mapper->SetScalarModeToUseFieldData();
  this->mapper->SelectColorArray("f");
  this->expectCorners(this->byCell);
  this->mapper->SetFieldDataTupleId(1);
  this->expectCorners({ 1, 1, 1, 1, 1, 1 });
}

TEST_F(Colors, DirectBytesWithAlpha)
{
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetNumberOfComponents(4);
  for (int i = 0; i < 4; ++i)
  {
    bytes->InsertNextTuple4(10 * i, 255 - i, i, 255);
  }
  this->mesh->GetPointData()->SetScalars(bytes);
  this->expectCorners(this->byPoint);
  const hrt::Geometry& g = *this->snapshot->parts[0].geometry;
  EXPECT_EQ(hrt::meshes::atCorners(g, g.colors)[1], glm::u8vec4(10, 254, 1, 255));
}

TEST_F(Colors, InterpolatedScalarsGiveCoordinatesAndTheTable)
{
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(16);
  table->SetNanColor(0.1, 0.2, 0.3, 1.0);
  table->Build();
  this->mapper->SetLookupTable(table);
  this->mapper->InterpolateScalarsBeforeMappingOn();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  this->mesh->GetPointData()->SetScalars(scalars("s", { 0, 1.5, nan, 3 }));
  const hrt::Geometry& g = this->onlyGeometry();
  EXPECT_EQ(g.colorSource, hrt::ColorSource::Lookup);
  EXPECT_TRUE(g.colors.empty());

  this->mapper->MapScalars(1.0);
  vtkFloatArray* coordinates = this->mapper->GetColorCoordinates();
  const std::vector<glm::vec2> atCorners = hrt::meshes::atCorners(g, g.coordinates);
  ASSERT_EQ(atCorners.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_EQ(atCorners[i].x, coordinates->GetComponent(this->byPoint[i], 0));
    EXPECT_EQ(atCorners[i].y, coordinates->GetComponent(this->byPoint[i], 1));
  }
  // 16 colours, one below and one above the range; a second row for NaN.
  EXPECT_EQ(g.lookupWidth, 18);
  EXPECT_EQ(g.lookupHeight, 2);
  ASSERT_EQ(g.lookup.size(), 36u);
  auto* texels = vtkUnsignedCharArray::SafeDownCast(
    this->mapper->GetColorTextureMap()->GetPointData()->GetScalars());
  for (vtkIdType i = 0; i < 36; ++i)
  {
    const unsigned char* c = texels->GetPointer(4 * i);
    EXPECT_EQ(g.lookup[i], glm::u8vec4(c[0], c[1], c[2], c[3])) << i;
  }
  EXPECT_EQ(g.lookup[20], glm::u8vec4(26, 51, 77, 255)) << "the NaN colour, 0.1 0.2 0.3 in bytes";
}

// Infinity less infinity, or times nothing, is no number: what stands for it in VTK's own coordinates has
// no texel. It is shown as VTK shows scalars that are not numbers.
TEST_F(Colors, InfiniteScalarsAndRangesHaveTheColorOfNaN)
{
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  this->mapper->InterpolateScalarsBeforeMappingOn();
  this->mesh->GetPointData()->SetScalars(scalars("s", { nan, infinity, 1, -infinity }));
  for (double last : { infinity, 2.0 })
  {
    SCOPED_TRACE(last);
    this->mapper->SetScalarRange(0.0, last);
    const hrt::Geometry& g = this->onlyGeometry();
    this->mapper->MapScalars(1.0);
    vtkFloatArray* coordinates = this->mapper->GetColorCoordinates();
    const std::vector<glm::vec2> atCorners = hrt::meshes::atCorners(g, g.coordinates);
    ASSERT_EQ(atCorners.size(), 6u);
    const double* const ofNaN = coordinates->GetTuple2(0);
    const glm::vec2 nanPlace(ofNaN[0], ofNaN[1]);
    for (std::size_t i = 0; i < 6; ++i)
    {
      const double s = coordinates->GetComponent(this->byPoint[i], 0);
      EXPECT_EQ(atCorners[i],
        std::isnan(s) ? nanPlace : glm::vec2(s, coordinates->GetComponent(this->byPoint[i], 1)));
    }
    EXPECT_EQ(std::isnan(coordinates->GetComponent(1, 0)), last == infinity) << "what is tested";
  }
}

TEST_F(Colors, TurnToCornersWhenInterpolationIsSwitchedOff)
{
  this->mesh->GetPointData()->SetScalars(scalars("s", { 0, 1, 2, 3 }));
  this->mapper->InterpolateScalarsBeforeMappingOn();
  EXPECT_EQ(this->onlyGeometry().colorSource, hrt::ColorSource::Lookup);
  this->mapper->InterpolateScalarsBeforeMappingOff();
  this->expectCorners(this->byPoint);
}

TEST_F(Colors, FollowTheLookupTable)
{
  this->mesh->GetPointData()->SetScalars(scalars("s", { 0, 1, 2, 3 }));
  vtkNew<vtkLookupTable> table;
  table->Build();
  this->mapper->SetLookupTable(table);
  this->expectCorners(this->byPoint);
  const auto before = this->snapshot->parts[0].geometry->colors.values;
  table->SetHueRange(0.5, 0.9);
  table->ForceBuild();
  this->expectCorners(this->byPoint);
  EXPECT_NE(this->snapshot->parts[0].geometry->colors.values, before);
}

TEST_F(Colors, ThatDoNotCoverTheDataAreThePropertysWithOneWarning)
{
  this->mesh->GetCellData()->SetScalars(scalars("s", { 0 })); // two cells
  EXPECT_EQ(this->onlyGeometry().colorSource, hrt::ColorSource::Property);
  this->update();
  ASSERT_EQ(this->messages.warnings.size(), 1u);
  EXPECT_NE(this->messages.warnings[0].find("scalars"), std::string::npos);
}

} // anonymous namespace
