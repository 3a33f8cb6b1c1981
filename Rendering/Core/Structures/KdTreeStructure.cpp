// Implements the two levels over KdTree: which trees there are, and what is placed where.
#include "Rendering/Core/Structures/KdTreeStructure.h"

#include "Rendering/Core/Structures/KdTreeParts.h"
#include "Rendering/Core/Structures/KdTreeSearch.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <unordered_map>

namespace hrt
{

namespace
{

using kdtree::Instance;
using kdtree::TriangleTree;
using Instances = std::vector<Instance>;

bool meetsRays(const Part& part)
{
  return part.triangleCount() > 0 && (part.visibleToRays || part.castsShadow);
}

} // namespace

struct KdTreeStructure::Implementation
{
  using Trees = std::unordered_map<std::uint64_t, std::shared_ptr<const TriangleTree>>;

  KdTreeSettings settings;
  Trees trees; // by Geometry::version
  Instances instances;
  // Parts with copies, each of which is an instance, made when a ray comes by: kept for a million of
  // them they would fill the memory. Their numbers follow those of the instances.
  struct Copied
  {
    Part part;
    const TriangleTree* triangles;
    std::size_t first; // number of its first copy

    bool operator==(const Copied& o) const
    {
      return triangles == o.triangles && part.copies == o.part.copies &&
        part.localToWorld == o.part.localToWorld && part.firstTriangle == o.part.firstTriangle &&
        part.visibleToRays == o.part.visibleToRays && part.castsShadow == o.part.castsShadow;
    }
  };
  std::vector<Copied> copied;
  glm::dvec3 origin{ 0.0 }; // of the scene, which the copies are placed relative to
  std::size_t count = 0;    // of all instances
  KdTreeParts parts;
  Coincidence coincidence; // of the last update's snapshot

  // The instance of a number; `scratch` holds that of a copy.
  const Instance& instance(std::size_t i, Instance& scratch) const
  {
    if (i < this->instances.size())
    {
      return this->instances[i];
    }
    const auto after = std::upper_bound(this->copied.begin(), this->copied.end(), i,
      [](std::size_t number, const Copied& c) { return number < c.first; });
    const Copied& of = after[-1];
    scratch = makeInstance(of.part, *of.triangles, this->origin, i - of.first);
    return scratch;
  }

  std::shared_ptr<const TriangleTree> build(const std::shared_ptr<const Geometry>& geometry) const;
  std::shared_ptr<const TriangleTree> treeOf(
    const Part& part, Trees& current, StructureReport& report);

  // Asks `test` about every triangle that the ray may hit.
  template <class Test, class Counters>
  void search(const ExactSearch& search, bool Instance::*takesPart, Test& test,
    Counters& counters) const;

  template <class Counters>
  Hit nearest(const Ray& ray, Counters& counters) const;
  template <class Counters>
  bool any(const Ray& ray, Counters& counters) const;
  void all(const Ray& ray, std::vector<Hit>& hits) const;
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
  bool Instance::*takesPart, Test& test, Counters& counters) const
{
  if (!search.valid() || this->count == 0)
  {
    return;
  }
  const kdtree::ScaledRay ray(search.ray());
  const double originReach = largest(ray.origin);
  const auto visit = [&](std::size_t i) {
    Instance scratch;
    const Instance& instance = this->instance(i, scratch);
    if (instance.*takesPart)
    {
      kdtree::searchInstance(instance, ray, originReach, search, test, counters);
    }
    return test.done() ? -1.0 : search.end() * ray.perT;
  };
  if (this->count == 1)
  {
    visit(0);
    return;
  }
  // As Instance::slack without a change of coordinates: corners, kernel and planes.
  const double slack = 32.0 * kRounding * (originReach + this->parts.reach());
  this->parts.traverse(
    KdSlabs(ray.origin, ray.direction, slack), search.end() * ray.perT, visit);
}

template <class Counters>
Hit KdTreeStructure::Implementation::nearest(const Ray& ray, Counters& counters) const
{
  ExactSearch exact(ray, this->coincidence);
  kdtree::NearestTest test{ exact };
  this->search(exact, &Instance::visibleToRays, test, counters);
  return exact.best();
}

void KdTreeStructure::Implementation::all(const Ray& ray, std::vector<Hit>& hits) const
{
  hits.clear();
  ExactSearch exact(ray, this->coincidence, &hits);
  kdtree::NearestTest test{ exact };
  KdNoCounters none;
  this->search(exact, &Instance::visibleToRays, test, none);
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.before(b); });
  // A triangle that a plane has cut lies in several leaves.
  const auto same = [](const Hit& a, const Hit& b) { return a.triangle == b.triangle; };
  hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
}

template <class Counters>
bool KdTreeStructure::Implementation::any(const Ray& ray, Counters& counters) const
{
  ExactSearch exact(ray, this->coincidence);
  kdtree::AnyTest test{ exact };
  this->search(exact, &Instance::castsShadow, test, counters);
  return test.done();
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
  Implementation& impl = *this->Impl;
  Implementation::Trees current;
  Instances instances;
  std::vector<Implementation::Copied> copied;
  std::size_t count = 0;
  for (const Part& part : snapshot.parts)
  {
    if (meetsRays(part) && !part.copies)
    {
      instances.push_back(
        makeInstance(part, *impl.treeOf(part, current, report), snapshot.origin));
      ++count;
    }
  }
  for (const Part& part : snapshot.parts)
  {
    if (meetsRays(part) && part.copies)
    {
      copied.push_back({ part, impl.treeOf(part, current, report).get(), count });
      count += part.copyCount();
    }
  }
  const bool sameCopies =
    copied == impl.copied && (copied.empty() || snapshot.origin == impl.origin);
  if (instances != impl.instances || !sameCopies)
  {
    impl.instances.swap(instances);
    impl.copied.swap(copied);
    impl.origin = snapshot.origin;
    impl.count = count;
    std::vector<PartBox> boxes;
    boxes.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      Instance scratch;
      boxes.push_back(impl.instance(i, scratch).box);
    }
    impl.parts = KdTreeParts(boxes);
    report.partsRebuilt = true;
  }
  this->Impl->trees.swap(current);
  this->Impl->coincidence = Coincidence(snapshot);
  report.milliseconds =
    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
  return report;
}

Hit KdTreeStructure::intersect(const Ray& ray) const
{
  KdNoCounters none;
  return this->Impl->nearest(ray, none);
}

void KdTreeStructure::intersectAll(const Ray& ray, std::vector<Hit>& hits) const
{
  this->Impl->all(ray, hits);
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
    if (std::find(seen.begin(), seen.end(), instance.triangles) == seen.end())
    {
      seen.push_back(instance.triangles);
      result.push_back(instance.triangles->tree->quality());
    }
  }
  return result;
}

} // namespace hrt
