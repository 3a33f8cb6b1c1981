// Implements the ray structure over Embree: see the header for why triangles are user geometry.
#include "Rendering/Core/Structures/EmbreeStructure.h"

#include "Rendering/Core/Geometry/TriangleTest.h"
#include "Rendering/Core/Structures/EmbreeShim.h"
#include "Rendering/Core/Structures/TraversalRay.h"

#include <chrono>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hrt
{

namespace
{

// An Embree device and the words of its last error.
class Device
{
public:
  explicit Device(const std::string& configuration)
    : Handle(rtcNewDevice(configuration.empty() ? nullptr : configuration.c_str()))
  {
    if (!this->Handle)
    {
      throw std::runtime_error("Embree: no device" + describe(rtcGetDeviceError(nullptr)));
    }
    rtcSetDeviceErrorFunction(this->Handle, &Device::remember, this);
    try
    {
      this->check("creating the device");
    }
    catch (...)
    {
      rtcReleaseDevice(this->Handle);
      throw;
    }
  }

  ~Device() { rtcReleaseDevice(this->Handle); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  RTCDevice handle() const { return this->Handle; }

  // Throws when a call since the last check failed on this thread.
  void check(const char* doing)
  {
    const RTCError error = rtcGetDeviceError(this->Handle);
    if (error == RTC_ERROR_NONE)
    {
      return;
    }
    const std::lock_guard<std::mutex> lock(this->Mutex);
    throw std::runtime_error(
      "Embree: " + std::string(doing) + " failed" + describe(error) + " " + this->Message);
  }

private:
  static std::string describe(RTCError error)
  {
    switch (error)
    {
      case RTC_ERROR_INVALID_ARGUMENT:
        return " (invalid argument)";
      case RTC_ERROR_INVALID_OPERATION:
        return " (invalid operation)";
      case RTC_ERROR_OUT_OF_MEMORY:
        return " (out of memory)";
      case RTC_ERROR_UNSUPPORTED_CPU:
        return " (unsupported processor)";
      case RTC_ERROR_CANCELLED:
        return " (cancelled)";
      default:
        return " (unknown error)";
    }
  }

  static void remember(void* self, RTCError, const char* message)
  {
    Device& device = *static_cast<Device*>(self);
    const std::lock_guard<std::mutex> lock(device.Mutex);
    device.Message = message ? message : "";
  }

  RTCDevice Handle;
  std::mutex Mutex;
  std::string Message;
};

// The hierarchy of one geometry's triangles, in the coordinates of its positions.
class TriangleScene
{
public:
  TriangleScene(Device& device, std::shared_ptr<const Geometry> geometry);
  ~TriangleScene() { rtcReleaseScene(this->Scene); }
  TriangleScene(const TriangleScene&) = delete;
  TriangleScene& operator=(const TriangleScene&) = delete;

  RTCScene scene() const { return this->Scene; }
  const Geometry& triangles() const { return *this->Triangles; }
  const TraversalBox& box() const { return this->Box; }

private:
  static void boundsOf(const RTCBoundsFunctionArguments* arguments);

  std::shared_ptr<const Geometry> Triangles;
  TraversalBox Box;
  RTCScene Scene = nullptr;
};

// A placed TriangleScene.
struct Instance
{
  std::shared_ptr<const TriangleScene> triangles;
  glm::dmat4 toScene;  // from the geometry's positions
  glm::dmat4 fromScene;
  TraversalBox box;    // in scene coordinates
  TriangleId firstTriangle = 0;
  bool visibleToRays = true;
  bool castsShadow = true;

  bool operator==(const Instance& o) const
  {
    return triangles == o.triangles && toScene == o.toScene && firstTriangle == o.firstTriangle &&
      visibleToRays == o.visibleToRays && castsShadow == o.castsShadow;
  }
};

// What one ray looks for, shared by both levels of its traversal.
struct Search
{
  const Ray& ray;
  ShearedRay exact;
  Hit best;
  bool found = false; // for occlusion: some hit

  explicit Search(const Ray& r)
    : ray(r)
    , exact(r.origin, r.direction)
  {
  }
  double end() const { return this->best.valid() ? this->best.t : this->ray.tMaximum; }
};

// A search's passage through one hierarchy. Embree hands the context back to the callbacks, which
// know that it belongs to a query.
struct Query : embree::QueryContext
{
  Search& search;
  TraversalRay traversal;
  const Instance* instance = nullptr; // on the lower level

  explicit Query(Search& s)
    : search(s)
  {
    embree::initialize(*this);
  }
};

template <class Arguments>
Query& queryOf(const Arguments* arguments)
{
  return *static_cast<Query*>(arguments->context);
}

RTCRay traversalRay(const Query& query)
{
  RTCRay ray{};
  ray.org_x = query.traversal.origin.x;
  ray.org_y = query.traversal.origin.y;
  ray.org_z = query.traversal.origin.z;
  ray.dir_x = query.traversal.direction.x;
  ray.dir_y = query.traversal.direction.y;
  ray.dir_z = query.traversal.direction.z;
  ray.tnear = 0.0f;
  ray.tfar = query.traversal.end(query.search.end());
  ray.mask = ~0u;
  return ray;
}

void traverse(RTCScene scene, Query& query)
{
  RTCRayHit rayHit{};
  rayHit.ray = traversalRay(query);
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(scene, query, rayHit);
}

void traverseForAny(RTCScene scene, Query& query)
{
  RTCRay ray = traversalRay(query);
  embree::occluded(scene, query, ray);
}

// Only single rays are ever traced, so that Embree's bundles have the layout of one ray.
RTCRayHit& rayHitOf(const RTCIntersectFunctionNArguments* arguments)
{
  return *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
}

RTCRay& rayOf(const RTCOccludedFunctionNArguments* arguments)
{
  return *reinterpret_cast<RTCRay*>(arguments->ray);
}

// Tells Embree that the search now ends earlier.
void shorten(const RTCIntersectFunctionNArguments* arguments, const Query& query)
{
  RTCRayHit& rayHit = rayHitOf(arguments);
  rayHit.ray.tfar = query.traversal.end(query.search.end());
  rayHit.hit.geomID = arguments->geomID;
  rayHit.hit.primID = arguments->primID;
}

// The exact test of the candidate triangle. The triangle that the ray leaves is no candidate.
bool testTriangle(const Query& query, unsigned int triangle, Hit& hit)
{
  const Instance& instance = *query.instance;
  const Search& search = query.search;
  hit.triangle = instance.firstTriangle + triangle;
  if (hit.triangle == search.ray.originTriangle)
  {
    return false;
  }
  TriangleHit exact;
  const Corners corners =
    sceneCorners(instance.triangles->triangles(), instance.toScene, triangle);
  if (!search.exact.hitsTriangle(corners, search.ray.tMaximum, exact))
  {
    return false;
  }
  hit.t = exact.t;
  hit.u = exact.u;
  hit.v = exact.v;
  return true;
}

void intersectTriangle(const RTCIntersectFunctionNArguments* arguments)
{
  Query& query = queryOf(arguments);
  Hit hit;
  if (!arguments->valid[0] || !testTriangle(query, arguments->primID, hit))
  {
    return;
  }
  // The order of traversal must not show: of equal hits the smallest number wins.
  Hit& best = query.search.best;
  if (hit.t < best.t || (hit.t == best.t && hit.triangle < best.triangle))
  {
    best = hit;
    shorten(arguments, query);
  }
}

void occludeTriangle(const RTCOccludedFunctionNArguments* arguments)
{
  Query& query = queryOf(arguments);
  Hit hit;
  if (arguments->valid[0] && testTriangle(query, arguments->primID, hit))
  {
    query.search.found = true;
    rayOf(arguments).tfar = -std::numeric_limits<float>::infinity();
  }
}

void setBounds(RTCBounds& bounds, const glm::dvec3& lower, const glm::dvec3& upper, double padding)
{
  bounds.lower_x = static_cast<float>(lower.x - padding);
  bounds.lower_y = static_cast<float>(lower.y - padding);
  bounds.lower_z = static_cast<float>(lower.z - padding);
  bounds.upper_x = static_cast<float>(upper.x + padding);
  bounds.upper_y = static_cast<float>(upper.y + padding);
  bounds.upper_z = static_cast<float>(upper.z + padding);
}

void TriangleScene::boundsOf(const RTCBoundsFunctionArguments* arguments)
{
  const TriangleScene& self = *static_cast<const TriangleScene*>(arguments->geometryUserPtr);
  const glm::vec3* corner = self.Triangles->positions.data() + 3 * std::size_t(arguments->primID);
  const glm::vec3 lower = glm::min(corner[0], glm::min(corner[1], corner[2]));
  const glm::vec3 upper = glm::max(corner[0], glm::max(corner[1], corner[2]));
  setBounds(*arguments->bounds_o, lower, upper, self.Box.padding());
}

// A scene with one user geometry of `count` primitives.
struct UserGeometry
{
  void* data;
  std::size_t count;
  RTCBoundsFunction bounds;
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occluded;
};

RTCScene buildScene(Device& device, const UserGeometry& primitives, const char* doing)
{
  const RTCScene scene = rtcNewScene(device.handle());
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(primitives.count));
  rtcSetGeometryUserData(geometry, primitives.data);
  rtcSetGeometryBoundsFunction(geometry, primitives.bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, primitives.intersect);
  rtcSetGeometryOccludedFunction(geometry, primitives.occluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  try
  {
    device.check(doing);
  }
  catch (...)
  {
    rtcReleaseScene(scene);
    throw;
  }
  return scene;
}

TriangleScene::TriangleScene(Device& device, std::shared_ptr<const Geometry> geometry)
  : Triangles(std::move(geometry))
{
  for (const glm::vec3& position : this->Triangles->positions)
  {
    this->Box.include(position);
  }
  this->Scene = buildScene(device,
    { this, this->Triangles->triangleCount(), &TriangleScene::boundsOf, &intersectTriangle,
      &occludeTriangle },
    "building a geometry's hierarchy");
}

// The hierarchy of the placed parts.
class InstanceScene
{
public:
  InstanceScene(Device& device, std::vector<Instance> instances);
  ~InstanceScene() { rtcReleaseScene(this->Scene); }
  InstanceScene(const InstanceScene&) = delete;
  InstanceScene& operator=(const InstanceScene&) = delete;

  const std::vector<Instance>& instances() const { return this->Instances; }
  const Instance& instance(std::size_t i) const { return this->Instances[i]; }

  // Traces the search when the ray meets the scene's box.
  template <class Traverse>
  void run(Search& search, Traverse traverseScene) const
  {
    Query query(search);
    if (search.exact.valid() && enterBox(this->Box, search.ray.origin, search.ray.direction,
          search.ray.tMaximum, query.traversal))
    {
      traverseScene(this->Scene, query);
    }
  }

private:
  static void boundsOf(const RTCBoundsFunctionArguments* arguments);

  std::vector<Instance> Instances;
  TraversalBox Box;
  RTCScene Scene = nullptr;
};

template <class Arguments>
const Instance& instanceOf(const Arguments* arguments)
{
  return static_cast<const InstanceScene*>(arguments->geometryUserPtr)->instance(arguments->primID);
}

// Enters an instance: its own traversal ray, from the true ray in its coordinates.
bool enterInstance(const Instance& instance, Query& lower)
{
  const Ray& ray = lower.search.ray;
  lower.instance = &instance;
  const glm::dvec3 origin(instance.fromScene * glm::dvec4(ray.origin, 1.0));
  const glm::dvec3 direction = glm::dmat3(instance.fromScene) * ray.direction;
  return enterBox(
    instance.triangles->box(), origin, direction, lower.search.end(), lower.traversal);
}

void intersectInstance(const RTCIntersectFunctionNArguments* arguments)
{
  Query& upper = queryOf(arguments);
  const Instance& instance = instanceOf(arguments);
  Query lower(upper.search);
  if (!arguments->valid[0] || !instance.visibleToRays || !enterInstance(instance, lower))
  {
    return;
  }
  const TriangleId before = upper.search.best.triangle;
  traverse(instance.triangles->scene(), lower);
  if (upper.search.best.triangle != before)
  {
    shorten(arguments, upper);
  }
}

void occludeInstance(const RTCOccludedFunctionNArguments* arguments)
{
  Query& upper = queryOf(arguments);
  const Instance& instance = instanceOf(arguments);
  Query lower(upper.search);
  if (!arguments->valid[0] || !instance.castsShadow || !enterInstance(instance, lower))
  {
    return;
  }
  traverseForAny(instance.triangles->scene(), lower);
  if (upper.search.found)
  {
    rayOf(arguments).tfar = -std::numeric_limits<float>::infinity();
  }
}

void InstanceScene::boundsOf(const RTCBoundsFunctionArguments* arguments)
{
  const InstanceScene& self = *static_cast<const InstanceScene*>(arguments->geometryUserPtr);
  const TraversalBox& box = self.Instances[arguments->primID].box;
  setBounds(*arguments->bounds_o, box.lower, box.upper, self.Box.padding());
}

InstanceScene::InstanceScene(Device& device, std::vector<Instance> instances)
  : Instances(std::move(instances))
{
  for (const Instance& instance : this->Instances)
  {
    this->Box.include(instance.box.lower);
    this->Box.include(instance.box.upper);
  }
  this->Scene = buildScene(device,
    { this, this->Instances.size(), &InstanceScene::boundsOf, &intersectInstance,
      &occludeInstance },
    "building the hierarchy of the parts");
}

Instance makeInstance(
  const Part& part, std::shared_ptr<const TriangleScene> triangles, const glm::dvec3& sceneOrigin)
{
  Instance instance;
  instance.triangles = std::move(triangles);
  instance.toScene = positionsToScene(part, sceneOrigin);
  instance.fromScene = glm::inverse(instance.toScene);
  instance.firstTriangle = part.firstTriangle;
  instance.visibleToRays = part.visibleToRays;
  instance.castsShadow = part.castsShadow;
  const TraversalBox& local = instance.triangles->box();
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 point((corner & 1) ? local.upper.x : local.lower.x,
      (corner & 2) ? local.upper.y : local.lower.y, (corner & 4) ? local.upper.z : local.lower.z,
      1.0);
    instance.box.include(glm::dvec3(instance.toScene * point));
  }
  return instance;
}

bool meetsRays(const Part& part)
{
  return part.geometry->triangleCount() > 0 && (part.visibleToRays || part.castsShadow);
}

} // namespace

struct EmbreeStructure::Implementation
{
  using TriangleScenes = std::unordered_map<std::uint64_t, std::shared_ptr<const TriangleScene>>;

  // The device outlives the scenes: members are destroyed from the last to the first.
  Device device;
  TriangleScenes triangleScenes; // by Geometry::version
  std::unique_ptr<const InstanceScene> parts; // null: nothing to hit

  explicit Implementation(const std::string& configuration)
    : device(configuration)
  {
  }

  // Finds the hierarchy of a geometry among those of this update, takes it over from the last one,
  // or builds it.
  std::shared_ptr<const TriangleScene> trianglesOf(
    const Part& part, TriangleScenes& current, StructureReport& report)
  {
    std::shared_ptr<const TriangleScene>& triangles = current[part.geometry->version];
    if (triangles)
    {
      return triangles;
    }
    const auto known = this->triangleScenes.find(part.geometry->version);
    if (known != this->triangleScenes.end())
    {
      ++report.reused;
      return triangles = known->second;
    }
    ++report.built;
    return triangles = std::make_shared<TriangleScene>(this->device, part.geometry);
  }
};

EmbreeStructure::EmbreeStructure(const std::string& configuration)
  : Impl(std::make_unique<Implementation>(configuration))
{
}

EmbreeStructure::~EmbreeStructure() = default;

StructureReport EmbreeStructure::update(const Snapshot& snapshot)
{
  const auto started = std::chrono::steady_clock::now();
  StructureReport report;
  Implementation::TriangleScenes current;
  std::vector<Instance> instances;
  for (const Part& part : snapshot.parts)
  {
    if (meetsRays(part))
    {
      instances.push_back(makeInstance(
        part, this->Impl->trianglesOf(part, current, report), snapshot.origin));
    }
  }
  const bool same =
    this->Impl->parts ? this->Impl->parts->instances() == instances : instances.empty();
  if (!same)
  {
    // Built before the old one is dropped: an error leaves the structure as it was.
    this->Impl->parts = instances.empty()
      ? nullptr
      : std::make_unique<const InstanceScene>(this->Impl->device, std::move(instances));
    report.partsRebuilt = true;
  }
  this->Impl->triangleScenes.swap(current);
  report.milliseconds =
    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
  return report;
}

Hit EmbreeStructure::intersect(const Ray& ray) const
{
  Search search(ray);
  if (this->Impl->parts)
  {
    this->Impl->parts->run(search, traverse);
  }
  return search.best;
}

bool EmbreeStructure::occluded(const Ray& ray) const
{
  Search search(ray);
  if (this->Impl->parts)
  {
    this->Impl->parts->run(search, traverseForAny);
  }
  return search.found;
}

} // namespace hrt
