// The kd-tree structure against a loop over all triangles and against Embree: same triangle, same t, u,
// v, bit by bit, whatever the mesh, the placement and the ray.
#include "KdTreeScenes.h"
#include "Rendering/Core/Structures/EmbreeStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

namespace
{

using namespace hrt;
using scenes::Random;
using scenes::same;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Three placements of one mesh: turned and stretched, mirrored, and shrunk, around `centre`.
Snapshot placedTori(const glm::dvec3& centre)
{
  const auto mesh = scenes::torus(40, 20, 1.0, 0.4);
  const glm::dmat4 at = glm::translate(glm::dmat4(1.0), centre);
  Snapshot s;
  scenes::addPart(s, mesh,
    at * glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1, 2, 3)) *
      glm::scale(glm::dmat4(1.0), { 1.0, 2.0, 0.5 }));
  scenes::addPart(s, scenes::makeGeometry({}));
  scenes::addPart(s, mesh,
    glm::translate(at, glm::dvec3(0.5, 0.2, -0.4)) *
      glm::scale(glm::dmat4(1.0), { -1.0, 1.0, 1.0 }));
  scenes::addPart(s, mesh,
    glm::translate(at, glm::dvec3(-1, 0, 0)) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.01)));
  s.origin = centre;
  return s;
}

struct Compared
{
  int hits = 0, wrong = 0, wrongOcclusion = 0;
};

Compared compare(
  const Structure& structure, const Structure& reference, const Snapshot& s, int rays)
{
  Random random(6);
  Compared result;
  for (int i = 0; i < rays; ++i)
  {
    const Ray ray = scenes::hardRay(s, random, i);
    const Hit expected = reference.intersect(ray);
    result.hits += expected.valid();
    result.wrong += !same(structure.intersect(ray), expected);
    result.wrongOcclusion += structure.occluded(ray) != reference.occluded(ray);
  }
  return result;
}

void expectEqualToBruteForce(const Snapshot& s, int rays, int leastHits)
{
  KdTreeStructure tree;
  scenes::BruteForce reference;
  tree.update(s);
  reference.update(s);
  const Compared result = compare(tree, reference, s, rays);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_EQ(result.wrongOcclusion, 0);
  EXPECT_GE(result.hits, leastHits);
}

TEST(KdTreeStructure, EqualsBruteForceOnEveryKindOfMesh)
{
  for (const auto& [name, mesh] : scenes::hardMeshes(1000))
  {
    SCOPED_TRACE(name);
    if (mesh->triangleCount() == 0)
    {
      continue;
    }
    Snapshot s;
    scenes::addPart(s, mesh);
    const bool hasArea = name.find("needle") == std::string::npos &&
      name.find("point") == std::string::npos && name != "degenerate";
    expectEqualToBruteForce(s, 3000, hasArea ? 20 : 0);
  }
}

TEST(KdTreeStructure, EqualsBruteForceOnPlacedMeshes)
{
  expectEqualToBruteForce(placedTori({ 0, 0, 0 }), 6000, 1000);
}

TEST(KdTreeStructure, EqualsBruteForceFarFromTheOrigin)
{
  expectEqualToBruteForce(placedTori({ 148376, 1234, -223423 }), 6000, 1000);
}

} // namespace
