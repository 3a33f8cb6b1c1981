// Which sides of triangles are edges of cells, and how the property wants them drawn.
#include "SceneTest.h"

#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkProperty.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <set>

namespace
{

class EdgesOf : public SceneTest
{
protected:
  vtkProperty* show(vtkPolyData* mesh)
  {
    this->actor = this->addMesh(mesh);
    this->actor->GetProperty()->EdgeVisibilityOn();
    return this->actor->GetProperty();
  }

  // The marked sides by the places of their ends, lower one first.
  using Segment = std::pair<std::array<float, 2>, std::array<float, 2>>;
  std::multiset<Segment> marked()
  {
    const hrt::Geometry& mesh = this->onlyGeometry();
    std::multiset<Segment> segments;
    for (std::size_t i = 0; i < mesh.sides.size(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        if (mesh.sides[i].isEdge(k))
        {
          const auto corners = mesh.cornerPositions(i);
          const auto at = [&](int corner)
          {
            const glm::vec3& p = corners[static_cast<std::size_t>(corner % 3)];
            return std::array<float, 2>{ p.x, p.y };
          };
          segments.insert(std::minmax(at(k), at(k + 1)));
        }
      }
    }
    return segments;
  }
  static Segment segment(float x0, float y0, float x1, float y1)
  {
    return std::minmax(std::array<float, 2>{ x0, y0 }, std::array<float, 2>{ x1, y1 });
  }

  vtkSmartPointer<vtkActor> actor;
};

const std::vector<glm::dvec3> kSquare = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };

TEST_F(EdgesOf, OnlyWhereTheyAreShown)
{
  vtkProperty* property = this->show(makeMesh(kSquare, { { 0, 1, 2, 3 } }));
  EXPECT_EQ(this->onlyGeometry().sides.size(), 2u);
  const std::uint64_t version = this->onlyGeometry().version;
  EXPECT_TRUE(this->snapshot->parts[0].showsEdges());
  property->EdgeVisibilityOff();
  EXPECT_TRUE(this->onlyGeometry().sides.empty());
  EXPECT_FALSE(this->snapshot->parts[0].showsEdges());
  EXPECT_NE(this->onlyGeometry().version, version);
}

TEST_F(EdgesOf, DiagonalsOfPolygonsAreNone)
{
  this->show(makeMesh(kSquare, { { 0, 1, 2, 3 } }));
  const std::multiset<Segment> expected = { segment(0, 0, 1, 0), segment(1, 0, 1, 1),
    segment(1, 1, 0, 1), segment(0, 1, 0, 0) };
  EXPECT_EQ(this->marked(), expected);
  EXPECT_EQ(this->snapshot->parts[0].geometry->sides[0].neighbours[2], 1u);
}

TEST_F(EdgesOf, TrianglesHaveThreeEach)
{
  this->show(makeSquare());
  EXPECT_EQ(this->marked().size(), 6u);
  EXPECT_EQ(this->marked().count(segment(0, 0, 1, 1)), 2u) << "of either";
}

// A concave polygon, cut into ears: the border is marked and nothing else.
TEST_F(EdgesOf, ConcavePolygonsShowTheirBorder)
{
  this->show(makeMesh({ { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 1, 0.5, 0 }, { 0, 2, 0 } },
    { { 3, 4, 0, 1, 2 } }));
  const std::multiset<Segment> expected = { segment(0, 0, 2, 0), segment(2, 0, 2, 2),
    segment(2, 2, 1, 0.5f), segment(1, 0.5f, 0, 2), segment(0, 2, 0, 0) };
  EXPECT_EQ(this->marked(), expected);
}

// As VTK has it: its mapper marks no diagonals in strips.
TEST_F(EdgesOf, StripsShowEverySide)
{
  this->show(makeMesh(kSquare, {}, VTK_DOUBLE, { { 0, 1, 3, 2 } }));
  EXPECT_EQ(this->marked().size(), 6u);
  EXPECT_EQ(this->marked().count(segment(1, 0, 0, 1)), 2u);
}

TEST_F(EdgesOf, NeighboursMayBeOfOtherCells)
{
  this->show(makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 2, 0, 0 },
                        { 2, 1, 0 } },
    { { 0, 1, 2, 3 }, { 1, 4, 5, 2 } }));
  const hrt::Geometry& mesh = this->onlyGeometry();
  std::size_t connected = 0;
  for (const hrt::TriangleSides& sides : mesh.sides)
  {
    connected += static_cast<std::size_t>(std::count_if(sides.neighbours.begin(),
      sides.neighbours.end(), [](std::uint32_t n) { return n != hrt::kNoNeighbour; }));
  }
  EXPECT_EQ(connected, 6u) << "two diagonals and the common side, from both sides";
  EXPECT_EQ(this->marked().count(segment(1, 0, 1, 1)), 2u);
}

TEST_F(EdgesOf, PointsMaySwitchTheirsOff)
{
  const auto mesh = makeMesh(kSquare, { { 0, 1, 2, 3 } });
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName("edges");
  for (const unsigned char flag : { 1, 0, 1, 0 })
  {
    flags->InsertNextValue(flag);
  }
  mesh->GetPointData()->SetAttribute(flags, vtkDataSetAttributes::EDGEFLAG);
  this->show(mesh);
  const std::multiset<Segment> expected = { segment(0, 0, 1, 0), segment(1, 1, 0, 1) };
  EXPECT_EQ(this->marked(), expected);
}

TEST_F(EdgesOf, StyleIsTheProperties)
{
  vtkProperty* property = this->show(makeSquare());
  property->SetEdgeColor(0.25, 0.5, 0.75);
  property->SetLineWidth(4.0f);
  const hrt::EdgeStyle& style = this->update().parts[0].material.edges;
  EXPECT_EQ(style.color, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(style.width, 4.0f);
  EXPECT_EQ(style.opacity, 1.0f);
  EXPECT_FALSE(style.tubes);
  property->SetLineWidth(1.0f);
  property->RenderLinesAsTubesOn();
  EXPECT_EQ(this->update().parts[0].material.edges.width, 1.1f) << "VTK draws none thinner";
  EXPECT_TRUE(this->snapshot->parts[0].material.edges.tubes);
  EXPECT_TRUE(this->scene->GetChanges().materials);
  EXPECT_FALSE(this->scene->GetChanges().geometry);
}

} // namespace
