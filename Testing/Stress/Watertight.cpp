// Rows 1, 2 and 16: nothing slips through a closed mesh, however it is aimed and wherever it stands.
#include "Testing/Stress/Stress.h"

using namespace hrt;
using namespace hrt::stress;

namespace
{

class Watertight : public EveryEngine
{
};

// A closed mesh around a point, and its corners where the structure sees them.
struct ClosedMesh
{
  Snapshot snapshot;
  std::vector<Corners> corners;
  glm::dvec3 centre{ 0.0 };
  double spread = 0.0; // rays start at most so far, along each axis, from the centre

  void gather()
  {
    const Part& part = this->snapshot.parts.front();
    const glm::dmat4 toScene = positionsToScene(part, this->snapshot.origin);
    for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
    {
      this->corners.push_back(sceneCorners(*part.geometry, toScene, i));
    }
  }
};

// Embree's sphere: radius 2, here of 159,200 triangles.
constexpr int kColumns = 400, kRows = 200;
constexpr double kRadius = 2.0;

ClosedMesh placedSphere(const glm::dvec3& centre)
{
  ClosedMesh mesh;
  scenes::addPart(mesh.snapshot, scenes::sphere(kColumns, kRows),
    glm::scale(glm::translate(glm::dmat4(1.0), centre), glm::dvec3(kRadius)));
  mesh.centre = centre;
  mesh.spread = 0.5;
  mesh.gather();
  return mesh;
}

// The corners themselves are far away, in single precision: triangles collapse, others fold over, but
// the surface stays closed.
ClosedMesh sphereInFarFloats()
{
  std::vector<glm::vec3> positions = scenes::cornersOf(*scenes::sphere(kColumns, kRows));
  for (glm::vec3& p : positions)
  {
    p = glm::vec3(kRadius * glm::dvec3(p) + kFarAway);
  }
  ClosedMesh mesh;
  scenes::addPart(mesh.snapshot, scenes::makeGeometry(std::move(positions)));
  mesh.centre = kFarAway;
  mesh.spread = 0.5;
  mesh.gather();
  return mesh;
}

// pbrt's star: a sphere's grid whose corners lie at random distances from 1 to 6.
ClosedMesh star(std::uint32_t seed)
{
  scenes::Random random(seed);
  constexpr int columns = 16, rows = 16;
  double radii[rows + 1][columns];
  for (auto& row : radii)
  {
    for (double& radius : row)
    {
      radius = random(1.0, 6.0);
    }
  }
  auto geometry = scenes::grid(
    columns, rows,
    [&](double s, int j, int n) {
      const bool pole = j == 0 || j == n;
      const int i = pole ? 0 : static_cast<int>(s * columns + 0.5);
      const double a = 2.0 * scenes::kPi * s, b = scenes::kPi * (double(j) / n - 0.5);
      const glm::dvec3 d = pole
        ? glm::dvec3(0, 0, j == 0 ? -1 : 1)
        : glm::dvec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
      return radii[j][i] * d;
    },
    false);
  ClosedMesh mesh;
  scenes::addPart(mesh.snapshot, geometry);
  mesh.spread = 0.2;
  mesh.gather();
  return mesh;
}

enum class Aim
{
  Anywhere,
  Edge,
  Vertex
};

glm::dvec3 target(const ClosedMesh& mesh, const glm::dvec3& origin, Aim aim, scenes::Random& random)
{
  if (aim == Aim::Anywhere)
  {
    return origin + random.direction();
  }
  const Corners& c = mesh.corners[random.below(mesh.corners.size())];
  return aim == Aim::Vertex ? c.a : c.a + random(0.0, 1.0) * (c.b - c.a);
}

// Rays that hit nothing, or that no shadow caster stops.
std::size_t leaks(
  const Structure& structure, const ClosedMesh& mesh, Aim aim, std::size_t rays, std::uint32_t seed)
{
  return overChunks<std::size_t>(rays, seed, [&](scenes::Random& random, std::size_t count) {
    std::size_t lost = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const glm::dvec3 origin = mesh.centre + random.inBox(mesh.spread);
      const Ray ray = rayTo(origin, target(mesh, origin, aim, random));
      lost += structure.intersect(ray).valid() && structure.occluded(ray) ? 0 : 1;
    }
    return lost;
  });
}

void expectWatertight(
  int row, const std::string& name, const Structure& structure, const ClosedMesh& mesh, double full)
{
  const std::size_t random = scaled(full), aimed = scaled(0.4 * full);
  const std::size_t lost[] = { leaks(structure, mesh, Aim::Anywhere, random, 1),
    leaks(structure, mesh, Aim::Edge, aimed, 2), leaks(structure, mesh, Aim::Vertex, aimed, 3) };
  report(row, name,
    "%zu leaks of %zu random rays, %zu of %zu at edges, %zu of %zu at vertices (0 allowed)",
    lost[0], random, lost[1], aimed, lost[2], aimed);
  EXPECT_EQ(lost[0] + lost[1] + lost[2], 0u);
}

constexpr double kSphereRays = 10e6;
constexpr double kStarRays = 250e3; // of which 100,000 at vertices

} // namespace

TEST_P(Watertight, Row01SphereAtTheOrigin)
{
  const ClosedMesh mesh = placedSphere(glm::dvec3(0.0));
  expectWatertight(1, std::string("sphere ") + GetParam().name, *built(mesh.snapshot), mesh,
    kSphereRays);
}

TEST_P(Watertight, Row01SphereMovedFarAway)
{
  const ClosedMesh mesh = placedSphere(kFarAway);
  expectWatertight(1, std::string("sphere moved far ") + GetParam().name, *built(mesh.snapshot),
    mesh, kSphereRays);
}

TEST_P(Watertight, Row01SphereOfFarFloats)
{
  const ClosedMesh mesh = sphereInFarFloats();
  expectWatertight(1, std::string("sphere of far floats ") + GetParam().name,
    *built(mesh.snapshot), mesh, kSphereRays);
}

TEST_P(Watertight, Row02RadialStar)
{
  // Ten stars, and ten times pbrt's rays in all.
  for (std::uint32_t seed = 0; seed < 10; ++seed)
  {
    const ClosedMesh mesh = star(seed);
    expectWatertight(2, "star " + std::to_string(seed) + " " + GetParam().name,
      *built(mesh.snapshot), mesh, kStarRays);
  }
}

// Two triangles that share an edge, folded and turned at random; a grid of rays at points on the edge.
TEST_P(Watertight, Row16GridThroughASharedEdge)
{
  const std::size_t folds = scaled(1000.0, 20.0);
  constexpr int kGrid = 32;
  std::size_t missed = 0;
  scenes::Random random(16);
  for (std::size_t fold = 0; fold < folds; ++fold)
  {
    const glm::vec3 a(random.inBox(1.0)), b(random.inBox(1.0));
    // Straight across, so that the two triangles lie on either side of the edge for every ray below.
    const glm::vec3 side(
      0.5 * glm::normalize(glm::cross(glm::dvec3(b) - glm::dvec3(a), random.direction())));
    const glm::vec3 middle = 0.5f * (a + b);
    const glm::vec3 lift(random.inBox(0.1));
    Snapshot snapshot;
    scenes::addPart(snapshot,
      scenes::makeGeometry({ a, b, middle + side + lift, b, a, middle - side + lift }));
    const auto structure = built(snapshot);
    // From the side that both triangles face, so that their borders meet at the edge only.
    const glm::dvec3 up =
      glm::normalize(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(side)));
    for (int i = 1; i < kGrid; ++i)
    {
      const glm::dvec3 on = glm::mix(glm::dvec3(a), glm::dvec3(b), double(i) / kGrid);
      for (int j = 0; j < kGrid; ++j)
      {
        const glm::dvec3 from = on + 4.0 * up + 0.3 * random.inBox(1.0);
        missed += structure->intersect(rayTo(from, on)).valid() ? 0 : 1;
      }
    }
  }
  report(16, std::string("shared edge ") + GetParam().name, "%zu of %zu rays missed (0 allowed)",
    missed, folds * (kGrid - 1) * kGrid);
  EXPECT_EQ(missed, 0u);
}

HRT_STRESS_EVERY_ENGINE(Watertight);
