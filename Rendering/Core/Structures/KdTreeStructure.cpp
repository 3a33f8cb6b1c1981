// Implements the two levels over KdTree: what is placed where, and how far rounding can move a ray on the
// way from the scene's coordinates into a tree's.
#include "Rendering/Core/Structures/KdTreeStructure.h"

#include "Rendering/Core/Structures/ExactSearch.h"
#include "Rendering/Core/Structures/KdTreeParts.h"

#include <tbb/task_arena.h>

#include <chrono>
#include <unordered_map>

namespace hrt
{

namespace
{

// Half an ulp of 1.
constexpr double kRounding = 0x1p-53;

// A geometry's tree. The geometry is kept alive with it: the exact test reads its positions.
struct TriangleTree
{
  std::shared_ptr<const Geometry> geometry;
  std::unique_ptr<const KdTree> tree;
};

double largest(const glm::dvec3& v)
{
  const glm::dvec3 a = glm::abs(v);
  return std::max({ a.x, a.y, a.z });
}

// The largest sum of a row's absolute values: how much the matrix can stretch `largest`.
double stretch(const glm::dmat3& m)
{
  return largest(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

// A placed tree.
struct Instance
{
  std::shared_ptr<const TriangleTree> triangles;
  PlacedGeometry placed;
  glm::dmat3 inverse{ 1.0 };
  // How far, in the tree's coordinates, rounding can part a ray from its triangles, for each unit of
  // `sceneReach` and of the ray's origin: see slackOf.
  double slackPerUnit = 0.0;
  double sceneReach = 0.0;
  PartBox box;
  bool visibleToRays = true;
  bool castsShadow = true;

  bool operator==(const Instance& o) const
  {
    return triangles == o.triangles && placed.toScene == o.placed.toScene &&
      placed.firstTriangle == o.placed.firstTriangle && visibleToRays == o.visibleToRays &&
      castsShadow == o.castsShadow;
  }
};

// With A the matrix, T its translation, X the computed inverse, R the tree's reach, o the ray's origin,
// S = |A| R + |T|, D = |o| + S and u half an ulp, the distances that matter, in the tree's coordinates:
//   corners in the scene, A p + T                                |X| 4 u S
//   the exact kernel's differences and shear                     |X| 8 u D
//   the origin here, X (o - T), and the direction over a way D   |X| (4 u + 3 u + 2 d) D
//   the time at which a plane is met, 3 u of it                  |X| 6 u D
// where d bounds the relative error of X. From X A = I - E follows |A^-1 - X| <= |E| |A^-1|; E is computed
// with an error of 4 u |X| |A|, and while |E| <= 1/2, |A^-1| <= 2 |X|. Together below
// |X| (32 u + 4 (|E| + 4 u |X| |A|)) D. A matrix that is worse gets infinite slack: then every triangle is
// asked.
double slackPerUnit(const glm::dmat3& matrix, const glm::dmat3& inverse)
{
  const double residual = stretch(glm::dmat3(1.0) - inverse * matrix) +
    4.0 * kRounding * stretch(inverse) * stretch(matrix);
  return residual <= 0.5 ? stretch(inverse) * (32.0 * kRounding + 4.0 * residual)
                         : std::numeric_limits<double>::infinity();
}

Instance makeInstance(
  const Part& part, std::shared_ptr<const TriangleTree> triangles, const glm::dvec3& sceneOrigin)
{
  Instance instance;
  instance.placed = { triangles->geometry.get(), positionsToScene(part, sceneOrigin),
    part.firstTriangle };
  instance.triangles = std::move(triangles);
  instance.visibleToRays = part.visibleToRays;
  instance.castsShadow = part.castsShadow;
  const glm::dmat4& toScene = instance.placed.toScene;
  const glm::dmat3 matrix(toScene);
  instance.inverse = glm::inverse(matrix);
  instance.slackPerUnit = slackPerUnit(matrix, instance.inverse);
  const KdTree& tree = *instance.triangles->tree;
  instance.sceneReach = stretch(matrix) * tree.reach() + largest(glm::dvec3(toScene[3]));
  const glm::dvec3 lower(tree.box().lower), upper(tree.box().upper);
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 point((corner & 1) ? upper.x : lower.x, (corner & 2) ? upper.y : lower.y,
      (corner & 4) ? upper.z : lower.z, 1.0);
    instance.box.include(glm::dvec3(toScene * point));
  }
  return instance;
}

bool meetsRays(const Part& part)
{
  return part.geometry->triangleCount() > 0 && (part.visibleToRays || part.castsShadow);
}

// The true ray with its direction brought away from both ends of the numbers, so that no plane's time
// overflows. Powers of two change no digit.
struct ScaledRay
{
  glm::dvec3 origin, direction;
  double perT = 1.0; // of this ray's parameter

  explicit ScaledRay(const Ray& ray)
    : origin(ray.origin)
    , direction(ray.direction)
  {
    const double longest = largest(ray.direction);
    if (!(longest > 1e-100 && longest < 1e100))
    {
      const int exponent = std::ilogb(longest);
      for (int axis = 0; axis < 3; ++axis)
      {
        this->direction[axis] = std::scalbn(ray.direction[axis], -exponent);
      }
      this->perT = std::scalbn(1.0, std::min(exponent, 1023));
    }
  }
};

using Instances = std::vector<Instance>;

} // namespace

struct KdTreeStructure::Implementation
{
  using Trees = std::unordered_map<std::uint64_t, std::shared_ptr<const TriangleTree>>;

  KdTreeSettings settings;
  Trees trees; // by Geometry::version
  Instances instances;
  KdTreeParts parts;

  std::shared_ptr<const TriangleTree> build(const std::shared_ptr<const Geometry>& geometry) const;
  std::shared_ptr<const TriangleTree> treeOf(
    const Part& part, Trees& current, StructureReport& report);

  // Hands every triangle that the ray may hit to `test(instance, number)`, which returns the t up to
  // which the search goes on.
  template <class Test, class Counters>
  void search(const ExactSearch& search, bool Instance::*takesPart, Test test,
    Counters& counters) const;

  template <class Counters>
  Hit nearest(const Ray& ray, Counters& counters) const;
  template <class Counters>
  bool any(const Ray& ray, Counters& counters) const;
};

std::shared_ptr<const TriangleTree> KdTreeStructure::Implementation::build(
  const std::shared_ptr<const Geometry>& geometry) const
{
  auto result = std::make_shared<TriangleTree>();
  result->geometry = geometry;
  const auto run = [&] { result->tree = KdTree::build(*geometry, this->settings.control); };
  if (this->settings.threads > 0)
  {
    tbb::task_arena(this->settings.threads).execute(run);
  }
  else
  {
    run();
  }
  if (!result->tree)
  {
    throw KdTreeAborted();
  }
  return result;
}

// Finds the tree of a geometry among those of this update, takes it over from the last one, or builds it.
std::shared_ptr<const TriangleTree> KdTreeStructure::Implementation::treeOf(
  const Part& part, Trees& current, StructureReport& report)
{
  std::shared_ptr<const TriangleTree>& tree = current[part.geometry->version];
  if (tree)
  {
    return tree;
  }
  const auto known = this->trees.find(part.geometry->version);
  if (known != this->trees.end())
  {
    ++report.reused;
    return tree = known->second;
  }
  tree = this->build(part.geometry);
  // Also among the old ones at once, so that an abort of the next tree does not cost this one.
  this->trees.emplace(part.geometry->version, tree);
  ++report.built;
  return tree;
}

template <class Test, class Counters>
void KdTreeStructure::Implementation::search(const ExactSearch& search,
  bool Instance::*takesPart, Test test, Counters& counters) const
{
  if (!search.valid() || this->instances.empty())
  {
    return;
  }
  const ScaledRay ray(search.ray());
  const double originReach = largest(ray.origin);
  const auto visit = [&](std::size_t i) {
    const Instance& instance = this->instances[i];
    const double end = search.end() * ray.perT;
    if (!(instance.*takesPart))
    {
      return end;
    }
    const KdTree& tree = *instance.triangles->tree;
    const glm::dvec3 translation(instance.placed.toScene[3]);
    const double slack =
      tree.padding() + instance.slackPerUnit * (originReach + instance.sceneReach);
    KdRay lower;
    if (!lower.enter(tree, instance.inverse * (ray.origin - translation),
          instance.inverse * ray.direction, end, slack))
    {
      return end;
    }
    lower.traverse(
      tree, [&](std::uint32_t triangle) { return test(instance, triangle) * ray.perT; }, counters);
    return test.done() ? -1.0 : search.end() * ray.perT;
  };
  if (this->instances.size() == 1)
  {
    visit(0);
    return;
  }
  // As above without a change of coordinates: corners, kernel and planes.
  const double slack = 32.0 * kRounding * (originReach + this->parts.reach());
  this->parts.traverse(
    KdSlabs(ray.origin, ray.direction, slack), search.end() * ray.perT, visit);
}

namespace
{

struct NearestTest
{
  ExactSearch& search;
  double operator()(const Instance& instance, std::uint32_t triangle)
  {
    this->search.test(instance.placed, triangle);
    return this->search.end();
  }
  bool done() const { return false; }
};

struct AnyTest
{
  ExactSearch& search;
  bool found = false;
  double operator()(const Instance& instance, std::uint32_t triangle)
  {
    this->found = this->search.test(instance.placed, triangle);
    return this->found ? -1.0 : this->search.end();
  }
  bool done() const { return this->found; }
};

} // namespace

template <class Counters>
Hit KdTreeStructure::Implementation::nearest(const Ray& ray, Counters& counters) const
{
  ExactSearch exact(ray);
  this->search(exact, &Instance::visibleToRays, NearestTest{ exact }, counters);
  return exact.best();
}

template <class Counters>
bool KdTreeStructure::Implementation::any(const Ray& ray, Counters& counters) const
{
  ExactSearch exact(ray);
  this->search(exact, &Instance::castsShadow, AnyTest{ exact }, counters);
  return exact.best().valid();
}

KdTreeStructure::KdTreeStructure(const KdTreeSettings& settings)
  : Impl(std::make_unique<Implementation>())
{
  this->Impl->settings = settings;
}

KdTreeStructure::~KdTreeStructure() = default;

StructureReport KdTreeStructure::update(const Snapshot& snapshot)
{
  const auto started = std::chrono::steady_clock::now();
  StructureReport report;
  Implementation::Trees current;
  Instances instances;
  for (const Part& part : snapshot.parts)
  {
    if (meetsRays(part))
    {
      instances.push_back(
        makeInstance(part, this->Impl->treeOf(part, current, report), snapshot.origin));
    }
  }
  if (instances != this->Impl->instances)
  {
    std::vector<PartBox> boxes;
    for (const Instance& instance : instances)
    {
      boxes.push_back(instance.box);
    }
    this->Impl->parts = KdTreeParts(boxes);
    this->Impl->instances.swap(instances);
    report.partsRebuilt = true;
  }
  this->Impl->trees.swap(current);
  report.milliseconds =
    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
  return report;
}

Hit KdTreeStructure::intersect(const Ray& ray) const
{
  KdNoCounters none;
  return this->Impl->nearest(ray, none);
}

bool KdTreeStructure::occluded(const Ray& ray) const
{
  KdNoCounters none;
  return this->Impl->any(ray, none);
}

Hit KdTreeStructure::intersect(const Ray& ray, KdCounters& counters) const
{
  return this->Impl->nearest(ray, counters);
}

bool KdTreeStructure::occluded(const Ray& ray, KdCounters& counters) const
{
  return this->Impl->any(ray, counters);
}

std::vector<KdTreeQuality> KdTreeStructure::quality() const
{
  std::vector<KdTreeQuality> result;
  std::vector<const TriangleTree*> seen;
  for (const Instance& instance : this->Impl->instances)
  {
    if (std::find(seen.begin(), seen.end(), instance.triangles.get()) == seen.end())
    {
      seen.push_back(instance.triangles.get());
      result.push_back(instance.triangles->tree->quality());
    }
  }
  return result;
}

} // namespace hrt
