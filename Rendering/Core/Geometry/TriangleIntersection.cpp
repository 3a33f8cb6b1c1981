// Implements the exact kernel. Compiled with -ffp-contract=off, as the proof in the header demands.
#include "Rendering/Core/Geometry/TriangleIntersection.h"

#include <cmath>
#include <limits>

namespace hrt
{

namespace
{

int longestAxis(const glm::dvec3& v)
{
  const glm::dvec3 a = glm::abs(v);
  if (a.x >= a.y && a.x >= a.z)
  {
    return 0;
  }
  return a.y >= a.z ? 1 : 2;
}

bool isFinite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dvec3 transformPoint(const glm::dmat4& m, const glm::vec3& p)
{
  const double x = p.x, y = p.y, z = p.z;
  return { m[0][0] * x + m[1][0] * y + m[2][0] * z + m[3][0],
    m[0][1] * x + m[1][1] * y + m[2][1] * z + m[3][1],
    m[0][2] * x + m[1][2] * y + m[2][2] * z + m[3][2] };
}

} // namespace

double differenceOfProducts(double a, double b, double c, double d)
{
  const double product = c * d;
  const double rounding = std::fma(-c, d, product);
  return std::fma(a, b, -product) + rounding;
}

glm::dmat4 positionsToScene(
  const Part& part, const glm::dvec3& sceneOrigin, std::size_t copy)
{
  glm::dmat4 m = part.positionsToWorld(copy);
  m[3] -= glm::dvec4(sceneOrigin, 0.0);
  return m;
}

Corners sceneCorners(
  const Geometry& geometry, const glm::dmat4& positionsToScene, std::size_t triangle)
{
  return sceneCorners(geometry.cornerPositions(triangle).data(), positionsToScene);
}

Corners sceneCorners(const glm::vec3* positions, const glm::dmat4& positionsToScene)
{
  return { transformPoint(positionsToScene, positions[0]),
    transformPoint(positionsToScene, positions[1]), transformPoint(positionsToScene, positions[2]) };
}

// The corners in the plane across the ray, where the ray's foot is zero, and their depths.
struct ShearedRay::ShearedCorners
{
  double ax, ay, depthA;
  double bx, by, depthB;
  double cx, cy, depthC;
};

// Twice the signed areas that the ray's foot spans with each edge.
struct ShearedRay::EdgeFunctions
{
  double a, b, c;      // opposite the corner of the same name
  double products = 0; // sum of the magnitudes of the products that they are made of

  explicit EdgeFunctions(const ShearedCorners& s)
  {
    const double a0 = s.cx * s.by, a1 = s.cy * s.bx;
    const double b0 = s.ax * s.cy, b1 = s.ay * s.cx;
    const double c0 = s.bx * s.ay, c1 = s.by * s.ax;
    this->a = a0 - a1;
    this->b = b0 - b1;
    this->c = c0 - c1;
    this->products = std::abs(a0) + std::abs(a1) + std::abs(b0) + std::abs(b1) + std::abs(c0) +
      std::abs(c1);
  }

  // Some of them zero counts for both sides.
  bool agree() const
  {
    return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
  }

  // Takes them without cancellation where rounding may be much of what they are.
  void refine(const ShearedCorners& s)
  {
    if (std::abs(a + b + c) >= kCancelled * products)
    {
      return;
    }
    this->a = differenceOfProducts(s.cx, s.by, s.cy, s.bx);
    this->b = differenceOfProducts(s.ax, s.cy, s.ay, s.cx);
    this->c = differenceOfProducts(s.bx, s.ay, s.by, s.ax);
  }

  // The hit point as weighted mean of the corners; false when the triangle is seen edge-on.
  bool solve(const ShearedCorners& s, double scaleZ, TriangleHit& hit) const
  {
    const double determinant = a + b + c;
    hit.t = scaleZ * (a * s.depthA + b * s.depthB + c * s.depthC) / determinant;
    hit.u = b / determinant;
    hit.v = c / determinant;
    return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v);
  }
};

ShearedRay::ShearedRay(const glm::dvec3& origin, const glm::dvec3& direction)
  : Origin(origin)
{
  if (!isFinite(origin) || !isFinite(direction))
  {
    return;
  }
  // The winding swap of the paper's listing is left out: both sides count.
  this->Kz = longestAxis(direction);
  this->Kx = (this->Kz + 1) % 3;
  this->Ky = (this->Kz + 2) % 3;
  const double along = direction[this->Kz];
  if (std::abs(along) < std::numeric_limits<double>::min())
  {
    return;
  }
  this->ShearX = direction[this->Kx] / along;
  this->ShearY = direction[this->Ky] / along;
  this->ScaleZ = 1.0 / along;
  this->Valid = true;
}

ShearedRay::ShearedCorners ShearedRay::shear(const Corners& corners) const
{
  const glm::dvec3 a = corners.a - this->Origin;
  const glm::dvec3 b = corners.b - this->Origin;
  const glm::dvec3 c = corners.c - this->Origin;
  return { a[this->Kx] - this->ShearX * a[this->Kz], a[this->Ky] - this->ShearY * a[this->Kz],
    a[this->Kz], b[this->Kx] - this->ShearX * b[this->Kz],
    b[this->Ky] - this->ShearY * b[this->Kz], b[this->Kz],
    c[this->Kx] - this->ShearX * c[this->Kz], c[this->Ky] - this->ShearY * c[this->Kz],
    c[this->Kz] };
}

bool ShearedRay::hitsTriangle(const Corners& corners, double tMaximum, TriangleHit& hit) const
{
  if (!this->Valid)
  {
    return false;
  }
  const ShearedCorners sheared = this->shear(corners);
  EdgeFunctions edges(sheared);
  if (!edges.agree())
  {
    return false; // nearly all; signs that are not zero are right
  }
  edges.refine(sheared);
  // `solve` refuses three zeros: their sum is zero too.
  return edges.agree() && edges.solve(sheared, this->ScaleZ, hit) && hit.t > 0.0 &&
    hit.t < tMaximum;
}

bool ShearedRay::hitsPlane(const Corners& corners, TriangleHit& hit) const
{
  if (!this->Valid)
  {
    return false;
  }
  const ShearedCorners sheared = this->shear(corners);
  EdgeFunctions edges(sheared);
  edges.refine(sheared);
  return edges.solve(sheared, this->ScaleZ, hit);
}

bool planeHit(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& corners,
  TriangleHit& hit)
{
  return ShearedRay(origin, direction).hitsPlane(corners, hit);
}

} // namespace hrt
