// Implements the exact kernel on lanes: one function says what a lane does.
#include "Rendering/Core/Structures/ExactLanes.h"

#include <cmath>
#include <cstdint>
#include <limits>

#if defined(__GNUC__)
#define HRT_NEVER_INLINE __attribute__((noinline))
#else
#define HRT_NEVER_INLINE
#endif

namespace hrt
{

int ExactShear::longestAxis(const glm::dvec3& direction)
{
  const glm::dvec3 a = glm::abs(direction);
  return a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
}

ExactShear::ExactShear(const glm::dvec3& direction)
  : longest(longestAxis(direction))
{
  const double along = direction[this->longest];
  this->x = direction[(this->longest + 1) % 3] / along;
  this->y = direction[(this->longest + 2) % 3] / along;
  this->scale = 1.0 / along;
}

namespace
{

constexpr unsigned int kLanes = ExactLanes::kLanes;

// The matrix' rows in the order of the shear's axes: those across, then the longest.
struct Rows
{
  double of[3][4];

  HRT_ALWAYS_INLINE Rows(const glm::dmat4& m, const int (&axes)[3])
  {
    for (int k = 0; k < 3; ++k)
    {
      for (int column = 0; column < 4; ++column)
      {
        this->of[k][column] = m[column][axes[k]];
      }
    }
  }
};

struct Axes
{
  int of[3];
  HRT_ALWAYS_INLINE explicit Axes(int longest)
    : of{ longest == 2 ? 0 : longest + 1, longest == 0 ? 2 : longest - 1, longest }
  {
  }
};

// A lane's edge functions and depths.
struct Edges
{
  double a, b, c, depthA, depthB, depthC;
  double ax, ay, bx, by, cx, cy; // sheared corners
  bool inside;
  bool cancelled; // to be refined before they mean anything

  // `at(corner, axis)`: the position; `from(k)`: the ray's origin, along the k-th of the axes.
  template <class At, class From>
  HRT_ALWAYS_INLINE Edges(const Rows& rows, At at, From from, double shearX, double shearY)
  {
    double corner[3][3];
    for (int i = 0; i < 3; ++i)
    {
      const double x = at(i, 0), y = at(i, 1), z = at(i, 2);
      for (int k = 0; k < 3; ++k)
      {
        const double(&row)[4] = rows.of[k];
        corner[i][k] = (row[0] * x + row[1] * y + row[2] * z + row[3]) - from(k);
      }
    }
    this->depthA = corner[0][2];
    this->depthB = corner[1][2];
    this->depthC = corner[2][2];
    this->ax = corner[0][0] - shearX * this->depthA;
    this->ay = corner[0][1] - shearY * this->depthA;
    this->bx = corner[1][0] - shearX * this->depthB;
    this->by = corner[1][1] - shearY * this->depthB;
    this->cx = corner[2][0] - shearX * this->depthC;
    this->cy = corner[2][1] - shearY * this->depthC;
    const double a0 = this->cx * this->by, a1 = this->cy * this->bx;
    const double b0 = this->ax * this->cy, b1 = this->ay * this->cx;
    const double c0 = this->bx * this->ay, c1 = this->by * this->ax;
    this->a = a0 - a1;
    this->b = b0 - b1;
    this->c = c0 - c1;
    this->inside = this->agree();
    const double products =
      std::fabs(a0) + std::fabs(a1) + std::fabs(b0) + std::fabs(b1) + std::fabs(c0) + std::fabs(c1);
    this->cancelled =
      this->inside & !(std::fabs(this->a + this->b + this->c) >= kCancelled * products);
  }

  HRT_ALWAYS_INLINE bool agree() const
  {
    return ((this->a >= 0.0) & (this->b >= 0.0) & (this->c >= 0.0)) |
      ((this->a <= 0.0) & (this->b <= 0.0) & (this->c <= 0.0));
  }

  void refine()
  {
    this->a = differenceOfProducts(this->cx, this->by, this->cy, this->bx);
    this->b = differenceOfProducts(this->ax, this->cy, this->ay, this->cx);
    this->c = differenceOfProducts(this->bx, this->ay, this->by, this->ax);
    this->inside = this->agree();
  }

  // The hit's t, u, v; false when it is not before `last` or is no number.
  HRT_ALWAYS_INLINE bool solve(double scale, double last, double& t, double& u, double& v) const
  {
    // Outside nothing is divided by zero, as the kernel divides only inside.
    const double determinant = this->inside ? this->a + this->b + this->c : 1.0;
    t = scale * (this->a * this->depthA + this->b * this->depthB + this->c * this->depthC) /
      determinant;
    u = this->b / determinant;
    v = this->c / determinant;
    constexpr double largest = std::numeric_limits<double>::max();
    const bool finite =
      (std::fabs(t) <= largest) & (std::fabs(u) <= largest) & (std::fabs(v) <= largest);
    return this->inside & finite & (t > 0.0) & (t < last);
  }
};

// Of one lane, with all it takes.
HRT_ALWAYS_INLINE Edges edgesOf(
  const ExactLanes& lanes, const Rows& rows, const Axes& axes, unsigned int i)
{
  const double along = lanes.direction[axes.of[2]][i];
  return Edges(
    rows, [&](int corner, int axis) { return lanes.position[corner][axis][i]; },
    [&](int k) { return lanes.origin[axes.of[k]][i]; }, lanes.direction[axes.of[0]][i] / along,
    lanes.direction[axes.of[1]][i] / along);
}

// Decides the lanes again that have to be refined, one by one: they are rare.
HRT_NEVER_INLINE unsigned int refineLanes(
  ExactLanes& lanes, const Rows& rows, const Axes& axes, unsigned int cancelled, unsigned int hits)
{
  for (; cancelled != 0; cancelled &= cancelled - 1)
  {
    const auto i = static_cast<unsigned int>(__builtin_ctz(cancelled));
    Edges edges = edgesOf(lanes, rows, axes, i);
    edges.refine();
    const bool hit = edges.inside &&
      edges.solve(
        1.0 / lanes.direction[axes.of[2]][i], lanes.last[i], lanes.t[i], lanes.u[i], lanes.v[i]);
    hits = hit ? hits | 1u << i : hits & ~(1u << i);
  }
  return hits;
}

HRT_ALWAYS_INLINE unsigned int hitLanes(ExactLanes& lanes, const glm::dmat4& m, int longest)
{
  const Axes axes(longest);
  const Rows rows(m, axes.of);
  const double* const originX = lanes.origin[axes.of[0]];
  const double* const originY = lanes.origin[axes.of[1]];
  const double* const originZ = lanes.origin[axes.of[2]];
  const double* const directionX = lanes.direction[axes.of[0]];
  const double* const directionY = lanes.direction[axes.of[1]];
  const double* const directionZ = lanes.direction[axes.of[2]];
  std::int64_t hits[kLanes], cancelled[kLanes];
  for (unsigned int i = 0; i < kLanes; ++i)
  {
    const double along = directionZ[i];
    const Edges edges(
      rows, [&](int corner, int axis) { return lanes.position[corner][axis][i]; },
      [&](int k) { return k == 0 ? originX[i] : (k == 1 ? originY[i] : originZ[i]); },
      directionX[i] / along, directionY[i] / along);
    double t, u, v;
    hits[i] = edges.solve(1.0 / along, lanes.last[i], t, u, v) ? 1 : 0;
    cancelled[i] = edges.cancelled ? 1 : 0;
    lanes.t[i] = t;
    lanes.u[i] = u;
    lanes.v[i] = v;
  }
  unsigned int result = 0, again = 0;
  for (unsigned int i = 0; i < kLanes; ++i)
  {
    result |= static_cast<unsigned int>(hits[i]) << i;
    again |= static_cast<unsigned int>(cancelled[i]) << i;
  }
  return again == 0 ? result : refineLanes(lanes, rows, axes, again, result);
}

unsigned int hitBase(ExactLanes& lanes, const glm::dmat4& m, int longest)
{
  return hitLanes(lanes, m, longest);
}

#if defined(__GNUC__) && defined(__x86_64__)
__attribute__((target("avx2"))) unsigned int hitAvx2(
  ExactLanes& lanes, const glm::dmat4& m, int longest)
{
  return hitLanes(lanes, m, longest);
}
__attribute__((target("avx512f,avx512vl,avx512dq"))) unsigned int hitAvx512(
  ExactLanes& lanes, const glm::dmat4& m, int longest)
{
  return hitLanes(lanes, m, longest);
}
#else
constexpr auto hitAvx2 = hitBase, hitAvx512 = hitBase;
#endif

} // namespace

unsigned int ExactLanes::hit(const glm::dmat4& toScene, int longest, InstructionSet set)
{
  constexpr decltype(&hitBase) all[] = { &hitBase, &hitAvx2, &hitAvx512 };
  return all[static_cast<std::size_t>(set)](*this, toScene, longest);
}

bool exactHit(const ExactShear& shear, const glm::dvec3& origin, double last,
  const ExactPositions& positions, const glm::dmat4& toScene, TriangleHit& hit)
{
  const Axes axes(shear.longest);
  const double from[3] = { origin[axes.of[0]], origin[axes.of[1]], origin[axes.of[2]] };
  Edges edges(
    Rows(toScene, axes.of), [&](int corner, int axis) { return double(positions(corner, axis)); },
    [&](int k) { return from[k]; }, shear.x, shear.y);
  if (edges.cancelled)
  {
    edges.refine();
  }
  return edges.inside && edges.solve(shear.scale, last, hit.t, hit.u, hit.v);
}

} // namespace hrt
