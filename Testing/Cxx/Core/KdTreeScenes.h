// Meshes and rays that are hard on a kd-tree, for the tests of its build and of its traversal.
#pragma once

#include "Scenes.h"

#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>

namespace hrt
{
namespace scenes
{

inline std::shared_ptr<Geometry> soup(Random& random, int count, double size)
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
  return makeGeometry(positions);
}

// Corners on a coarse lattice: planes, edges and corners of many triangles fall together.
inline std::shared_ptr<Geometry> latticeSoup(Random& random, int count)
{
  std::vector<glm::vec3> positions;
  const auto point = [&] {
    const float x = float(random.below(5)), y = float(random.below(5)), z = float(random.below(5));
    return glm::vec3(x, y, z) - 2.0f;
  };
  while (int(positions.size()) < 3 * count)
  {
    const glm::vec3 a = point(), b = point(), c = point();
    if (glm::cross(b - a, c - a) != glm::vec3(0.0f))
    {
      positions.insert(positions.end(), { a, b, c });
    }
  }
  return makeGeometry(positions);
}

// Boxes with axis-aligned sides, some of them touching, some flat.
inline std::shared_ptr<Geometry> alignedBoxes(Random& random, int count)
{
  std::vector<glm::vec3> p;
  for (int box = 0; box < count; ++box)
  {
    glm::vec3 lower, size;
    for (int axis = 0; axis < 3; ++axis)
    {
      lower[axis] = float(random.below(8)) / 4.0f - 1.0f;
      size[axis] = float(random.below(3)) / 4.0f;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      if (size[u] == 0.0f || size[v] == 0.0f)
      {
        continue;
      }
      for (int side = 0; side < 2; ++side)
      {
        glm::vec3 a = lower;
        a[axis] += side * size[axis];
        glm::vec3 b = a, c = a, d = a;
        b[u] += size[u];
        c[u] += size[u];
        c[v] += size[v];
        d[v] += size[v];
        p.insert(p.end(), { a, b, c, a, c, d });
      }
    }
  }
  return makeGeometry(p);
}

// Long, thin, at every angle.
inline std::shared_ptr<Geometry> slivers(Random& random, int count)
{
  std::vector<glm::vec3> positions;
  for (int i = 0; i < count; ++i)
  {
    const glm::dvec3 a = random.inBox(1.0), b = random.inBox(1.0);
    positions.insert(
      positions.end(), { glm::vec3(a), glm::vec3(b), glm::vec3(b + 1e-5 * random.direction()) });
  }
  return makeGeometry(positions);
}

inline std::shared_ptr<Geometry> repeated(const glm::vec3 (&corners)[3], int count)
{
  std::vector<glm::vec3> positions;
  for (int i = 0; i < count; ++i)
  {
    positions.insert(positions.end(), { corners[0], corners[1], corners[2] });
  }
  return makeGeometry(positions);
}

// The Stanford bunny, or null where the scene data are absent (see Data/README.md). Reads just that file:
// ASCII, corners first, triangles only.
inline std::shared_ptr<Geometry> bunny()
{
  const char* named = std::getenv("HRT_DATA_ROOT");
  std::ifstream file(std::string(named ? named : HRT_DEFAULT_DATA_ROOT) + "/bunny/bunny.ply");
  std::size_t points = 0, faces = 0;
  std::string line;
  while (std::getline(file, line) && line != "end_header")
  {
    if (line.rfind("element vertex ", 0) == 0)
    {
      points = std::stoul(line.substr(15));
    }
    if (line.rfind("element face ", 0) == 0)
    {
      faces = std::stoul(line.substr(13));
    }
  }
  std::vector<glm::vec3> corners(points), positions;
  for (glm::vec3& corner : corners)
  {
    float confidence, intensity;
    file >> corner.x >> corner.y >> corner.z >> confidence >> intensity;
  }
  for (std::size_t i = 0; i < faces; ++i)
  {
    std::size_t count, a, b, c;
    file >> count >> a >> b >> c;
    positions.insert(positions.end(), { corners.at(a), corners.at(b), corners.at(c) });
  }
  return file && faces > 0 ? makeGeometry(positions) : nullptr;
}

// A sphere with bumps: about as many triangles as asked for, none of them large.
inline std::shared_ptr<Geometry> bumpySphere(double triangles)
{
  const int rows = std::max(4, static_cast<int>(std::sqrt(triangles / 4.0)));
  return grid(
    2 * rows, rows,
    [](double s, int j, int n) {
      const double a = 2.0 * kPi * s, b = kPi * (double(j) / n - 0.5);
      const double r = 1.0 + 0.05 * std::sin(9.0 * a) * std::cos(3.0 * b) * std::cos(11.0 * b);
      return r * glm::dvec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
    },
    false);
}

// A mesh of every kind, by name.
inline std::vector<std::pair<std::string, std::shared_ptr<Geometry>>> hardMeshes(int size)
{
  Random random(11);
  const glm::vec3 tilted[3] = { { 0, 0, 0 }, { 1, 0, 0.5f }, { 0, 1, 0.25f } };
  const glm::vec3 aligned[3] = { { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } };
  const glm::vec3 needle[3] = { { -1, 0, 0 }, { 0, 0, 0 }, { 1, 0, 0 } };
  const glm::vec3 point[3] = { { 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 } };
  std::vector<glm::vec3> degenerate;
  for (int i = 0; i < size / 4; ++i)
  {
    const glm::vec3 a(random.inBox(1.0)), b(random.inBox(1.0));
    degenerate.insert(degenerate.end(), { a, a, a, a, b, a, a, b, 0.5f * (a + b) });
  }
  return {
    { "empty", makeGeometry({}) },
    { "one", repeated(tilted, 1) },
    { "one aligned", repeated(aligned, 1) },
    { "identical", repeated(tilted, size) },
    { "identical aligned", repeated(aligned, size) },
    { "identical needles", repeated(needle, size) },
    { "identical points", repeated(point, size) },
    { "degenerate", makeGeometry(degenerate) },
    { "soup", soup(random, size, 0.1) },
    { "large soup", soup(random, size / 4, 1.0) },
    { "lattice", latticeSoup(random, size) },
    { "aligned boxes", alignedBoxes(random, size / 12) },
    { "slivers", slivers(random, size / 8) },
    { "sphere", sphere(int(std::sqrt(size)), int(std::sqrt(size)) / 2) },
    { "torus", torus(int(std::sqrt(size)), int(std::sqrt(size)) / 2, 1.0, 0.4) },
  };
}

inline bool same(const Hit& a, const Hit& b)
{
  return a.triangle == b.triangle && a.t == b.t && a.u == b.u && a.v == b.v;
}

// A vertex, or the middle of an edge.
inline glm::dvec3 randomCorner(const Snapshot& s, Random& random)
{
  const TriangleId id = static_cast<TriangleId>(random.below(s.triangleCount));
  const Part& part = s.parts[s.partOf(id)];
  const Corners c =
    sceneCorners(*part.geometry, positionsToScene(part, s.origin), id - part.firstTriangle);
  return random.below(2) ? c.a : 0.5 * (c.a + c.b);
}

// Rays at random, rays aimed at corners and edges, rays along the axes, rays from a triangle's own plane.
inline Ray hardRay(const Snapshot& s, Random& random, int i)
{
  Ray ray;
  ray.origin = random.inBox(3.0);
  ray.direction = random.direction();
  if (i % 4 == 1)
  {
    ray.direction = randomCorner(s, random) - ray.origin;
  }
  if (i % 4 == 2)
  {
    // Through a corner and along one or two axes: within the planes of splits.
    ray.origin = randomCorner(s, random);
    const int axis = static_cast<int>(random.below(3));
    ray.direction[axis] = 0.0;
    if (random.below(2))
    {
      ray.direction[(axis + 1) % 3] = random.below(2) ? 0.0 : -0.0;
    }
    ray.origin -= ray.direction * double(random.below(3));
  }
  if (i % 4 == 3)
  {
    ray.origin = randomCorner(s, random);
    ray.direction *= std::ldexp(1.0, static_cast<int>(random.below(1200)) - 600);
  }
  if (i % 3 == 0)
  {
    ray.tMaximum = random(0.0, 4.0) / std::sqrt(glm::dot(ray.direction, ray.direction));
  }
  if (i % 5 == 0)
  {
    ray.originTriangle = static_cast<TriangleId>(random.below(s.triangleCount));
  }
  return ray;
}

} // namespace scenes
} // namespace hrt
