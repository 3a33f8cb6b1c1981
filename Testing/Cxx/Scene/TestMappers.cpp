// What each kind of mapper shows: which meshes, coloured by what, from which cells and blocks.
#include "SceneTest.h"

#include "Rendering/OpenGL2/CompositeMappers.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataSetMapper.h"
#include "vtkDoubleArray.h"
#include "vtkGlyph3DMapper.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersion.h"

// In a module that not every VTK has.
#if __has_include("vtkLODActor.h")
#include "vtkLODActor.h"
#endif

// The mapper that draws blocks was a class of its own before VTK 9.3, which deprecates it.
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
#include "vtkCompositePolyDataMapper2.h"
using BlocksMapper = vtkCompositePolyDataMapper2;
#else
#include "vtkCompositePolyDataMapper.h"
using BlocksMapper = vtkCompositePolyDataMapper;
#endif

namespace
{

class Mappers : public SceneTest
{
protected:
  Mappers() { this->renderer->AddActor(this->actor); }

  std::vector<std::int64_t> cells(const hrt::Part& part)
  {
    std::vector<std::int64_t> ids;
    for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
    {
      ids.push_back(part.geometry->cellIds[i]);
    }
    return ids;
  }

  vtkNew<vtkActor> actor;
};

// A row of cubes, three points apart; the middle one is a cell of no volume.
vtkSmartPointer<vtkUnstructuredGrid> makeGrid(int cubes)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  grid->Allocate(cubes);
  for (int i = 0; i < cubes; ++i)
  {
    vtkIdType ids[8];
    for (int k = 0; k < 8; ++k)
    {
      const int x = (k % 4 == 1 || k % 4 == 2) ? 1 : 0, y = k % 4 >= 2 ? 1 : 0, z = k / 4;
      ids[k] = points->InsertNextPoint(3.0 * i + x, y, z);
    }
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  grid->SetPoints(points);
  return grid;
}

TEST_F(Mappers, DataSetsShowTheirOutsideWithTheCellsOfTheInput)
{
  vtkNew<vtkDataSetMapper> mapper;
  auto grid = makeGrid(2);
  mapper->SetInputData(grid);
  this->actor->SetMapper(mapper);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 1u);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
  const std::vector<std::int64_t> ids = this->cells(s.parts[0]);
  ASSERT_EQ(ids.size(), 24u);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), 0), 12);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), 1), 12);
  EXPECT_EQ(mapper->GetPolyDataMapper(), nullptr) << "VTK's own extraction is not needed";

  const std::uint64_t version = s.parts[0].geometry->version;
  EXPECT_EQ(this->update().parts.at(0).geometry->version, version);
  grid->GetPoints()->SetPoint(0, -1, 0, 0);
  grid->GetPoints()->Modified();
  EXPECT_NE(this->update().parts.at(0).geometry->version, version);
}

TEST_F(Mappers, DataSetsAreColouredByTheMappersOwnSettings)
{
  vtkNew<vtkDataSetMapper> mapper;
  auto grid = makeGrid(2);
  vtkNew<vtkDoubleArray> values;
  values->InsertNextValue(0.0);
  values->InsertNextValue(1.0);
  grid->GetCellData()->SetScalars(values);
  mapper->SetInputData(grid);
  this->actor->SetMapper(mapper);
  const hrt::Snapshot& s = this->update();
  const hrt::Geometry& g = *s.parts.at(0).geometry;
  ASSERT_EQ(g.colorSource, hrt::ColorSource::Corner);
  EXPECT_NE(g.colors.values.front(), g.colors.values.back());
  mapper->ScalarVisibilityOff();
  EXPECT_EQ(this->update().parts.at(0).geometry->colorSource, hrt::ColorSource::Property);
}

TEST_F(Mappers, DataSetsOfEveryKind)
{
  vtkNew<vtkDataSetMapper> mapper;
  this->actor->SetMapper(mapper);
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 2, 1);
  mapper->SetInputData(image);
  EXPECT_EQ(this->update().triangleCount, 4u);
  image->SetDimensions(2, 2, 2);
  EXPECT_EQ(this->update().triangleCount, 12u);
  mapper->SetInputData(makeSquare());
  EXPECT_EQ(this->update().triangleCount, 2u);
}

// The scene is no consumer whose end lets a producer release what it has made.
TEST_F(Mappers, ReleasedInputsAreThereInEveryFrame)
{
  vtkNew<vtkSphereSource> source;
  source->ReleaseDataFlagOn();
  for (vtkMapper* mapper : { static_cast<vtkMapper*>(vtkPolyDataMapper::New()),
         static_cast<vtkMapper*>(vtkDataSetMapper::New()) })
  {
    mapper->SetInputConnection(source->GetOutputPort());
    this->actor->SetMapper(mapper);
    mapper->Delete();
    for (int frame = 0; frame < 3; ++frame)
    {
      source->SetRadius(1.0 + frame);
      EXPECT_EQ(this->update().triangleCount, 96u) << mapper->GetClassName() << frame;
      this->actor->GetBounds(); // runs the mapper, and releases its input
      EXPECT_EQ(this->update().triangleCount, 96u) << mapper->GetClassName() << frame;
    }
  }
}

#if __has_include("vtkLODActor.h")
TEST_F(Mappers, LevelOfDetailActorsShowTheirFullMapper)
{
  vtkNew<vtkLODActor> detailed;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(makeSquare());
  detailed->SetMapper(mapper);
  this->renderer->AddActor(detailed);
  this->renderer->RemoveActor(this->actor);
  EXPECT_EQ(this->update().triangleCount, 2u);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(detailed));
}
#endif

//------------------------------------------------------------------------------
// Flat indices: 0 the root, 1 a square, 2 nothing, 3 a branch, 4 and 5 squares in it.
class Composite : public Mappers
{
protected:
  Composite()
  {
    hrt::gl::registerCompositeMappers();
    this->inner->SetBlock(0, this->squares[1]);
    this->inner->SetBlock(1, this->squares[2]);
    this->root->SetBlock(0, this->squares[0]);
    this->root->SetBlock(1, nullptr);
    this->root->SetBlock(2, this->inner);
    this->mapper->SetInputDataObject(this->root);
    this->mapper->SetCompositeDataDisplayAttributes(this->attributes);
    this->actor->SetMapper(this->mapper);
  }

  std::vector<std::int64_t> blocks()
  {
    std::vector<std::int64_t> all;
    for (const hrt::Part& part : this->update().parts)
    {
      all.push_back(part.source.block);
      EXPECT_EQ(part.source.prop, 0u);
    }
    return all;
  }

  std::array<vtkSmartPointer<vtkPolyData>, 3> squares{ makeSquare(), makeSquare(), makeSquare() };
  vtkNew<vtkMultiBlockDataSet> root, inner;
  vtkNew<vtkCompositeDataDisplayAttributes> attributes;
  vtkNew<BlocksMapper> mapper;
};

TEST_F(Composite, EachBlockIsAPart)
{
  EXPECT_EQ(this->blocks(), (std::vector<std::int64_t>{ 1, 4, 5 }));
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
  EXPECT_EQ(this->scene->GetProp(0), this->actor.Get());
  EXPECT_EQ(this->scene->GetProp(1), nullptr);
}

TEST_F(Composite, BlocksInheritVisibility)
{
  this->attributes->SetBlockVisibility(this->inner, false);
  EXPECT_EQ(this->blocks(), std::vector<std::int64_t>{ 1 });
  this->attributes->SetBlockVisibility(this->squares[2], true);
  EXPECT_EQ(this->blocks(), (std::vector<std::int64_t>{ 1, 5 }));
}

TEST_F(Composite, BlocksInheritColoursWhichGoBeforeScalars)
{
  vtkNew<vtkDoubleArray> values;
  for (double v : { 0.0, 1.0, 2.0, 3.0 })
  {
    values->InsertNextValue(v);
  }
  this->squares[1]->GetPointData()->SetScalars(values);
  const double red[3] = { 1, 0, 0 }, green[3] = { 0, 1, 0 };
  EXPECT_EQ(this->update().parts.at(1).geometry->colorSource, hrt::ColorSource::Corner);
  this->attributes->SetBlockColor(this->inner, red);
  this->attributes->SetBlockColor(this->squares[2], green);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 3u);
  EXPECT_EQ(s.parts[0].material.front.diffuseColor, glm::vec3(1, 1, 1));
  EXPECT_EQ(s.parts[1].material.front.diffuseColor, glm::vec3(1, 0, 0));
  EXPECT_EQ(s.parts[1].geometry->colorSource, hrt::ColorSource::Property);
  EXPECT_EQ(s.parts[2].material.back.ambientColor, glm::vec3(0, 1, 0));
}

TEST_F(Composite, BlocksWithoutTheArrayMayHaveTheColourOfNaN)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName("values");
  values->SetNumberOfTuples(4);
  values->Fill(1.0);
  this->squares[1]->GetPointData()->AddArray(values);
  vtkNew<vtkLookupTable> table;
  table->SetNanColor(0.25, 0.5, 0.75, 1.0);
  this->mapper->SetLookupTable(table);
  this->mapper->SetScalarModeToUsePointFieldData();
  this->mapper->SelectColorArray("values");
  const double red[3] = { 1, 0, 0 };
  this->attributes->SetBlockColor(this->squares[2], red);
  const auto colorOf = [&](std::size_t part) {
    return this->update().parts.at(part).material.front.diffuseColor;
  };
  EXPECT_EQ(colorOf(0), glm::vec3(1, 1, 1));
  EXPECT_EQ(colorOf(2), glm::vec3(1, 0, 0));
  this->mapper->ColorMissingArraysWithNanColorOn();
  EXPECT_EQ(colorOf(0), glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(this->update().parts[1].geometry->colorSource, hrt::ColorSource::Corner);
  EXPECT_EQ(colorOf(2), glm::vec3(0.25f, 0.5f, 0.75f)) << "before the block's own colour";
  vtkNew<vtkColorTransferFunction> function;
  function->AddRGBPoint(0.0, 1.0, 0.0, 0.0);
  function->SetNanColor(0.5, 0.5, 0.25);
  this->mapper->SetLookupTable(function);
  EXPECT_EQ(colorOf(0), glm::vec3(0.5f, 0.5f, 0.25f));
  this->mapper->ScalarVisibilityOff();
  EXPECT_EQ(colorOf(0), glm::vec3(1, 1, 1));
}

TEST_F(Composite, BlocksOfOpacityZeroAreNotThere)
{
  this->attributes->SetBlockOpacity(this->squares[0], 0.0);
  EXPECT_EQ(this->blocks(), (std::vector<std::int64_t>{ 4, 5 }));
}

TEST_F(Composite, BlocksAreColouredByTheirOwnScalars)
{
  for (int i = 0; i < 2; ++i)
  {
    vtkNew<vtkDoubleArray> values;
    values->SetNumberOfTuples(4);
    values->Fill(i);
    this->squares[i]->GetPointData()->SetScalars(values);
  }
  const hrt::Snapshot& s = this->update();
  const hrt::Geometry &first = *s.parts.at(0).geometry, &second = *s.parts.at(1).geometry;
  ASSERT_EQ(first.colorSource, hrt::ColorSource::Corner);
  EXPECT_NE(first.colors.values.front(), second.colors.values.front());
  EXPECT_EQ(s.parts.at(2).geometry->colorSource, hrt::ColorSource::Property);
  const std::uint64_t version = second.version;
  this->squares[0]->GetPointData()->GetScalars()->Fill(0.5);
  this->squares[0]->GetPointData()->GetScalars()->Modified();
  EXPECT_EQ(this->update().parts.at(1).geometry->version, version) << "another block has changed";
  this->mapper->ScalarVisibilityOff();
  EXPECT_EQ(this->update().parts.at(0).geometry->colorSource, hrt::ColorSource::Property);
}

TEST_F(Composite, PolyDataIsOneBlock)
{
  this->mapper->SetInputDataObject(this->squares[0]);
  EXPECT_EQ(this->blocks(), std::vector<std::int64_t>{ 0 });
}

//------------------------------------------------------------------------------
class Glyphs : public Mappers
{
protected:
  Glyphs()
  {
    vtkNew<vtkPoints> points;
    for (int i = 0; i < 4; ++i)
    {
      points->InsertNextPoint(1e6 + 10.0 * i, i, 0);
    }
    this->places->SetPoints(points);
    this->mapper->SetInputData(this->places);
    this->mapper->SetSourceData(makeSquare());
    this->mapper->ScalingOff();
    this->actor->SetMapper(this->mapper);
  }

  vtkDoubleArray* addArray(const char* name, int components, const std::vector<double>& values)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    for (double v : values)
    {
      array->InsertNextValue(v);
    }
    this->places->GetPointData()->AddArray(array);
    return array;
  }

  // Where a copy of the only part puts the square's corner (1, 0, 0), seen from the glyph's point.
  glm::dvec3 corner(std::size_t copy)
  {
    const hrt::Part& part = this->update().parts.at(0);
    return glm::dvec3(part.copies->matrix(copy)[0]);
  }

  vtkNew<vtkPolyData> places;
  vtkNew<vtkGlyph3DMapper> mapper;
};

TEST_F(Glyphs, AreCopiesOfOneMesh)
{
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 1u);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
  ASSERT_TRUE(s.parts[0].copies);
  EXPECT_EQ(s.parts[0].copyCount(), 4u);
  EXPECT_EQ(s.triangleCount, 8u);
  EXPECT_EQ(s.parts[0].copies->id(3), 3);
  EXPECT_EQ(s.boundsMin, glm::dvec3(1e6, 0, 0));
  EXPECT_EQ(s.boundsMax, glm::dvec3(1e6 + 31, 4, 0));
  const auto version = s.parts[0].copies->version;
  EXPECT_EQ(this->update().parts[0].copies->version, version);
  EXPECT_FALSE(this->scene->GetChanges().any());
}

TEST_F(Glyphs, FollowScaleModesAndClamping)
{
  this->addArray("size", 1, { 1, 2, 3, 4 });
  this->addArray("sizes", 3, { 1, 1, 1, 2, 3, 4, 0, 0, 0, 5, 6, 7 });
  this->mapper->ScalingOn();
  this->mapper->SetScaleFactor(0.5);
  EXPECT_EQ(this->corner(2).x, 0.5) << "no array";
  this->mapper->SetScaleArray("size");
  this->mapper->SetScaleModeToScaleByMagnitude();
  EXPECT_EQ(this->corner(2).x, 1.5);
  this->mapper->ClampingOn();
  this->mapper->SetRange(1.0, 3.0);
  EXPECT_EQ(this->corner(1).x, 0.25);
  EXPECT_EQ(this->corner(3).x, 0.5);
  this->mapper->ClampingOff();
  this->mapper->SetScaleArray("sizes");
  this->mapper->SetScaleModeToScaleByVectorComponents();
  EXPECT_EQ(this->corner(3).x, 2.5);
  EXPECT_EQ(this->corner(2).x, float(1e-10)) << "nothing is as good as nothing";
}

TEST_F(Glyphs, FollowOrientationModes)
{
  this->addArray("turn", 3, { 0, 0, 90, 0, 0, 0, 1, 0, 0, 0, 1, 0 });
  this->mapper->SetOrientationArray("turn");
  this->mapper->SetOrientationModeToRotation();
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b) < 1e-6; // single precision
  };
  EXPECT_TRUE(near(this->corner(0), { 0, 1, 0 }));
  EXPECT_TRUE(near(this->corner(1), { 1, 0, 0 }));
  this->mapper->SetOrientationModeToDirection();
  EXPECT_TRUE(near(this->corner(0), { 0, 0, 1 }));
  EXPECT_TRUE(near(this->corner(2), { 1, 0, 0 }));
  EXPECT_TRUE(near(this->corner(3), { 0, 1, 0 }));
  this->addArray("quaternion", 4, { 1, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0 });
  this->mapper->SetOrientationArray("quaternion");
  this->mapper->SetOrientationModeToQuaternion();
  EXPECT_TRUE(near(this->corner(0), { 1, 0, 0 }));
  EXPECT_TRUE(near(this->corner(1), { -1, 0, 0 }));
  this->mapper->OrientOff();
  EXPECT_TRUE(near(this->corner(1), { 1, 0, 0 }));
}

TEST_F(Glyphs, AnArrayThatDoesNotFitIsSpokenOfAndNothingDrawn)
{
  this->addArray("turn", 2, { 0, 0, 1, 1, 2, 2, 3, 3 });
  this->mapper->SetOrientationArray("turn");
  EXPECT_TRUE(this->update().parts.empty());
  ASSERT_EQ(this->messages.warnings.size(), 1u);
  EXPECT_NE(this->messages.warnings[0].find("orientation array"), std::string::npos);
}

TEST_F(Glyphs, MasksAndSourcesChoose)
{
  vtkNew<vtkBitArray> mask;
  mask->SetName("mask");
  for (int bit : { 1, 0, 1, 1 })
  {
    mask->InsertNextValue(bit);
  }
  this->places->GetPointData()->AddArray(mask);
  this->mapper->MaskingOn();
  this->mapper->SetMaskArray("mask");
  EXPECT_EQ(this->update().parts.at(0).copyCount(), 3u);
  EXPECT_EQ(this->snapshot->parts[0].copies->id(1), 2);
  this->mapper->MaskingOff();
  this->addArray("kind", 1, { 0, 1, 1, 9 });
  this->mapper->SetSourceData(1, makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } }));
  this->mapper->SetSourceIndexArray("kind");
  this->mapper->SetSourceIndexing(true);
  this->mapper->SetRange(0, 2);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_EQ(s.parts[0].copyCount(), 1u);
  EXPECT_EQ(s.parts[1].copyCount(), 3u);
  EXPECT_EQ(s.parts[1].copies->id(2), 3);
  EXPECT_EQ(s.triangleCount, 5u);
}

TEST_F(Glyphs, AreColouredByTheScalarsOfTheirPoints)
{
  this->places->GetPointData()->SetScalars(this->addArray("value", 1, { 0, 1, 2, 3 }));
  this->mapper->SetScalarRange(0, 3);
  const hrt::Part& part = this->update().parts.at(0);
  ASSERT_EQ(part.copies->colors.size(), 4u);
  EXPECT_NE(part.copies->colors[0], part.copies->colors[3]);
  EXPECT_EQ(part.geometry->colorSource, hrt::ColorSource::Property) << "not by the source's";
  this->mapper->ScalarVisibilityOff();
  EXPECT_TRUE(this->update().parts.at(0).copies->colors.empty());
}

TEST_F(Glyphs, ThatPlanesCutAreLeft)
{
  vtkNew<vtkPlane> plane;
  this->mapper->AddClippingPlane(plane);
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  EXPECT_FALSE(this->scene->IsHosted(this->actor));
}

TEST_F(Glyphs, OfLinesAreHosted)
{
  vtkNew<vtkPolyData> line;
  line->ShallowCopy(makeSquare());
  line->SetLines(makeCells({ { 0, 1 } }));
  this->mapper->SetSourceData(line);
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  EXPECT_FALSE(this->scene->IsHosted(this->actor));
  line->SetPolys(nullptr);
  this->update();
  EXPECT_TRUE(this->scene->IsHosted(this->actor));
}

} // anonymous namespace
