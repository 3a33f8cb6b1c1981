// What each kind of mapper shows: which meshes, coloured by what, from which cells and blocks.
#include "SceneTest.h"

#include "Rendering/OpenGL2/CompositeMappers.h"

#include "vtkCellData.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataSetMapper.h"
#include "vtkDoubleArray.h"
#include "vtkHexahedron.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
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

} // anonymous namespace
