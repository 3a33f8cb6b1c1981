// Small scenes and a brute-force structure for the core's tests.
#pragma once

#include "Rendering/Core/Geometry/TriangleIntersection.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Testing/Cxx/Meshes.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace hrt
{
namespace scenes
{

constexpr double kPi = 3.14159265358979323846;
// Half an ulp of 1: the relative error of one rounding.
constexpr double kFloatRounding = 0x1p-24;
constexpr double kDoubleRounding = 0x1p-53;

using meshes::cornersOf;

inline std::shared_ptr<Geometry> makeGeometry(
  const std::vector<glm::vec3>& corners, const std::vector<glm::vec3>& normals = {})
{
  return meshes::fromCorners(corners, normals);
}

// a b c d in a plane, counter-clockwise seen from the front.
inline std::shared_ptr<Geometry> quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d)
{
  return makeGeometry({ a, b, c, a, c, d });
}

// A grid of points wrapped by `surface(i / columns, j / rows)`; outward normals when given.
template <class Surface>
std::shared_ptr<Geometry> grid(int columns, int rows, Surface surface, bool normalsArePositions)
{
  std::vector<glm::vec3> positions;
  const auto point = [&](int i, int j) {
    return glm::vec3(surface(double(i % columns) / columns, j, rows));
  };
  const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    if (a != b && b != c && c != a)
    {
      positions.insert(positions.end(), { a, b, c });
    }
  };
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      add(point(i, j), point(i + 1, j), point(i + 1, j + 1));
      add(point(i, j), point(i + 1, j + 1), point(i, j + 1));
    }
  }
  return makeGeometry(positions, normalsArePositions ? positions : std::vector<glm::vec3>{});
}

// Closed to the last bit: what wraps around meets the very same points.
inline std::shared_ptr<Geometry> torus(int columns, int rows, double radius, double tube)
{
  return grid(
    columns, rows,
    [=](double s, int j, int n) {
      const double a = 2.0 * kPi * s, b = 2.0 * kPi * (j % n) / n;
      const double r = radius + tube * std::cos(b);
      return glm::dvec3(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
    },
    false);
}

// The unit sphere; its normals are its positions.
inline std::shared_ptr<Geometry> sphere(int columns, int rows)
{
  return grid(
    columns, rows,
    [=](double s, int j, int n) {
      if (j == 0 || j == n)
      {
        return glm::dvec3(0.0, 0.0, j == 0 ? -1.0 : 1.0);
      }
      const double a = 2.0 * kPi * s, b = kPi * (double(j) / n - 0.5);
      return glm::dvec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
    },
    true);
}

inline Part& addPart(Snapshot& snapshot, std::shared_ptr<const Geometry> geometry,
  const glm::dmat4& localToWorld = glm::dmat4(1.0))
{
  Part part;
  part.key = snapshot.parts.size() + 1;
  part.geometry = std::move(geometry);
  part.localToWorld = localToWorld;
  part.firstTriangle = snapshot.triangleCount;
  snapshot.triangleCount += static_cast<TriangleId>(part.geometry->triangleCount());
  snapshot.parts.push_back(part);
  return snapshot.parts.back();
}

// Three placements of one mesh: turned and stretched, mirrored, and shrunk, around `centre`.
inline Snapshot placedTori(const glm::dvec3& centre)
{
  const auto mesh = torus(40, 20, 1.0, 0.4);
  const glm::dmat4 at = glm::translate(glm::dmat4(1.0), centre);
  Snapshot s;
  addPart(s, mesh,
    at * glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1, 2, 3)) *
      glm::scale(glm::dmat4(1.0), { 1.0, 2.0, 0.5 }));
  addPart(s, makeGeometry({}));
  addPart(s, mesh,
    glm::translate(at, glm::dvec3(0.5, 0.2, -0.4)) *
      glm::scale(glm::dmat4(1.0), { -1.0, 1.0, 1.0 }));
  addPart(s, mesh,
    glm::translate(at, glm::dvec3(-1, 0, 0)) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.01)));
  s.origin = centre;
  return s;
}

// A material that shows one colour whatever the light.
inline Material glowing(glm::vec3 color)
{
  Material material;
  material.lit = false;
  material.front.ambient = 1.0f;
  material.front.ambientColor = color;
  material.front.diffuse = 0.0f;
  material.back = material.front;
  return material;
}

inline Material mirror(float reflectance, glm::vec3 color = glm::vec3(0.0f))
{
  Material material = glowing(color);
  material.reflectance = reflectance;
  return material;
}

inline Material glass(float indexOfRefraction)
{
  Material material;
  material.indexOfRefraction = indexOfRefraction;
  return material;
}

inline Camera perspective(const glm::dvec3& eye, const glm::dvec3& target, int width, int height,
  double angle = 40.0)
{
  Camera camera;
  camera.worldToView = glm::lookAt(eye, target, glm::dvec3(0, 1, 0));
  camera.viewToClip =
    glm::perspective(glm::radians(angle), double(width) / height, 0.1, 100.0);
  camera.width = width;
  camera.height = height;
  return camera;
}

// The reference: every triangle of every part, by the exact kernel.
class BruteForce final : public Structure
{
public:
  StructureReport update(const Snapshot& snapshot) override
  {
    this->Scene = snapshot;
    this->Surfaces = Coincidence(snapshot);
    return {};
  }

  Hit intersect(const Ray& ray) const override
  {
    std::vector<Hit> hits;
    this->intersectAll(ray, hits);
    if (hits.empty())
    {
      return Hit();
    }
    hits[0].shared =
      hits.size() > 1 && hits[1].t <= this->Surfaces.windowOf(ray.direction).end(hits[0].t);
    return hits[0];
  }

  void intersectAll(const Ray& ray, std::vector<Hit>& hits) const override
  {
    hits.clear();
    this->forEachHit(
      ray, &Part::visibleToRays, [&](const Hit& hit) { hits.push_back(hit); });
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
      return a.t < b.t || (a.t == b.t && a.triangle > b.triangle);
    });
  }

  bool occluded(const Ray& ray) const override
  {
    bool found = false;
    this->forEachHit(ray, &Part::castsShadow, [&](const Hit&) { found = true; });
    return found;
  }

private:
  template <class Found>
  void forEachHit(const Ray& ray, bool Part::*takesPart, Found found) const
  {
    const ShearedRay exact(ray.origin, ray.direction);
    for (const Part& part : this->Scene.parts)
    {
      if (!(part.*takesPart))
      {
        continue;
      }
      const glm::dmat4 toScene = positionsToScene(part, this->Scene.origin);
      for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
      {
        const TriangleId id = part.firstTriangle + static_cast<TriangleId>(i);
        TriangleHit hit;
        if (id != ray.originTriangle &&
          exact.hitsTriangle(sceneCorners(*part.geometry, toScene, i), ray.tMaximum, hit) &&
          !(hit.t <= double(ray.twinEnd) &&
            this->Surfaces.passesOver(ray.originTriangle, id, ray.origin, ray.direction)))
        {
          found(Hit{ id, hit.t, hit.u, hit.v });
        }
      }
    }
  }

  Snapshot Scene;
  Coincidence Surfaces;
};

// The same numbers on every machine: the standard's distributions are not specified to the bit.
class Random
{
public:
  explicit Random(std::uint32_t seed)
    : Engine(seed)
  {
  }
  double operator()(double from, double to)
  {
    return from + (to - from) * (this->Engine() * 0x1p-32);
  }
  glm::dvec3 inBox(double half)
  {
    const double x = (*this)(-half, half), y = (*this)(-half, half), z = (*this)(-half, half);
    return { x, y, z };
  }
  glm::dvec3 direction()
  {
    for (;;)
    {
      const glm::dvec3 v = this->inBox(1.0);
      const double squared = glm::dot(v, v);
      if (squared > 1e-4 && squared <= 1.0)
      {
        return v / std::sqrt(squared);
      }
    }
  }
  std::size_t below(std::size_t n) { return this->Engine() % n; }

private:
  std::mt19937 Engine;
};

} // namespace scenes
} // namespace hrt
