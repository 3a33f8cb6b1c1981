// The kd-tree's builder under fire: bytes become triangles with shared corners, flat and needle-like
// ones and exact ties among them; the tree is built, moved and built again, and rays aimed at corners
// and edges must be answered as by trying every triangle.
#include "Testing/Fuzz/Bytes.h"

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "Testing/Cxx/Core/Scenes.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace hrt;
using hrt::fuzz::Bytes;

namespace
{

constexpr unsigned int kMostTriangles = 200, kRays = 24;

float coordinate(Bytes& bytes)
{
  const auto value = static_cast<float>(bytes.number());
  return std::abs(value) <= static_cast<float>(kLargestCoordinate) ? value : 0.0f;
}

glm::vec3 point(Bytes& bytes)
{
  const float x = coordinate(bytes), y = coordinate(bytes), z = coordinate(bytes);
  return { x, y, z };
}

// Some corners are earlier ones again.
std::vector<glm::vec3> triangles(Bytes& bytes)
{
  std::vector<glm::vec3> positions;
  const unsigned int count = bytes.below(kMostTriangles);
  for (unsigned int i = 0; i < 3 * count && !bytes.empty(); ++i)
  {
    const unsigned int kind = bytes.byte();
    positions.push_back(kind < 96 && !positions.empty()
        ? positions[positions.size() - 1 - kind % positions.size()]
        : point(bytes));
  }
  positions.resize(positions.size() / 3 * 3);
  return positions;
}

void compare(const Snapshot& s, const KdTreeStructure& tree, const Ray& ray)
{
  scenes::BruteForce truth;
  truth.update(s);
  const Hit expected = truth.intersect(ray), found = tree.intersect(ray);
  const bool same = expected.triangle == found.triangle &&
    (!expected.valid() ||
      (expected.t == found.t && expected.u == found.u && expected.v == found.v));
  if (!same || tree.occluded(ray) != truth.occluded(ray))
  {
    std::fprintf(stderr, "triangle %u at %a expected, %u at %a found\n", expected.triangle,
      expected.t, found.triangle, found.t);
    std::abort();
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  Snapshot s;
  scenes::addPart(s, scenes::makeGeometry(triangles(bytes)));
  KdTreeStructure tree;
  tree.update(s);
  const std::vector<glm::vec3> corners = scenes::cornersOf(*s.parts[0].geometry);
  for (unsigned int i = 0; i < kRays; ++i)
  {
    const auto corner = [&] {
      return corners.empty() ? glm::dvec3(0.0) : glm::dvec3(corners[bytes.byte() % corners.size()]);
    };
    // At a corner, or at a point of an edge or a face.
    const glm::dvec3 a = corner(), b = corner();
    Ray ray;
    ray.origin = glm::dvec3(point(bytes));
    ray.direction = glm::mix(a, b, bytes.byte() / 128.0) - ray.origin;
    compare(s, tree, ray);
    if (i == kRays / 2)
    {
      s.parts[0].localToWorld[3] = glm::dvec4(glm::dvec3(point(bytes)), 1.0);
      tree.update(s);
    }
  }
  return 0;
}
