// What the kd-tree costs: its build against the number of triangles and against a naive builder, and its
// rays against Embree - Embree's own single rays and packets over float triangles, and BvhStructure,
// which gives the same exact answers as the tree. One thread unless a name says otherwise.
//
// The machine may be shared and noisy: every benchmark is repeated, the repetitions of all are shuffled,
// and ratios are taken of the fastest ones, which interference can only slow down.
#include "KdTreeScenes.h"
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "Testing/Benchmarks/EmbreeQueries.h"
#include "Testing/Cxx/Reference/NaiveKdTree.h"

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>

namespace
{

using namespace hrt;
using Rays = std::vector<Ray>;

// --- The scene and its rays -------------------------------------------------------------------------

struct Scene
{
  std::string name = "bunny";
  std::shared_ptr<Geometry> mesh;
  Snapshot snapshot;
  KdTreeStructure tree;
  BvhStructure embree;
  std::map<std::string, Rays> rays;

  Scene()
    : mesh(scenes::bunny())
  {
    if (!this->mesh)
    {
      this->name = "sphere";
      this->mesh = scenes::bumpySphere(69451);
    }
    scenes::addPart(this->snapshot, this->mesh);
    this->tree.update(this->snapshot);
    this->embree.update(this->snapshot);
    this->makeRays();
  }

  static const Scene& get()
  {
    static const Scene scene;
    return scene;
  }

private:
  void makeRays();
  void makeSecondary(const Ray& primary, const glm::dvec3& light);
};

// What is seen first, in tiles of 4 x 4 as a tracer would go through the picture.
void Scene::makeRays()
{
  constexpr int kWidth = 400, kHeight = 300;
  const glm::dvec3 lower(this->mesh->boundsMin), upper(this->mesh->boundsMax);
  const glm::dvec3 centre = 0.5 * (lower + upper);
  const double size = glm::length(upper - lower);
  const glm::dvec3 eye = centre + size * glm::dvec3(0.2, 0.2, 0.8);
  const Camera camera = scenes::perspective(eye, centre, kWidth, kHeight);
  const CameraRays view = camera.worldRays(glm::dvec3(0.0));
  for (int i = 0; i < kWidth * kHeight; ++i)
  {
    const int tile = i / 16, within = i % 16, across = kWidth / 4;
    const double x = (tile % across * 4 + within % 4 + 0.5) / kWidth * 2.0 - 1.0;
    const double y = (tile / across * 4 + within / 4 + 0.5) / kHeight * 2.0 - 1.0;
    Ray ray;
    ray.origin = view.origin(x, y);
    ray.direction = view.direction(x, y);
    this->rays["primary"].push_back(ray);
    this->makeSecondary(ray, centre + size * glm::dvec3(1, 1, 1));
  }
  scenes::Random random(3);
  for (int i = 0; i < 100000; ++i)
  {
    Ray ray;
    ray.origin = centre + 0.6 * size * random.direction();
    ray.direction = centre + 0.6 * size * random.direction() - ray.origin;
    this->rays["random"].push_back(ray);
  }
}

void Scene::makeSecondary(const Ray& primary, const glm::dvec3& light)
{
  const Hit hit = this->tree.intersect(primary);
  if (!hit.valid())
  {
    return;
  }
  const std::array<glm::vec3, 3> p = this->mesh->cornerPositions(hit.triangle);
  const glm::dvec3 a(p[0]), b(p[1]), c(p[2]);
  Ray ray;
  ray.originTriangle = hit.triangle;
  ray.origin = a + hit.u * (b - a) + hit.v * (c - a);
  ray.direction = light - ray.origin;
  ray.tMaximum = 1.0;
  this->rays["shadow"].push_back(ray);
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  ray.direction = glm::reflect(glm::normalize(primary.direction), normal);
  ray.tMaximum = std::numeric_limits<double>::infinity();
  this->rays["mirror"].push_back(ray);
}

// --- Embree by itself -------------------------------------------------------------------------------

// Float triangles, the robust flag: the speed to be measured against. Its rays are converted
// beforehand; the structures are given theirs as the tracer has them.
class NativeEmbree
{
public:
  explicit NativeEmbree(const Geometry& mesh)
    : Device(rtcNewDevice(nullptr))
    , Scene(rtcNewScene(this->Device))
  {
    rtcSetSceneFlags(this->Scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(this->Device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(geometry,
      RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), points);
    auto* triangles = static_cast<std::array<std::uint32_t, 3>*>(rtcSetNewGeometryBuffer(geometry,
      RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangleCount()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(this->Scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(this->Scene);
  }
  ~NativeEmbree()
  {
    rtcReleaseScene(this->Scene);
    rtcReleaseDevice(this->Device);
  }

  static RTCRayHit convert(const Ray& ray)
  {
    RTCRayHit result{};
    result.ray.org_x = static_cast<float>(ray.origin.x);
    result.ray.org_y = static_cast<float>(ray.origin.y);
    result.ray.org_z = static_cast<float>(ray.origin.z);
    result.ray.dir_x = static_cast<float>(ray.direction.x);
    result.ray.dir_y = static_cast<float>(ray.direction.y);
    result.ray.dir_z = static_cast<float>(ray.direction.z);
    // What an epsilon is for.
    result.ray.tnear = ray.originTriangle == kNoTriangle ? 0.0f : 1e-4f;
    result.ray.tfar = static_cast<float>(ray.tMaximum);
    result.ray.mask = ~0u;
    result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return result;
  }

  bool hits(RTCRayHit ray, bool any) const
  {
    bvh::QueryContext context;
    bvh::initialize(context);
    if (any)
    {
      bvh::occluded(this->Scene, context, ray.ray);
      return ray.ray.tfar < 0.0f;
    }
    bvh::intersect(this->Scene, context, ray);
    return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

  static std::vector<RTCRayHit16> packets(const Rays& rays)
  {
    std::vector<RTCRayHit16> result((rays.size() + kPacket - 1) / kPacket);
    for (std::size_t i = 0; i < result.size() * kPacket; ++i)
    {
      // The last packet is filled up.
      const RTCRayHit one = convert(rays[std::min(i, rays.size() - 1)]);
      RTCRay16& ray = result[i / kPacket].ray;
      const std::size_t lane = i % kPacket;
      ray.org_x[lane] = one.ray.org_x;
      ray.org_y[lane] = one.ray.org_y;
      ray.org_z[lane] = one.ray.org_z;
      ray.dir_x[lane] = one.ray.dir_x;
      ray.dir_y[lane] = one.ray.dir_y;
      ray.dir_z[lane] = one.ray.dir_z;
      ray.tnear[lane] = one.ray.tnear;
      ray.tfar[lane] = one.ray.tfar;
      ray.mask[lane] = ~0u;
      result[i / kPacket].hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    return result;
  }

  void trace(RTCRayHit16 packet, bool any) const
  {
    alignas(64) int valid[kPacket];
    std::fill(valid, valid + kPacket, -1);
    bvh::QueryContext context;
    bvh::initialize(context);
    if (any)
    {
      bvh::occluded(this->Scene, context, valid, packet.ray);
    }
    else
    {
      bvh::intersect(this->Scene, context, valid, packet);
    }
    benchmark::DoNotOptimize(packet);
  }

private:
  static constexpr std::size_t kPacket = 16;
  RTCDevice Device;
  RTCScene Scene;
};

// --- Benchmarks -------------------------------------------------------------------------------------

bool isAny(const std::string& kind)
{
  return kind == "shadow";
}

const NativeEmbree& nativeEmbree()
{
  static const NativeEmbree native(*Scene::get().mesh);
  return native;
}

void traceNative(benchmark::State& state, const std::string& kind)
{
  const NativeEmbree& native = nativeEmbree();
  std::vector<RTCRayHit> rays;
  for (const Ray& ray : Scene::get().rays.at(kind))
  {
    rays.push_back(NativeEmbree::convert(ray));
  }
  for (auto _ : state)
  {
    int hits = 0;
    for (const RTCRayHit& ray : rays)
    {
      hits += native.hits(ray, isAny(kind));
    }
    benchmark::DoNotOptimize(hits);
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(rays.size()));
}

void trace(benchmark::State& state, const Structure& structure, const std::string& kind)
{
  const Rays& rays = Scene::get().rays.at(kind);
  for (auto _ : state)
  {
    int hits = 0;
    for (const Ray& ray : rays)
    {
      hits += isAny(kind) ? structure.occluded(ray) : structure.intersect(ray).valid();
    }
    benchmark::DoNotOptimize(hits);
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(rays.size()));
}

void traceNativePackets(benchmark::State& state, const std::string& kind)
{
  const NativeEmbree& native = nativeEmbree();
  const std::vector<RTCRayHit16> packets = NativeEmbree::packets(Scene::get().rays.at(kind));
  for (auto _ : state)
  {
    for (const RTCRayHit16& packet : packets)
    {
      native.trace(packet, isAny(kind));
    }
  }
  state.SetItemsProcessed(
    state.iterations() * std::int64_t(Scene::get().rays.at(kind).size()));
}

void traceStream(benchmark::State& state, const Structure& structure, const std::string& kind)
{
  const Rays& rays = Scene::get().rays.at(kind);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  for (auto _ : state)
  {
    if (isAny(kind))
    {
      structure.occluded(rays.data(), occluded.data(), rays.size(), RayOrder::Coherent);
    }
    else
    {
      structure.intersect(rays.data(), hits.data(), rays.size(), RayOrder::Coherent);
    }
    benchmark::DoNotOptimize(hits.data());
    benchmark::DoNotOptimize(occluded.data());
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(rays.size()));
}

void build(benchmark::State& state, const Geometry& mesh, int threads)
{
  tbb::task_arena arena(threads);
  for (auto _ : state)
  {
    arena.execute([&] { benchmark::DoNotOptimize(KdTree::build(mesh)); });
  }
  if (threads > 1)
  {
    state.counters["threads"] = threads;
  }
}

void buildNaive(benchmark::State& state, const Geometry& mesh)
{
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(reference::naiveKdTree(mesh));
  }
}

// --- The table --------------------------------------------------------------------------------------

// Whether a run ended with an error. google-benchmark renamed the member with release 1.8: the second
// form stands for the older ones, and is chosen only where the first cannot be compiled.
template <class Run>
auto failed(const Run& run, int) -> decltype(static_cast<bool>(run.skipped))
{
  return static_cast<bool>(run.skipped);
}
template <class Run>
bool failed(const Run& run, long)
{
  return run.error_occurred;
}

// Keeps the shortest time of each benchmark. Processor time, which waiting for a core does not lengthen,
// for one thread; the clock's for more.
class Fastest : public benchmark::BenchmarkReporter
{
public:
  bool ReportContext(const Context& context) override
  {
    PrintBasicContext(&std::cerr, context);
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override
  {
    for (const Run& run : runs)
    {
      if (run.run_type == Run::RT_Iteration && !failed(run, 0))
      {
        const bool several = run.counters.find("threads") != run.counters.end();
        const double total = several ? run.real_accumulated_time : run.cpu_accumulated_time;
        const double seconds = total / double(run.iterations);
        const auto known = this->Seconds.emplace(run.run_name.function_name, seconds).first;
        known->second = std::min(known->second, seconds);
      }
    }
  }

  // Zero when the benchmark was not run: a filter may leave it out.
  double seconds(const std::string& name) const
  {
    const auto known = this->Seconds.find(name);
    return known == this->Seconds.end() ? 0.0 : known->second;
  }

private:
  std::map<std::string, double> Seconds;
};

const std::vector<double> kGrowth = { 1e3, 1e4, 1e5, 1e6 };
const char* const kKinds[] = { "primary", "shadow", "mirror", "random" };

std::string growthName(double triangles)
{
  return "build/sphere " + std::to_string(static_cast<long>(triangles));
}

void printBuild(const Fastest& fastest)
{
  const std::string name = "build/" + Scene::get().name;
  const double one = fastest.seconds(name + " 1 thread"), two = fastest.seconds(name + " 2 threads");
  const double naive = fastest.seconds(name + " naive");
  if (one == 0.0 || two == 0.0 || naive == 0.0)
  {
    return;
  }
  std::printf("\n%s: %.1f ms with 1 thread, %.1f ms with 2 (%.2f times as fast), naive builder %.1f "
              "ms (%.2f times as long as with 1 thread)\n",
    name.c_str(), 1e3 * one, 1e3 * two, one / two, 1e3 * naive, naive / one);
}

// The slope of the line that fits the logarithms best.
void printGrowth(const Fastest& fastest)
{
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (double triangles : kGrowth)
  {
    const double seconds = fastest.seconds(growthName(triangles));
    if (seconds > 0.0)
    {
      const double x = std::log(triangles), y = std::log(seconds);
      n += 1;
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
    }
  }
  if (n >= 2)
  {
    std::printf("build time grows with the triangles to the power of %.3f\n",
      (n * sxy - sx * sy) / (n * sxx - sx * sx));
  }
}

void printRays(const Fastest& fastest)
{
  std::printf("\nrays, one thread, millions a second\n"
              "%-8s %12s %12s %12s %10s %10s %10s   per ray: %8s %8s %8s %8s\n", "rays",
    "Embree", "exact Embree", "kd-tree", "kd/Embree", "kd/exact", "ex./Embree", "steps", "leaves",
    "blocks", "exact");
  for (const char* kind : kKinds)
  {
    if (fastest.seconds(std::string("KdTreeStructure/") + kind) == 0.0)
    {
      continue;
    }
    const Rays& rays = Scene::get().rays.at(kind);
    const double millions = 1e-6 * double(rays.size());
    const double native = millions / fastest.seconds(std::string("native Embree/") + kind);
    const double exact = millions / fastest.seconds(std::string("BvhStructure/") + kind);
    const double tree = millions / fastest.seconds(std::string("KdTreeStructure/") + kind);
    KdCounters counters;
    for (const Ray& ray : rays)
    {
      isAny(kind) ? Scene::get().tree.occluded(ray, counters)
                  : Scene::get().tree.intersect(ray, counters).valid();
    }
    const double count = double(rays.size());
    std::printf("%-8s %12.2f %12.2f %12.2f %10.2f %10.2f %10.2f %18.1f %8.1f %8.1f %8.2f\n", kind,
      native, exact, tree, tree / native, tree / exact, exact / native, counters.steps / count,
      counters.leaves / count, counters.blockTests / count, counters.candidates / count);
  }
}

void printStreams(const Fastest& fastest)
{
  std::printf("\nstreams, one thread, millions of rays a second\n%-8s %18s %18s %10s\n", "rays",
    "Embree, packets", "exact Embree", "ex./Embree");
  for (const char* kind : kKinds)
  {
    const double native = fastest.seconds(std::string("native packets/") + kind);
    const double exact = fastest.seconds(std::string("BvhStructure stream/") + kind);
    if (native > 0.0 && exact > 0.0)
    {
      const double millions = 1e-6 * double(Scene::get().rays.at(kind).size());
      std::printf("%-8s %18.2f %18.2f %10.2f\n", kind, millions / native, millions / exact,
        native / exact);
    }
  }
}

void registerAll()
{
  const Scene& scene = Scene::get();
  static std::vector<std::shared_ptr<Geometry>> meshes;
  const auto add = [](const std::string& name, auto function) {
    benchmark::RegisterBenchmark(name.c_str(), function)->Unit(benchmark::kMillisecond);
  };
  const std::string name = "build/" + scene.name;
  add(name + " 1 thread", [&](benchmark::State& s) { build(s, *scene.mesh, 1); });
  add(name + " 2 threads", [&](benchmark::State& s) { build(s, *scene.mesh, 2); });
  add(name + " naive", [&](benchmark::State& s) { buildNaive(s, *scene.mesh); });
  for (double triangles : kGrowth)
  {
    meshes.push_back(scenes::bumpySphere(triangles));
    add(growthName(triangles), [mesh = meshes.back()](benchmark::State& s) { build(s, *mesh, 1); });
  }
  for (const char* kind : kKinds)
  {
    add(std::string("native Embree/") + kind,
      [kind](benchmark::State& s) { traceNative(s, kind); });
    add(std::string("native packets/") + kind,
      [kind](benchmark::State& s) { traceNativePackets(s, kind); });
    add(std::string("BvhStructure stream/") + kind,
      [&, kind](benchmark::State& s) { traceStream(s, scene.embree, kind); });
    add(std::string("BvhStructure/") + kind,
      [&, kind](benchmark::State& s) { trace(s, scene.embree, kind); });
    add(std::string("KdTreeStructure/") + kind,
      [&, kind](benchmark::State& s) { trace(s, scene.tree, kind); });
  }
}

} // namespace

int main(int argc, char** argv)
{
  std::vector<char*> arguments(argv, argv + argc);
  // Ahead of the caller's, so that those win.
  char repetitions[] = "--benchmark_repetitions=5";
  char shuffled[] = "--benchmark_enable_random_interleaving=true";
  char shortly[] = "--benchmark_min_time=0.05";
  arguments.insert(arguments.begin() + 1, { repetitions, shuffled, shortly });
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data()))
  {
    return 1;
  }
  registerAll();
  for (const KdTreeQuality& quality : Scene::get().tree.quality())
  {
    std::cout << "kd-tree of the " << Scene::get().name << ": " << quality << "\n";
  }
  Fastest fastest;
  benchmark::RunSpecifiedBenchmarks(&fastest);
  printBuild(fastest);
  printGrowth(fastest);
  printRays(fastest);
  printStreams(fastest);
  return 0;
}
