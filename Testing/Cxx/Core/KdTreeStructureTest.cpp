// The kd-tree structure against a loop over all triangles and against Embree: same triangle, same t, u,
// v, bit by bit, whatever the mesh, the placement and the ray.
#include "KdTreeScenes.h"
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeSearch.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

namespace
{

using namespace hrt;
using scenes::placedTori;
using scenes::Random;
using scenes::same;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  for (const auto& [name, mesh] : scenes::hardMeshes(400))
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
    expectEqualToBruteForce(s, 2000, hasArea ? 20 : 0);
  }
}

TEST(KdTreeStructure, EqualsBruteForceOnPlacedMeshes)
{
  expectEqualToBruteForce(placedTori({ 0, 0, 0 }), 3000, 500);
}

TEST(KdTreeStructure, EqualsBruteForceFarFromTheOrigin)
{
  expectEqualToBruteForce(placedTori({ 148376, 1234, -223423 }), 3000, 500);
}

// Larger meshes, where the other structure is the oracle: they share the kernel and nothing else.
void expectEqualToEmbree(const Snapshot& s, int rays)
{
  KdTreeStructure tree;
  BvhStructure embree;
  tree.update(s);
  embree.update(s);
  const Compared result = compare(tree, embree, s, rays);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_EQ(result.wrongOcclusion, 0);
  EXPECT_GT(result.hits, rays / 20);
}

TEST(KdTreeStructure, EqualsEmbreeOnLargerMeshes)
{
  for (const auto& [name, mesh] : scenes::hardMeshes(8000))
  {
    if (name == "soup" || name == "lattice" || name == "torus" || name == "slivers" ||
      name == "aligned boxes")
    {
      SCOPED_TRACE(name);
      Snapshot s;
      scenes::addPart(s, mesh, glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(1, 1, 0)));
      scenes::addPart(s, mesh, glm::scale(glm::dmat4(1.0), glm::dvec3(1.5)));
      expectEqualToEmbree(s, 2000);
    }
  }
}

TEST(KdTreeStructure, EqualsEmbreeOnTheBunny)
{
  const auto mesh = scenes::bunny();
  if (!mesh)
  {
    GTEST_SKIP() << "no bunny/bunny.ply (see Data/README.md)";
  }
  Snapshot s;
  const glm::dvec3 centre = 0.5 * (glm::dvec3(mesh->boundsMin) + glm::dvec3(mesh->boundsMax));
  scenes::addPart(s, mesh,
    glm::scale(glm::dmat4(1.0), glm::dvec3(12.0)) * glm::translate(glm::dmat4(1.0), -centre));
  expectEqualToEmbree(s, 50000);
}

// From inside a closed mesh every ray must hit, those at vertices and edges too.
TEST(KdTreeStructure, NothingLeaksOutOfAClosedMesh)
{
  for (const glm::dvec3& centre : { glm::dvec3(0.0), glm::dvec3(148376, 1234, -223423) })
  {
    Snapshot s;
    scenes::addPart(s, scenes::sphere(200, 100), glm::translate(glm::dmat4(1.0), centre));
    s.origin = centre;
    KdTreeStructure tree;
    tree.update(s);
    Random random(8);
    int leaks = 0;
    for (int i = 0; i < 200000; ++i)
    {
      Ray ray;
      ray.origin = random.inBox(0.5);
      ray.direction =
        i % 4 ? scenes::randomCorner(s, random) - ray.origin : random.direction();
      leaks += !tree.intersect(ray).valid();
    }
    EXPECT_EQ(leaks, 0);
  }
}

// The same with the scene's origin far from the mesh: coordinates are large and rounding is coarse.
TEST(KdTreeStructure, NothingLeaksFarFromTheScenesOrigin)
{
  const glm::dvec3 centre(148376, 1234, -223423);
  Snapshot s;
  scenes::addPart(s, scenes::sphere(200, 100), glm::translate(glm::dmat4(1.0), centre));
  KdTreeStructure tree;
  tree.update(s);
  Random random(9);
  int leaks = 0;
  for (int i = 0; i < 100000; ++i)
  {
    Ray ray;
    ray.origin = centre + random.inBox(0.5);
    ray.direction = scenes::randomCorner(s, random) - ray.origin;
    leaks += !tree.intersect(ray).valid();
  }
  EXPECT_EQ(leaks, 0);
}

// Origins so far away that the ray's place in the tree is rounding alone, and matrices that stretch by a
// billion: slower, never wrong.
TEST(KdTreeStructure, EqualsBruteForceWhenRoundingIsCoarse)
{
  Snapshot s;
  const auto mesh = scenes::torus(40, 20, 1.0, 0.4);
  scenes::addPart(s, mesh);
  scenes::addPart(s, mesh,
    glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(1, 2, 3)) *
      glm::scale(glm::dmat4(1.0), { 1.0, 1e-5, 1.0 }) *
      glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(3, 2, 1)));
  KdTreeStructure tree;
  scenes::BruteForce reference;
  tree.update(s);
  reference.update(s);
  Random random(10);
  int hits = 0, wrong = 0;
  for (int i = 0; i < 600; ++i)
  {
    Ray ray;
    ray.direction = random.direction() * std::ldexp(1.0, int(random.below(1400)) - 700);
    const double away = std::ldexp(1.0, int(random.below(44)));
    ray.origin = scenes::randomCorner(s, random) - away * glm::normalize(ray.direction);
    if (!std::isfinite(glm::dot(ray.direction, ray.direction)) ||
      glm::dot(ray.direction, ray.direction) < 1e-290)
    {
      ray.origin = random.inBox(2.0);
    }
    const Hit expected = reference.intersect(ray);
    hits += expected.valid();
    wrong += !same(tree.intersect(ray), expected);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(hits, 200);
}

// Matrices that no inverse undoes: every triangle is asked.
TEST(KdTreeStructure, EqualsBruteForceWherePartsAreFlattened)
{
  for (const double height : { 0.0, 1e-17, 1e-300 })
  {
    Snapshot s;
    scenes::addPart(s, scenes::torus(16, 8, 1.0, 0.4),
      glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(1, 2, 3)) *
        glm::scale(glm::dmat4(1.0), { 1.0, height, 1.0 }) *
        glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(3, 2, 1)));
    expectEqualToBruteForce(s, 1000, 100); // a part alone
    scenes::addPart(s, scenes::sphere(16, 8), glm::translate(glm::dmat4(1.0), { 0.5, 0, 0 }));
    expectEqualToBruteForce(s, 1000, 100);
  }
}

// Machines without wide vectors take the other of two compiled traversals.
TEST(KdTreeStructure, TheWidthOfVectorsDoesNotShow)
{
  Snapshot s;
  const auto mesh = scenes::torus(80, 40, 1.0, 0.4);
  scenes::addPart(s, mesh, glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(1, 2, 3)));
  KdTreeStructure structure;
  structure.update(s);
  const auto triangles = std::make_shared<kdtree::TriangleTree>();
  triangles->geometry = mesh;
  triangles->tree = KdTree::build(*mesh);
  const Coincidence surfaces(s);
  const kdtree::Instance instance = kdtree::makeInstance(s.parts[0], *triangles, s.origin);
  Random random(13);
  int hits = 0, wrong = 0;
  for (int i = 0; i < 3000; ++i)
  {
    const Ray ray = scenes::hardRay(s, random, i);
    const kdtree::ScaledRay scaled(ray);
    const double reach = largest(scaled.origin);
    KdNoCounters none;
    for (const bool wide : { false, kdtree::hasWideVectors() })
    {
      ExactSearch nearest(ray, surfaces), any(ray, surfaces);
      kdtree::NearestTest nearestTest{ nearest };
      kdtree::AnyTest anyTest{ any };
      kdtree::searchInstance(instance, scaled, reach, nearest, nearestTest, none, wide);
      kdtree::searchInstance(instance, scaled, reach, any, anyTest, none, wide);
      hits += nearest.best().valid();
      wrong += !same(nearest.best(), structure.intersect(ray));
      wrong += anyTest.done() != structure.occluded(ray);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(hits, 1000);
}

TEST(KdTreeStructure, BuildsOnlyWhatIsNew)
{
  const auto ball = scenes::sphere(16, 8), ring = scenes::torus(16, 8, 1, 0.3);
  Snapshot s;
  scenes::addPart(s, ball);
  scenes::addPart(s, ball, glm::translate(glm::dmat4(1.0), { 5, 0, 0 }));
  scenes::addPart(s, ring);
  KdTreeStructure tree;
  const auto expectReport = [&](std::uint64_t built, std::uint64_t reused, bool parts) {
    const StructureReport report = tree.update(s);
    EXPECT_EQ(report.built, built);
    EXPECT_EQ(report.reused, reused);
    EXPECT_EQ(report.refitted, 0u);
    EXPECT_EQ(report.partsRebuilt, parts);
  };
  expectReport(2, 0, true);  // two geometries, three parts
  EXPECT_EQ(tree.quality().size(), 2u);
  expectReport(0, 2, false); // nothing new
  s.parts[1].localToWorld[3][0] = 7;
  expectReport(0, 2, true); // a part moved
  s.parts[2].geometry = scenes::torus(16, 8, 1, 0.2);
  expectReport(1, 1, true); // a mesh changed
  s.parts.resize(2);
  expectReport(0, 1, true); // a part left
  Ray ray;
  ray.origin = { 7.1, 0.1, 3 };
  EXPECT_TRUE(tree.intersect(ray).valid()); // where the moved part is now
}

TEST(KdTreeStructure, AnAbortedUpdateChangesNothing)
{
  std::atomic<bool> abort{ false };
  KdTreeSettings settings;
  settings.threads = 2;
  settings.control.abort = &abort;
  KdTreeStructure tree(settings);
  Snapshot s;
  scenes::addPart(s, scenes::sphere(64, 32));
  tree.update(s);
  Random random(12);
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  for (int i = 0; i < 200; ++i)
  {
    rays.push_back(scenes::hardRay(s, random, i));
    hits.push_back(tree.intersect(rays.back()));
  }
  Snapshot larger = s;
  scenes::addPart(larger, scenes::bumpySphere(20000));
  abort = true;
  EXPECT_THROW(tree.update(larger), KdTreeAborted);
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    EXPECT_TRUE(same(tree.intersect(rays[i]), hits[i]));
  }
  abort = false;
  const StructureReport report = tree.update(larger);
  EXPECT_EQ(report.built, 1u);
  EXPECT_EQ(report.reused, 1u);
}

TEST(KdTreeStructure, CountersTellWhatARayTook)
{
  Snapshot s;
  scenes::addPart(s, scenes::sphere(64, 32));
  KdTreeStructure tree;
  tree.update(s);
  Ray through, past;
  past.origin = { 5, 0, 0 };
  KdCounters hit, miss;
  EXPECT_TRUE(same(tree.intersect(through, hit), tree.intersect(through)));
  EXPECT_FALSE(tree.occluded(past, miss));
  EXPECT_GE(hit.steps, 1u);
  EXPECT_GE(hit.leaves, 1u);
  EXPECT_GE(hit.blockTests, hit.leaves);
  EXPECT_GE(8 * hit.blockTests, hit.candidates);
  EXPECT_GE(hit.candidates, 1u);
  EXPECT_EQ(miss.steps + miss.leaves + miss.blockTests + miss.candidates, 0u);
}

} // namespace
