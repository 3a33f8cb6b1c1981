// Rows 8 and 10 at the scene's door: what a broken file or a careless script makes of a vtkPolyData is
// refused and counted, and what is let in is fit for every engine. Meant for the sanitizers above all
// (`./run asan`).
#include "Testing/Cxx/Scene/SceneTest.h"
#include "Testing/Fuzz/SnapshotInvariants.h"
#include "Testing/Stress/Stress.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkTypeInt64Array.h"

#include <cstring>

using namespace hrt;
using namespace hrt::stress;

namespace
{

class SceneDoor : public SceneTest
{
};

template <class Value>
Value anyBits(scenes::Random& random)
{
  std::uint32_t words[2] = { static_cast<std::uint32_t>(random(0.0, 0x1p32)),
    static_cast<std::uint32_t>(random(0.0, 0x1p32)) };
  Value value;
  std::memcpy(&value, words, sizeof value);
  return value;
}

// One number in 32 is spoilt, as in Embree's garbage test.
constexpr std::size_t kSpoiltOneIn = 32;

double coordinate(scenes::Random& random, bool wild)
{
  return wild || random.below(kSpoiltOneIn) == 0 ? double(anyBits<float>(random))
                                                 : random(-1.0, 1.0);
}

vtkIdType index(scenes::Random& random, std::size_t points)
{
  return random.below(kSpoiltOneIn) == 0
    ? static_cast<vtkIdType>(anyBits<std::int32_t>(random))
    : static_cast<vtkIdType>(random.below(points));
}

Cells randomCells(scenes::Random& random, std::size_t points, std::size_t most)
{
  Cells cells(random.below(most + 1));
  for (auto& cell : cells)
  {
    cell.resize(random.below(4) == 0 ? random.below(8) : 3);
    for (vtkIdType& id : cell)
    {
      id = index(random, points);
    }
  }
  return cells;
}

vtkSmartPointer<vtkDataArray> randomArray(
  scenes::Random& random, int components, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples * components; ++i)
  {
    array->SetValue(i, static_cast<float>(coordinate(random, false)));
  }
  return array;
}

vtkSmartPointer<vtkPolyData> randomMesh(scenes::Random& random)
{
  const bool wild = random.below(4) == 0;
  std::vector<glm::dvec3> points(1 + random.below(100));
  for (glm::dvec3& p : points)
  {
    p = { coordinate(random, wild), coordinate(random, wild), coordinate(random, wild) };
  }
  auto mesh = makeMesh(points, randomCells(random, points.size(), 255),
    random.below(2) ? VTK_DOUBLE : VTK_FLOAT,
    random.below(3) ? Cells() : randomCells(random, points.size(), 20));
  if (random.below(2))
  {
    mesh->GetPointData()->SetNormals(randomArray(random, 3, mesh->GetNumberOfPoints()));
  }
  if (random.below(2))
  {
    mesh->GetPointData()->SetScalars(randomArray(random, 1, mesh->GetNumberOfPoints()));
  }
  return mesh;
}

void randomPlacement(vtkActor* actor, scenes::Random& random)
{
  vtkNew<vtkMatrix4x4> matrix;
  for (int k = 0; k < 12; ++k)
  {
    matrix->SetElement(k / 4, k % 4, coordinate(random, random.below(16) == 0));
  }
  actor->SetUserMatrix(matrix);
}

} // namespace

TEST_F(SceneDoor, Row08GarbageIsRefusedAndCounted)
{
  constexpr int kMeshes = 20;
  const std::size_t count = scaled(1000.0, 20.0);
  scenes::Random random(80);
  Refusals sum;
  std::size_t admitted = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    this->renderer->RemoveAllViewProps();
    for (int k = 0; k < kMeshes; ++k)
    {
      auto actor = this->addMesh(randomMesh(random));
      if (random.below(2))
      {
        randomPlacement(actor, random);
      }
    }
    const Snapshot& s = this->update();
    ASSERT_EQ(invariants::broken(s), "") << "scene " << i;
    admitted += s.triangleCount;
    sum.nonFinitePoints += s.refusals.nonFinitePoints;
    sum.invalidIndices += s.refusals.invalidIndices;
    sum.degenerateTriangles += s.refusals.degenerateTriangles;
    sum.emptyParts += s.refusals.emptyParts;
    sum.singularMatrices += s.refusals.singularMatrices;
    sum.outOfRangeParts += s.refusals.outOfRangeParts;
    for (const Engine& engine : kEngines)
    {
      const auto structure = engine.make();
      structure->update(s);
      for (int k = 0; k < 10; ++k)
      {
        const Hit hit = structure->intersect(rayTo(random.inBox(3.0), random.inBox(1.0)));
        ASSERT_TRUE(!hit.valid() || hit.triangle < s.triangleCount);
      }
    }
  }
  report(8, "scene door",
    "no crash in %zu scenes of 20 meshes; %zu triangles admitted; refused: %zu for points, %zu for "
    "indices, %zu without area; %zu parts empty, %zu matrices singular, %zu parts out of range",
    count, admitted, std::size_t(sum.nonFinitePoints), std::size_t(sum.invalidIndices),
    std::size_t(sum.degenerateTriangles), std::size_t(sum.emptyParts),
    std::size_t(sum.singularMatrices), std::size_t(sum.outOfRangeParts));
  EXPECT_GT(sum.nonFinitePoints, 0u);
  EXPECT_GT(sum.invalidIndices, 0u);
  EXPECT_GT(sum.degenerateTriangles, 0u);
  EXPECT_GT(admitted, 0u);
}

TEST_F(SceneDoor, Row10ManyActors)
{
  const std::size_t count = scaled(1e5, 1000.0);
  auto square = makeSquare();
  for (std::size_t i = 0; i < count; ++i)
  {
    auto actor = this->addMesh(square);
    actor->SetPosition(double(i % 300) * 2.0, double(i / 300) * 2.0, 0.0);
  }
  const Snapshot& s = this->update();
  EXPECT_EQ(s.parts.size(), count);
  EXPECT_EQ(s.triangleCount, 2 * count);
  EXPECT_EQ(invariants::broken(s), "");
  std::size_t wrong = 0;
  const auto structure = kEngines[0].make();
  structure->update(s);
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::dvec3 at = glm::dvec3(double(i % 300) * 2.0 + 0.7, double(i / 300) * 2.0 + 0.2, 0.0) - s.origin;
    wrong += structure->intersect(rayTo(at + glm::dvec3(0, 0, 1), at)).triangle == 2 * i ? 0 : 1;
  }
  report(10, "actors", "%zu of %zu actors wrong (0 allowed)", wrong, count);
  EXPECT_EQ(wrong, 0u);
}
