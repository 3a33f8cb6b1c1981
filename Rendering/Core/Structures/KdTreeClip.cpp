// Implements the perfect split by the algorithm of I. Sutherland and G. Hodgman: "Reentrant Polygon
// Clipping", Communications of the ACM 17(1), 1974, one plane after the other.
#include "Rendering/Core/Structures/KdTreeClip.h"

#include <algorithm>
#include <cstring>

namespace hrt
{

namespace
{

// A convex polygon gains at most one corner from each of the six sides of a cell: nine in all. Rounding
// may leave it a hair from convex, and then each cut gains up to every other corner: 3, 4 (a triangle is
// always convex), 6, 9, 13, 19, 28.
struct Polygon
{
  glm::dvec3 corners[28];
  int count = 0;

  void add(const glm::dvec3& corner) { this->corners[this->count++] = corner; }
  const glm::dvec3& after(int i) const { return this->corners[i + 1 < this->count ? i + 1 : 0]; }
};

// Where the edge from a to b meets the plane. Always computed from the lower end, so that two
// triangles that share the edge get the same point; its coordinate along the axis is exact.
glm::dvec3 cut(const glm::dvec3& a, const glm::dvec3& b, int axis, double plane)
{
  const glm::dvec3& from = a[axis] < b[axis] ? a : b;
  const glm::dvec3& to = a[axis] < b[axis] ? b : a;
  const double share = (plane - from[axis]) / (to[axis] - from[axis]);
  glm::dvec3 point = from + share * (to - from);
  point[axis] = plane;
  return point;
}

// Keeps what lies on the side's inner side (sign +1: above the plane) or on the plane itself.
void clip(const Polygon& polygon, int axis, double plane, double sign, Polygon& kept)
{
  kept.count = 0;
  for (int i = 0; i < polygon.count; ++i)
  {
    const glm::dvec3& a = polygon.corners[i];
    const glm::dvec3& b = polygon.after(i);
    const double da = sign * (a[axis] - plane), db = sign * (b[axis] - plane);
    if (da >= 0.0)
    {
      kept.add(a);
    }
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0))
    {
      kept.add(cut(a, b, axis, plane));
    }
  }
}

// The part of a triangle within a cell. Only the sides that the triangle crosses have to be cut: few,
// for few triangles are large.
class PartWithin
{
public:
  PartWithin(const glm::vec3* corners, const KdBox& cell)
  {
    KdBox whole;
    for (int i = 0; i < 3; ++i)
    {
      this->Buffers[0].add(corners[i]);
      whole.include(corners[i]);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      if (whole.lower[axis] < cell.lower[axis])
      {
        this->cutAway(axis, cell.lower[axis], 1.0);
      }
      if (whole.upper[axis] > cell.upper[axis])
      {
        this->cutAway(axis, cell.upper[axis], -1.0);
      }
    }
  }

  const Polygon& polygon() const { return this->Buffers[this->Current]; }

private:
  void cutAway(int axis, double plane, double sign)
  {
    clip(this->polygon(), axis, plane, sign, this->Buffers[1 - this->Current]);
    this->Current = 1 - this->Current;
  }

  Polygon Buffers[2];
  int Current = 0;
};

struct Bounds
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  void include(const glm::dvec3& point)
  {
    this->lower = glm::min(this->lower, point);
    this->upper = glm::max(this->upper, point);
  }
};

// std::nextafter is a library call, and this is where a build spends its time: the next float away
// from zero has the next bit pattern.
float stepped(float f, bool up)
{
  if (f == 0.0f)
  {
    return up ? std::numeric_limits<float>::denorm_min() : -std::numeric_limits<float>::denorm_min();
  }
  std::uint32_t bits;
  std::memcpy(&bits, &f, sizeof(bits));
  bits += (f > 0.0f) == up ? 1u : ~0u;
  std::memcpy(&f, &bits, sizeof(bits));
  return f;
}

float roundedDown(double x)
{
  const float f = static_cast<float>(x);
  return f > x ? stepped(f, false) : f;
}

float roundedUp(double x)
{
  const float f = static_cast<float>(x);
  return f < x ? stepped(f, true) : f;
}

KdBox outward(const Bounds& bounds, const KdBox& cell)
{
  KdBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    // Adding zero turns -0 into +0: the two must not be two places in the order of the events.
    box.lower[axis] = std::max(roundedDown(bounds.lower[axis]), cell.lower[axis]) + 0.0f;
    box.upper[axis] = std::min(roundedUp(bounds.upper[axis]), cell.upper[axis]) + 0.0f;
  }
  return box;
}

// Rounding may leave nothing where exact arithmetic leaves a touching point. The triangle must not
// be lost: what its whole box has in common with the cell holds that point in any case.
KdBox wholeWithin(const glm::vec3* corners, const KdBox& cell)
{
  Bounds bounds;
  for (int i = 0; i < 3; ++i)
  {
    bounds.include(glm::clamp(corners[i], cell.lower, cell.upper));
  }
  return outward(bounds, cell);
}

KdBox finish(const Bounds& bounds, const glm::vec3* corners, const KdBox& cell)
{
  const KdBox box = outward(bounds, cell);
  const bool something = box.lower.x <= box.upper.x && box.lower.y <= box.upper.y &&
    box.lower.z <= box.upper.z;
  return something ? box : wholeWithin(corners, cell);
}

} // namespace

KdSplitBounds splitTriangle(const glm::vec3* corners, const KdBox& cell, int axis, float plane)
{
  const PartWithin part(corners, cell);
  const Polygon& polygon = part.polygon();
  Bounds below, above;
  for (int i = 0; i < polygon.count; ++i)
  {
    const glm::dvec3& a = polygon.corners[i];
    const glm::dvec3& b = polygon.after(i);
    if (a[axis] <= plane)
    {
      below.include(a);
    }
    if (a[axis] >= plane)
    {
      above.include(a);
    }
    if ((a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane))
    {
      const glm::dvec3 point = cut(a, b, axis, plane);
      below.include(point);
      above.include(point);
    }
  }
  KdBox lowerCell = cell, upperCell = cell;
  lowerCell.upper[axis] = plane;
  upperCell.lower[axis] = plane;
  return { finish(below, corners, lowerCell), finish(above, corners, upperCell) };
}

} // namespace hrt
