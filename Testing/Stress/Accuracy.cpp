// Rows 3 to 6: how exact hits are, held against exact arithmetic, and what becomes of the rays that
// leave them.
#include "Testing/Stress/Stress.h"

#include "Rendering/Core/Tracing/Surface.h"
#include "Testing/Cxx/Reference/ExactPredicates.h"

using namespace hrt;
using namespace hrt::stress;
using hrt::reference::ExactMeeting;

namespace
{

class Accuracy : public EveryEngine
{
};

ExactMeeting meetingOf(const Ray& ray, const Corners& c)
{
  return reference::meet(ray.origin, ray.direction, c.a, c.b, c.c);
}

Corners onlyCorners(const Snapshot& snapshot, std::size_t triangle = 0)
{
  const Part& part = snapshot.parts.front();
  return sceneCorners(*part.geometry, positionsToScene(part, snapshot.origin), triangle);
}

double largest(const glm::dvec3& v)
{
  return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
}

// pbrt's triangles: each coordinate of either sign and 10^[-8, 8] in size.
glm::vec3 wildPoint(scenes::Random& random)
{
  glm::vec3 p;
  for (int k = 0; k < 3; ++k)
  {
    const double size = std::pow(10.0, random(-8.0, 8.0));
    p[k] = static_cast<float>(random(-1.0, 1.0) < 0.0 ? -size : size);
  }
  return p;
}

// Translation, rotation and scale, each 10^[-4, 4] in size.
glm::dmat4 wildPlacement(scenes::Random& random)
{
  const auto size = [&] { return std::pow(10.0, random(-4.0, 4.0)); };
  const glm::dvec3 by = size() * random.direction();
  const glm::dvec3 axis = random.direction();
  const glm::dmat4 turned =
    glm::rotate(glm::translate(glm::dmat4(1.0), by), random(0.0, 2.0 * scenes::kPi), axis);
  return glm::scale(turned, glm::dvec3(size(), size(), size()));
}

glm::dvec3 pointIn(const Corners& c, scenes::Random& random)
{
  const double root = std::sqrt(random(0.0, 1.0)), v = random(0.0, 1.0);
  return (1.0 - root) * c.a + root * (1.0 - v) * c.b + root * v * c.c;
}

struct Leaving
{
  std::size_t hits = 0;     // rays that met their wild triangle
  std::size_t rays = 0;     // that left it
  std::size_t again = 0;    // and met it again
  std::size_t withoutId = 0;// would have, were it not for the id
  std::size_t offPlane = 0; // points farther off their plane than they claim

  Leaving& operator+=(const Leaving& o)
  {
    hits += o.hits, rays += o.rays, again += o.again;
    withoutId += o.withoutId, offPlane += o.offPlane;
    return *this;
  }
};

// |n . (p - a)| <= error |n|_max, without rounding. The largest component understates the length of
// n by up to the square root of 3: the test is the stricter for it.
bool isOnPlane(const SurfacePoint& point, const Corners& c)
{
  using namespace reference;
  const ExactVector a(c.a);
  const ExactVector n = cross(ExactVector(c.b) - a, ExactVector(c.c) - a);
  const glm::dvec3 rounded(n.x.approximate(), n.y.approximate(), n.z.approximate());
  const ExactNumber off = dot(n, ExactVector(point.position) - a).abs();
  return compare(off, ExactNumber(largest(rounded)) * ExactNumber(point.positionError)) <= 0;
}

Leaving leaveWildTriangle(const Engine& engine, scenes::Random& random, std::size_t rays)
{
  Leaving sum;
  Snapshot snapshot;
  scenes::addPart(snapshot,
    scenes::makeGeometry({ wildPoint(random), wildPoint(random), wildPoint(random) }),
    wildPlacement(random));
  const auto structure = engine.make();
  structure->update(snapshot);
  const Corners corners = onlyCorners(snapshot);
  const Surfaces surfaces(snapshot);
  const double size = std::max({ largest(corners.a), largest(corners.b), largest(corners.c) });
  const Ray arriving = rayTo(random.inBox(3.0 * size), pointIn(corners, random));
  const Hit hit = structure->intersect(arriving);
  if (!hit.valid())
  {
    return sum; // a needle: the point aimed at is rounded off it
  }
  ++sum.hits;
  const SurfacePoint point = surfaces.at(hit, arriving.direction);
  sum.offPlane += isOnPlane(point, corners) ? 0 : 1;
  for (std::size_t i = 0; i < rays; ++i)
  {
    Ray ray = leave(point, random.direction());
    ++sum.rays;
    sum.again += structure->intersect(ray).valid() || structure->occluded(ray) ? 1 : 0;
    ray.originTriangle = kNoTriangle;
    sum.withoutId += structure->intersect(ray).valid() ? 1 : 0;
  }
  return sum;
}

} // namespace

TEST_P(Accuracy, Row03NothingIsMetAgain)
{
  const std::size_t triangles = scaled(1000.0, 100.0), rays = scaled(1000.0, 100.0);
  scenes::Random random(3);
  Leaving sum;
  for (std::size_t i = 0; i < triangles; ++i)
  {
    sum += leaveWildTriangle(GetParam(), random, rays);
  }
  report(3, std::string("re-intersection ") + GetParam().name,
    "%zu of %zu rays met the triangle they left (0 allowed; without its id %zu would); %zu of %zu "
    "points off their plane by more than they claim (0 allowed)",
    sum.again, sum.rays, sum.withoutId, sum.offPlane, sum.hits);
  EXPECT_GT(sum.hits, triangles / 2);
  EXPECT_EQ(sum.again, 0u);
  EXPECT_EQ(sum.offPlane, 0u);
}

namespace
{

// Relative error of t in ulps of 1, 2^-52, times the cosine of the angle between ray and normal: a
// corner's own rounding already moves the place where a tilted plane is met by its reciprocal. An ulp
// of t itself is worth half to one of these.
constexpr double kMostUlps = 4.0;
constexpr double kMostWeightError = 1e-12;
// Grazed triangles have row 6 to themselves.
constexpr double kLeastCosine = 0.25;

struct Errors
{
  std::size_t hits = 0, missed = 0;
  double ulps = 0.0, weights = 0.0;

  Errors& operator+=(const Errors& o)
  {
    hits += o.hits, missed += o.missed;
    ulps = std::max(ulps, o.ulps), weights = std::max(weights, o.weights);
    return *this;
  }
};

double errorOf(double value, const reference::ExactNumber& numerator,
  const reference::ExactNumber& denominator)
{
  const reference::ExactNumber off = reference::ExactNumber(value) * denominator - numerator;
  return std::abs(off.approximate() / denominator.approximate());
}

} // namespace

TEST_P(Accuracy, Row04HitsAgainstExactArithmetic)
{
  // Random triangles in a box, far enough apart that each ray has one of its own.
  constexpr std::size_t kTriangles = 1000;
  scenes::Random place(4);
  std::vector<glm::vec3> positions;
  for (std::size_t i = 0; i < kTriangles; ++i)
  {
    const glm::vec3 centre(place.inBox(100.0));
    for (int k = 0; k < 3; ++k)
    {
      positions.push_back(centre + glm::vec3(place.inBox(1.0)));
    }
  }
  Snapshot snapshot;
  scenes::addPart(snapshot, scenes::makeGeometry(positions));
  const auto structure = built(snapshot);
  std::vector<Corners> corners;
  for (std::size_t i = 0; i < kTriangles; ++i)
  {
    corners.push_back(onlyCorners(snapshot, i));
  }
  const auto trial = [&](scenes::Random& random) {
    Errors e;
    const std::size_t aimedAt = random.below(kTriangles);
    const Corners& c = corners[aimedAt];
    const glm::dvec3 at = pointIn(c, random);
    const glm::dvec3 direction = random.direction();
    const glm::dvec3 normal = glm::normalize(glm::cross(c.b - c.a, c.c - c.a));
    const double cosine = std::abs(glm::dot(normal, direction));
    if (cosine < kLeastCosine)
    {
      return e;
    }
    // From far enough that t and the corners' distances, whose rounding it is made of, are alike.
    const Ray ray = rayTo(at - random(10.0, 100.0) * direction, at);
    const Hit hit = structure->intersect(ray);
    if (hit.triangle != aimedAt)
    {
      e.missed = 1; // another one stands before it, or the point was rounded over the border
      return e;
    }
    const ExactMeeting exact = meetingOf(ray, c);
    e.hits = 1;
    e.ulps = errorOf(hit.t, exact.depth, exact.determinant) / hit.t * 0x1p52 * cosine;
    e.weights = std::max(errorOf(hit.u, exact.weightB, exact.determinant),
      errorOf(hit.v, exact.weightC, exact.determinant));
    return e;
  };
  const std::size_t rays = scaled(1.4e6); // of which a million count
  const Errors sum = overChunks<Errors>(rays, 4, [&](scenes::Random& random, std::size_t count) {
    Errors e;
    for (std::size_t i = 0; i < count; ++i)
    {
      e += trial(random);
    }
    return e;
  });
  report(4, std::string("hit accuracy ") + GetParam().name,
    "t within %.2f ulps of 1, over the angle's cosine (4 allowed), u and v within %.2g (1e-12 allowed) over %zu hits", sum.ulps,
    sum.weights, sum.hits);
  EXPECT_GT(sum.hits, rays / 2);
  EXPECT_LE(sum.ulps, kMostUlps);
  EXPECT_LE(sum.weights, kMostWeightError);
}

TEST_P(Accuracy, Row05SmallFarTriangles)
{
  // Embree's plane of 100 x 100 cells and its rays from a million away, which it has switched off.
  constexpr int kCells = 100;
  constexpr double kAway = 1e6;
  constexpr double kTolerance = 2e-5;
  std::vector<glm::vec3> positions;
  for (int j = 0; j < kCells; ++j)
  {
    for (int i = 0; i < kCells; ++i)
    {
      const auto p = [&](int di, int dj) { return glm::vec3(i + di, j + dj, 0.0f) / 100.0f; };
      positions.insert(positions.end(), { p(0, 0), p(1, 0), p(1, 1), p(0, 0), p(1, 1), p(0, 1) });
    }
  }
  Snapshot snapshot;
  scenes::addPart(snapshot, scenes::makeGeometry(positions));
  const auto structure = built(snapshot);
  std::size_t wrong = 0, rays = 0;
  double worst = 0.0;
  for (std::size_t i = 0; i < snapshot.triangleCount; ++i)
  {
    const Corners c = onlyCorners(snapshot, i);
    const glm::dvec3 centre = (c.a + c.b + c.c) / 3.0;
    for (const double z : { kAway, -kAway })
    {
      for (const glm::dvec3& aside : { glm::dvec3(0.0), glm::dvec3(3e5, -2e5, 0.0) })
      {
        const Ray ray = rayTo(centre + aside + glm::dvec3(0, 0, z), centre);
        const Hit hit = structure->intersect(ray);
        ++rays;
        wrong += hit.triangle == i ? 0 : 1;
        const glm::dvec3 at = c.a + hit.u * (c.b - c.a) + hit.v * (c.c - c.a);
        worst = std::max(worst, hit.triangle == i ? glm::length(at - centre) : 0.0);
      }
    }
  }
  report(5, std::string("small far triangles ") + GetParam().name,
    "%zu of %zu rays hit another triangle or none (0 allowed), points within %.2g (2e-5 allowed)",
    wrong, rays, worst);
  EXPECT_EQ(wrong, 0u);
  EXPECT_LE(worst, kTolerance);
}

namespace
{

// Barycentric distance from the border beyond which a wrong answer is no longer a matter of rounding.
constexpr double kSliverDoubt = 1e-9;

// The least corner weight, by exact arithmetic where long double would not be enough.
double leastShare(const Ray& ray, const Corners& c)
{
  using Long = long double;
  Long w[3];
  Long p[3][3], d[3];
  for (int k = 0; k < 3; ++k)
  {
    p[0][k] = Long(c.a[k]) - ray.origin[k];
    p[1][k] = Long(c.b[k]) - ray.origin[k];
    p[2][k] = Long(c.c[k]) - ray.origin[k];
    d[k] = ray.direction[k];
  }
  const auto volume = [&](int i, int j) {
    return d[0] * (p[i][1] * p[j][2] - p[i][2] * p[j][1]) +
      d[1] * (p[i][2] * p[j][0] - p[i][0] * p[j][2]) +
      d[2] * (p[i][0] * p[j][1] - p[i][1] * p[j][0]);
  };
  w[0] = volume(1, 2), w[1] = volume(2, 0), w[2] = volume(0, 1);
  const Long rough = std::min({ w[0], w[1], w[2] }) / (w[0] + w[1] + w[2]);
  const Long turned = std::min({ -w[0], -w[1], -w[2] }) / -(w[0] + w[1] + w[2]);
  const Long share = w[0] + w[1] + w[2] > 0 ? rough : turned;
  // Rows of exact numbers cost microseconds: only where the answer hangs on them.
  if (std::abs(share) > 1e3 * kSliverDoubt)
  {
    return static_cast<double>(share);
  }
  const ExactMeeting m = meetingOf(ray, c);
  const double sum = m.determinant.approximate();
  return std::min({ m.weightA.approximate() / sum, m.weightB.approximate() / sum,
    m.weightC.approximate() / sum });
}

struct Verdicts
{
  std::size_t rays = 0, falseHits = 0, missed = 0, hits = 0;
  double worstHit = 0.0, worstMiss = 0.0, depth = 0.0;

  Verdicts& operator+=(const Verdicts& o)
  {
    rays += o.rays, falseHits += o.falseHits, missed += o.missed, hits += o.hits;
    worstHit = std::max(worstHit, o.worstHit), worstMiss = std::max(worstMiss, o.worstMiss);
    depth = std::max(depth, o.depth);
    return *this;
  }
};

// Long and thin: two sides of about 11 and 10, the tip at most 0.7 off their line.
Corners makeSliver(scenes::Random& random, std::vector<glm::vec3>& positions)
{
  const glm::dvec3 along = random.direction();
  const glm::dvec3 across = glm::normalize(glm::cross(along, random.direction()));
  const glm::dvec3 at = random.inBox(20.0);
  positions = { glm::vec3(at), glm::vec3(at + 11.0 * along),
    glm::vec3(at + random(1.0, 10.0) * along + random(0.01, 0.7) * across) };
  return { glm::dvec3(positions[0]), glm::dvec3(positions[1]), glm::dvec3(positions[2]) };
}

// A ray that meets the sliver's plane near the sliver, at a grazing angle.
Ray grazing(const Corners& c, scenes::Random& random)
{
  const glm::dvec3 normal = glm::normalize(glm::cross(c.b - c.a, c.c - c.a));
  const double u = random(-0.3, 1.3), v = random(-0.3, 1.3 - u);
  const glm::dvec3 at = c.a + u * (c.b - c.a) + v * (c.c - c.a);
  const glm::dvec3 flat = glm::normalize(glm::cross(normal, random.direction()));
  const double angle = glm::radians(random(0.02, 2.0));
  const glm::dvec3 direction = std::cos(angle) * flat + std::sin(angle) * normal;
  Ray ray;
  ray.direction = direction;
  ray.origin = at - random(1.0, 600.0) * direction;
  return ray;
}

} // namespace

TEST_P(Accuracy, Row06GrazedSlivers)
{
  constexpr std::size_t kRaysEach = 400;
  const std::size_t slivers = scaled(4e6) / kRaysEach;
  Verdicts sum;
  scenes::Random random(6);
  for (std::size_t s = 0; s < slivers; ++s)
  {
    std::vector<glm::vec3> positions;
    const Corners c = makeSliver(random, positions);
    Snapshot snapshot;
    scenes::addPart(snapshot, scenes::makeGeometry(positions));
    const auto structure = built(snapshot);
    for (std::size_t i = 0; i < kRaysEach; ++i)
    {
      const Ray ray = grazing(c, random);
      const Hit hit = structure->intersect(ray);
      const double share = leastShare(ray, c);
      ++sum.rays;
      sum.hits += hit.valid() ? 1 : 0;
      sum.worstHit = std::max(sum.worstHit, hit.valid() ? -share : 0.0);
      sum.worstMiss = std::max(sum.worstMiss, hit.valid() ? 0.0 : share);
      sum.falseHits += hit.valid() && share < -kSliverDoubt ? 1 : 0;
      sum.missed += !hit.valid() && share > kSliverDoubt ? 1 : 0;
    }
  }
  report(6, std::string("grazed slivers ") + GetParam().name,
    "%zu false hits and %zu misses beyond 1e-9 of %zu rays, %zu hits (0 allowed); borders move by "
    "%.2g outward, %.2g inward",
    sum.falseHits, sum.missed, sum.rays, sum.hits, sum.worstHit, sum.worstMiss);
  EXPECT_GT(sum.hits, sum.rays / 10);
  EXPECT_EQ(sum.falseHits, 0u);
  EXPECT_EQ(sum.missed, 0u);
}

HRT_STRESS_EVERY_ENGINE(Accuracy);
