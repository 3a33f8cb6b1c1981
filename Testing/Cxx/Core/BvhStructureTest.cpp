// The Embree structure against a loop over all triangles: same triangle, same t, u, v, bit by bit.
#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/BvhStructure.h"
#include "StructureChecks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace
{

using namespace hrt;
using scenes::placedTori;
using scenes::Random;

std::shared_ptr<Geometry> soup(Random& random, int count, double size)
{
  std::vector<glm::vec3> positions;
  for (int i = 0; i < count; ++i)
  {
    const glm::dvec3 centre = random.inBox(1.0);
    for (int corner = 0; corner < 3; ++corner)
    {
      positions.push_back(glm::vec3(centre + random.inBox(size)));
    }
  }
  return scenes::makeGeometry(positions);
}

void expectEqualToBruteForce(const Snapshot& s, int rays, const char* configuration = "")
{
  BvhStructure embree{ configuration };
  scenes::BruteForce reference;
  embree.update(s);
  reference.update(s);
  Random random(6);
  int hits = 0, misses = 0, wrong = 0, wrongOcclusion = 0;
  for (int i = 0; i < rays; ++i)
  {
    const Ray ray = checks::randomRay(s, random, i);
    const Hit expected = reference.intersect(ray);
    ++(expected.valid() ? hits : misses);
    wrong += !checks::same(embree.intersect(ray), expected);
    wrongOcclusion += embree.occluded(ray) != reference.occluded(ray);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(wrongOcclusion, 0);
  EXPECT_GT(hits, rays / 20);
  EXPECT_GT(misses, rays / 20);
}

TEST(BvhStructure, EqualsBruteForceOnRandomTriangles)
{
  Random random(7);
  Snapshot s;
  scenes::addPart(s, soup(random, 1000, 0.2));
  scenes::addPart(s, soup(random, 1000, 0.01), glm::rotate(glm::dmat4(1.0), 1.0, { 0, 1, 0 }));
  expectEqualToBruteForce(s, 8000);
}

TEST(BvhStructure, EqualsBruteForceOnPlacedMeshes)
{
  expectEqualToBruteForce(placedTori({ 0, 0, 0 }), 6000);
}

TEST(BvhStructure, EqualsBruteForceFarFromTheOrigin)
{
  expectEqualToBruteForce(placedTori({ 148376, 1234, -223423 }), 6000);
}

TEST(BvhStructure, InstructionSetDoesNotShow)
{
  expectEqualToBruteForce(placedTori({ 0, 0, 0 }), 2000, "isa=sse2");
}

// From inside a closed mesh every ray must hit, those at vertices and edges too.
TEST(BvhStructure, NothingLeaksOutOfAClosedMesh)
{
  for (const glm::dvec3& centre : { glm::dvec3(0.0), glm::dvec3(148376, 1234, -223423) })
  {
    Snapshot s;
    scenes::addPart(s, scenes::sphere(200, 100), glm::translate(glm::dmat4(1.0), centre));
    s.origin = centre;
    BvhStructure embree;
    embree.update(s);
    Random random(8);
    int leaks = 0;
    for (int i = 0; i < 400000; ++i)
    {
      Ray ray;
      ray.origin = random.inBox(0.5);
      ray.direction = i % 4 ? checks::randomCorner(s, random) - ray.origin : random.direction();
      leaks += !embree.intersect(ray).valid();
    }
    EXPECT_EQ(leaks, 0);
  }
}

TEST(BvhStructure, LeavesFloatingPointModesAlone)
{
  // Flush-to-zero would turn the smallest number's half, and unequal products, into zero.
  Snapshot s;
  scenes::addPart(s, scenes::sphere(64, 32));
  BvhStructure embree;
  embree.update(s);
  embree.intersect(Ray());
  volatile double smallest = std::numeric_limits<double>::min();
  EXPECT_GT(smallest / 2, 0.0);
}

std::string errorOf(const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "no error";
}

TEST(BvhStructure, ErrorsAreThrownWithEmbreesWords)
{
  EXPECT_EQ(
    errorOf([] { BvhStructure embree("threads=many"); }), "Embree: no device (unknown error)");
  // A geometry of a kind that does not exist.
  bvh::Device device("");
  const RTCGeometry none = rtcNewGeometry(device.handle(), static_cast<RTCGeometryType>(99));
  EXPECT_EQ(none, nullptr);
  const std::string error = errorOf([&] { device.check("making nothing"); });
  EXPECT_EQ(error.rfind("Embree: making nothing failed (", 0), 0u) << error;
  EXPECT_NE(error.find("type"), std::string::npos) << error; // Embree's own word
  EXPECT_EQ(errorOf([&] { device.check("making nothing"); }), "no error"); // said once
}

} // namespace
