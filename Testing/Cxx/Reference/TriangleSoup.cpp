// Implements the search without a structure: see the header.
#include "Testing/Cxx/Reference/TriangleSoup.h"

#include "Testing/Cxx/Reference/ExactPredicates.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hrt
{
namespace reference
{

namespace
{

// How far, relative to the largest distance in play, the line of a ray may lie from where an engine
// has it: the ray's origin and direction are rounded when made and when normalised, corners when
// placed, and the engine's test shears all of them once more; each is 2^-53 of that distance, and
// there are less than sixteen of them in each of three coordinates. 2^-47 = 64 * 2^-53.
constexpr double kRayDoubt = 0x1p-47;

// The volumes that a line spans with a triangle's edges, in double.
struct Volumes
{
  double a, b, c, sum, depth;

  // The least share of a corner: positive inside, negative outside.
  double leastShare() const { return std::min({ this->a, this->b, this->c }) / this->sum; }
};

Volumes volumesOf(const SoupRay& ray, const SoupTriangle& triangle)
{
  const glm::dvec3 a = triangle.a - ray.origin;
  const glm::dvec3 b = triangle.b - ray.origin;
  const glm::dvec3 c = triangle.c - ray.origin;
  const glm::dvec3 bc = glm::cross(b, c);
  const glm::dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
  Volumes v;
  v.a = glm::dot(ray.direction, bc);
  v.b = glm::dot(ray.direction, glm::cross(c, a));
  v.c = glm::dot(ray.direction, glm::cross(a, b));
  v.sum = v.a + v.b + v.c;
  if (v.sum < 0.0)
  {
    v = { -v.a, -v.b, -v.c, -v.sum, 0.0 };
  }
  // From the plane's own normal: the volume of the three corners cancels where they lie far away.
  v.depth = glm::dot(normal, a) / glm::dot(normal, ray.direction);
  return v;
}

SoupHit hitFrom(const Volumes& v, const SoupTriangle& triangle)
{
  SoupHit hit;
  hit.triangle = &triangle;
  hit.t = v.depth;
  hit.u = v.b / v.sum;
  hit.v = v.c / v.sum;
  return hit;
}

bool seenFromFront(const SoupRay& ray, const SoupTriangle& triangle)
{
  const glm::dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
  return !(glm::dot(normal, ray.direction) > 0.0);
}

// A triangle that a primary ray hits, or misses by no more than rounding.
struct Candidate
{
  const SoupTriangle* triangle = nullptr;
  ExactMeeting meeting;
  double t = 0.0;
  double tDoubt = 0.0;  // how far rounding may move t
  bool hit = false;     // by exact arithmetic
  bool firm = false;    // no rounding can turn it into a miss
  bool doubtful[3] = { false, false, false }; // at the edge opposite a, b, c
};

using Edge = std::pair<glm::dvec3, glm::dvec3>;

Edge edgeOpposite(const SoupTriangle& t, int corner)
{
  return corner == 0 ? Edge(t.b, t.c) : corner == 1 ? Edge(t.c, t.a) : Edge(t.a, t.b);
}

bool sameEdge(const Edge& a, const Edge& b)
{
  return (a.first == b.first && a.second == b.second) ||
    (a.first == b.second && a.second == b.first);
}

const glm::dvec3& cornerOf(const SoupTriangle& t, int corner)
{
  return corner == 0 ? t.a : corner == 1 ? t.b : t.c;
}

// The plane that holds the edge and the ray's direction keeps the two points apart.
bool onOtherSides(const SoupRay& ray, const Edge& edge, const glm::dvec3& p, const glm::dvec3& q)
{
  const ExactVector from(edge.first);
  const ExactVector normal =
    cross(ExactVector(ray.direction), ExactVector(edge.second) - from);
  return dot(ExactVector(p) - from, normal).sign() * dot(ExactVector(q) - from, normal).sign() < 0;
}

// A line that leaves this triangle by any of its doubtful edges arrives in another one of the list:
// the surface has no gap there.
bool isCovered(const SoupRay& ray, const Candidate& one, const std::vector<Candidate>& all)
{
  for (int corner = 0; corner < 3; ++corner)
  {
    if (!one.doubtful[corner])
    {
      continue;
    }
    const Edge edge = edgeOpposite(*one.triangle, corner);
    const bool closed = std::any_of(all.begin(), all.end(), [&](const Candidate& other) {
      for (int k = 0; k < 3 && &other != &one; ++k)
      {
        if (sameEdge(edge, edgeOpposite(*other.triangle, k)) &&
          onOtherSides(ray, edge, cornerOf(*one.triangle, corner), cornerOf(*other.triangle, k)))
        {
          return true;
        }
      }
      return false;
    });
    if (!closed)
    {
      return false;
    }
  }
  return true;
}

// Fills in what exact arithmetic says; false when the triangle is clearly missed.
bool judge(const SoupRay& ray, double reach, const SoupTriangle& triangle, Candidate& candidate)
{
  candidate.triangle = &triangle;
  candidate.meeting = meet(ray.origin, ray.direction, triangle.a, triangle.b, triangle.c);
  const int turned = candidate.meeting.determinant.sign();
  if (turned == 0)
  {
    return false; // edge-on: the neighbours carry the hit
  }
  const double distance = reach + glm::length(ray.origin);
  const double displacement = kRayDoubt * distance;
  const double speed = glm::length(ray.direction);
  const ExactNumber* weights[3] = { &candidate.meeting.weightA, &candidate.meeting.weightB,
    &candidate.meeting.weightC };
  candidate.firm = true;
  for (int k = 0; k < 3; ++k)
  {
    // The weight is the edge's length across the ray times the ray's distance from it.
    const Edge edge = edgeOpposite(triangle, k);
    const double doubt = speed * glm::length(edge.second - edge.first) * displacement;
    const double weight = turned * weights[k]->approximate();
    candidate.doubtful[k] = std::abs(weight) <= doubt;
    candidate.firm = candidate.firm && weight > doubt;
    if (weight < -doubt)
    {
      return false;
    }
  }
  candidate.hit = candidate.meeting.inside();
  const glm::dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const double along = std::abs(glm::dot(normal, ray.direction));
  candidate.t =
    candidate.meeting.depth.approximate() / candidate.meeting.determinant.approximate();
  candidate.tDoubt = displacement * (1.0 / speed + glm::length(normal) / along);
  return true;
}

} // namespace

TriangleSoup::TriangleSoup(const Snapshot& snapshot)
{
  for (std::size_t p = 0; p < snapshot.parts.size(); ++p)
  {
    const Part& part = snapshot.parts[p];
    glm::dmat4 toScene = part.positionsToWorld();
    toScene[3] -= glm::dvec4(snapshot.origin, 0.0);
    for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
    {
      const auto local = part.geometry->cornerPositions(i);
      glm::dvec3 corner[3];
      for (int k = 0; k < 3; ++k)
      {
        corner[k] = glm::dvec3(toScene * glm::dvec4(glm::dvec3(local[k]), 1.0));
        const glm::dvec3 size = glm::abs(corner[k]);
        this->Reach = std::max({ this->Reach, size.x, size.y, size.z });
      }
      this->Triangles.push_back({ part.firstTriangle + static_cast<TriangleId>(i), p, corner[0],
        corner[1], corner[2] });
    }
  }
}

bool TriangleSoup::forEachHit(const SoupRay& ray, const Filter& counts,
  const std::function<void(const SoupHit&)>& found) const
{
  // What a surface point is uncertain by, in units of the ray's parameter.
  const double touch = kSafeMargin * this->Reach / glm::length(ray.direction);
  bool safe = true;
  for (const SoupTriangle& triangle : this->Triangles)
  {
    if (triangle.id == ray.leaves)
    {
      continue;
    }
    const Volumes v = volumesOf(ray, triangle);
    const double share = v.leastShare();
    if (!(share > -kSafeMargin) || !(v.depth > -touch) || !(v.depth < ray.tMaximum + touch) ||
      !counts(triangle.part, seenFromFront(ray, triangle)))
    {
      continue;
    }
    SoupHit hit = hitFrom(v, triangle);
    hit.safe = share > kSafeMargin && v.depth > touch && v.depth < ray.tMaximum - touch;
    safe = safe && hit.safe;
    if (share >= 0.0 && v.depth > 0.0 && v.depth < ray.tMaximum)
    {
      found(hit);
    }
  }
  return safe;
}

SoupHit TriangleSoup::nearest(const SoupRay& ray, const Filter& counts) const
{
  SoupHit best;
  double second = std::numeric_limits<double>::infinity(); // the next depth behind
  double doubtful = second;                                // the least depth of an unsafe decision
  best.t = second;
  const double touch = kSafeMargin * this->Reach / glm::length(ray.direction);
  for (const SoupTriangle& triangle : this->Triangles)
  {
    if (triangle.id == ray.leaves)
    {
      continue;
    }
    const Volumes v = volumesOf(ray, triangle);
    const double share = v.leastShare();
    if (!(share > -kSafeMargin) || !(v.depth > -touch) || !(v.depth < ray.tMaximum + touch) ||
      !counts(triangle.part, seenFromFront(ray, triangle)))
    {
      continue;
    }
    if (share < kSafeMargin || v.depth < touch || v.depth > ray.tMaximum - touch)
    {
      doubtful = std::min(doubtful, v.depth);
    }
    if (share < 0.0 || v.depth <= 0.0 || v.depth >= ray.tMaximum)
    {
      continue;
    }
    if (v.depth < best.t || (v.depth == best.t && triangle.id > best.triangle->id))
    {
      second = best.t;
      best = hitFrom(v, triangle);
    }
    else
    {
      second = std::min(second, v.depth);
    }
  }
  // Strictly less: without any hit all three are infinite.
  best.safe = !(doubtful < best.t + touch) && !(second < best.t + touch);
  return best;
}

Sighting TriangleSoup::look(const SoupRay& ray, const Filter& counts,
  const std::function<double(double t)>& between) const
{
  std::vector<Candidate> candidates;
  for (const SoupTriangle& triangle : this->Triangles)
  {
    const Volumes v = volumesOf(ray, triangle);
    Candidate candidate;
    // Clearly missed by far more than plain doubles err.
    if (v.leastShare() < -1e3 * kSafeMargin || v.depth <= 0.0 ||
      !counts(triangle.part, seenFromFront(ray, triangle)) ||
      !judge(ray, this->Reach, triangle, candidate) || candidate.meeting.side() <= 0)
    {
      continue;
    }
    const double clearance = between(candidate.t);
    if (clearance > -kSafeMargin)
    {
      candidate.hit = candidate.hit && clearance >= 0.0;
      candidate.firm = candidate.firm && clearance > kSafeMargin;
      candidates.push_back(candidate);
    }
  }
  const Candidate* nearest = nullptr;
  double limit = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates)
  {
    if (candidate.hit && (!nearest || compareDepths(candidate.meeting, nearest->meeting) <= 0))
    {
      nearest = &candidate; // candidates come by rising id: the largest of equals stays
    }
    if (candidate.firm || (candidate.hit && isCovered(ray, candidate, candidates)))
    {
      limit = std::min(limit, candidate.t + candidate.tDoubt);
    }
  }
  Sighting sighting;
  for (const Candidate& candidate : candidates)
  {
    if (candidate.t - candidate.tDoubt <= limit)
    {
      sighting.admissible.push_back(candidate.triangle->id);
    }
  }
  if (limit == std::numeric_limits<double>::infinity())
  {
    sighting.admissible.push_back(kNoTriangle);
  }
  if (nearest)
  {
    const ExactMeeting& m = nearest->meeting;
    const double sum = m.determinant.approximate();
    sighting.hit.triangle = nearest->triangle;
    sighting.hit.t = nearest->t;
    sighting.hit.u = m.weightB.approximate() / sum;
    sighting.hit.v = m.weightC.approximate() / sum;
  }
  sighting.hit.safe = sighting.admissible.size() == 1;
  return sighting;
}

} // namespace reference
} // namespace hrt
