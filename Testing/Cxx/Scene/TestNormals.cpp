// Which normals a part has: those that VTK's mapper would hand to its shader.
#include "SceneTest.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkPointData.h"
#include "vtkProperty.h"

#include <limits>

namespace
{

class Normals : public SceneTest
{
protected:
  Normals()
    : mesh(makeSquare())
    , actor(this->addMesh(this->mesh))
  {
  }

  static vtkSmartPointer<vtkFloatArray> array(const std::vector<glm::vec3>& values)
  {
    auto normals = vtkSmartPointer<vtkFloatArray>::New();
    normals->SetNumberOfComponents(3);
    for (const glm::vec3& n : values)
    {
      normals->InsertNextTuple3(n.x, n.y, n.z);
    }
    return normals;
  }

  // Of the only part, after an update.
  std::vector<glm::vec3> atCorners()
  {
    const hrt::Geometry& g = this->onlyGeometry();
    return hrt::meshes::atCorners(g, g.normals);
  }

  void addPointNormals() { this->mesh->GetPointData()->SetNormals(array(this->ofPoints)); }
  void addCellNormals() { this->mesh->GetCellData()->SetNormals(array(this->ofCells)); }

  vtkSmartPointer<vtkPolyData> mesh;
  vtkSmartPointer<vtkActor> actor;
  std::vector<glm::vec3> ofPoints = { { 0, 0, 2 }, { 1, 0, 1 }, { 0, 1, 1 }, { -1, 0, 1 } };
  const std::vector<glm::vec3> ofCells = { { 0, 1, 1 }, { 1, 0, 1 } };
  // The square's triangles are 0 1 2 and 0 2 3.
  const std::vector<glm::vec3> corners = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 0, 0 },
    { 1, 1, 0 }, { 0, 1, 0 } };
  std::vector<glm::vec3> expectedOfPoints() const
  {
    return { this->ofPoints[0], this->ofPoints[1], this->ofPoints[2], this->ofPoints[0],
      this->ofPoints[2], this->ofPoints[3] };
  }
  std::vector<glm::vec3> expectedOfCells() const
  {
    return { this->ofCells[0], this->ofCells[0], this->ofCells[0], this->ofCells[1],
      this->ofCells[1], this->ofCells[1] };
  }
};

TEST_F(Normals, AreAbsentWithoutArrays)
{
  EXPECT_TRUE(this->onlyGeometry().normals.empty());
}

TEST_F(Normals, OfPointsAreCopiedUnchanged)
{
  this->addPointNormals();
  EXPECT_EQ(this->atCorners(), this->expectedOfPoints());
}

TEST_F(Normals, OfPointsWinOverThoseOfCells)
{
  this->addPointNormals();
  this->addCellNormals();
  EXPECT_EQ(this->atCorners(), this->expectedOfPoints());
}

TEST_F(Normals, OfCellsAreStoredOnceATriangle)
{
  this->addCellNormals();
  EXPECT_EQ(this->atCorners(), this->expectedOfCells());
  const hrt::Geometry& g = *this->snapshot->parts[0].geometry;
  EXPECT_EQ(g.normals.attachment, hrt::Attachment::Triangles);
  EXPECT_EQ(g.normals.values, this->ofCells);
  EXPECT_EQ(g.vertexCount(), 4u) << "normals of cells part no vertices";
}

TEST_F(Normals, FlatShadingForgetsThoseOfPoints)
{
  this->addPointNormals();
  this->actor->GetProperty()->SetInterpolationToFlat();
  EXPECT_TRUE(this->onlyGeometry().normals.empty());
}

TEST_F(Normals, FlatShadingStillUsesThoseOfCells)
{
  this->addPointNormals();
  this->addCellNormals();
  this->actor->GetProperty()->SetInterpolationToFlat();
  EXPECT_EQ(this->atCorners(), this->expectedOfCells());
}

TEST_F(Normals, OfDoublePrecisionAreRounded)
{
  vtkNew<vtkDoubleArray> normals;
  normals->SetNumberOfComponents(3);
  for (int i = 0; i < 4; ++i)
  {
    normals->InsertNextTuple3(0.1, 0.2, 0.3 + i);
  }
  this->mesh->GetPointData()->SetNormals(normals);
  EXPECT_EQ(this->atCorners()[1], glm::vec3(0.1f, 0.2f, 1.3f));
}

TEST_F(Normals, ThatAreNotNumbersAreReplacedByTheFaces)
{
  this->ofPoints[1].y = std::numeric_limits<float>::quiet_NaN(); // of the first triangle only
  this->addPointNormals();
  const std::vector<glm::vec3> normals = this->atCorners();
  ASSERT_EQ(normals.size(), 6u);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(normals[i], glm::vec3(0, 0, 1));
    EXPECT_EQ(normals[3 + i], this->expectedOfPoints()[3 + i]);
  }
  const hrt::Geometry& g = *this->snapshot->parts[0].geometry;
  EXPECT_EQ(g.vertexCount(), 6u) << "the triangles share no vertex now";
  EXPECT_EQ(hrt::meshes::cornersOf(g), this->corners) << "but lie where they did";
  EXPECT_EQ(this->snapshot->refusals.total(), 0u);
  EXPECT_TRUE(this->messages.warnings.empty()) << "VTK says nothing of them either";
}

TEST_F(Normals, OfLengthZeroAreReplacedByTheFaces)
{
  this->ofPoints.assign(4, glm::vec3(0));
  this->addPointNormals();
  EXPECT_EQ(this->atCorners(), std::vector<glm::vec3>(6, glm::vec3(0, 0, 1)));
  EXPECT_TRUE(this->messages.warnings.empty());
}

} // anonymous namespace
