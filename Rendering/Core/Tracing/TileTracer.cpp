// Implements the Whitted tracer in wavefront form: Turner Whitted, "An Improved Illumination Model for
// Shaded Display", Communications of the ACM 23(6), 1980.
#include "Rendering/Core/Tracing/TileTracer.h"

#include "Rendering/Core/Tracing/Optics.h"

#include <algorithm>
#include <utility>

namespace hrt
{

namespace
{

// A ray whose result counts less than half an 8-bit step is not traced. Where nothing is brighter
// than 1, each such ray changes its pixel by less than this.
constexpr float kLeastWeight = 1.0f / 512.0f;

// A ray goes straight through at most so many translucent surfaces, then sees the background. Their
// opacities would have to be below 9 % each for the rest to weigh more than kLeastWeight.
constexpr int kMostLayers = 64;

float largest(const glm::vec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

} // namespace

TracedFrame::TracedFrame(
  const Snapshot& s, const Structure& rayStructure, const TracerSettings& tracerSettings)
  : snapshot(s)
  , structure(rayStructure)
  , settings(tracerSettings)
  , surfaces(s)
  , meetings(s, surfaces, rayStructure,
      tracerSettings.refractions && tracerSettings.maximumDepth > 0)
  , cameraOrder(s, surfaces)
  , firstHits(s, surfaces, cameraOrder, tracerSettings.multisampling)
  , lighting(s, surfaces, rayStructure, tracerSettings)
  , rays(s.camera.worldRays(s.origin))
  , viewer(glm::dvec3(glm::inverse(s.camera.worldToView)[3]) - s.origin)
{
}

bool TracedFrame::isGlass(const Material& material) const
{
  return material.isGlass() && this->settings.refractions && this->settings.maximumDepth > 0;
}

bool TracedFrame::isMirror(const Material& material) const
{
  return material.isMirror() && this->settings.reflections && this->settings.maximumDepth > 0 &&
    !this->isGlass(material);
}

bool TracedFrame::hasOptics(std::size_t part) const
{
  const Material& material = this->snapshot.parts[part].material;
  return this->isGlass(material) || this->isMirror(material);
}

Ray TracedFrame::primaryRay(std::uint32_t pixel) const
{
  const Camera& camera = this->snapshot.camera;
  const auto width = static_cast<std::uint32_t>(camera.width);
  const double x = (pixel % width + 0.5) / camera.width * 2.0 - 1.0;
  const double y = (pixel / width + 0.5) / camera.height * 2.0 - 1.0;
  Ray ray;
  ray.origin = this->rays.origin(x, y);
  ray.direction = glm::normalize(this->rays.direction(x, y));
  return ray;
}

TileTracer::TileTracer(const TracedFrame& frame)
  : Frame(frame)
{
}

void TileTracer::trace(const std::vector<std::uint32_t>& pixels, Wanted wanted,
  const std::uint32_t* ids, SecondaryImage& image, SecondaryResult& result)
{
  this->Sums.assign(pixels.size(), glm::vec3(0.0f));
  // No hit: nothing to add. In the whole picture alpha 0 says so, in the secondary image the
  // primary colour stays.
  this->Alphas.assign(pixels.size(), wanted == Wanted::Everything ? 0.0f : 1.0f);
  this->Parts.assign(pixels.size(), kNoPart);
  this->Missed.assign(pixels.size(), 0);
  this->Detailed.assign(pixels.size(), 0);
  this->Signatures.assign(pixels.size(), 0);
  this->Sets.clear();
  this->Counters = RayCounters();
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    this->start(static_cast<std::uint32_t>(i), pixels[i], wanted, ids, result);
  }
  // Neighbours' first shadow and mirror rays run side by side; later ones scatter.
  RayOrder order = RayOrder::Coherent;
  this->Frame.lighting.flush(this->Shadows, order, this->Sums, this->Signatures);
  while (!this->Reflected.rays.empty() || !this->Refracted.rays.empty())
  {
    std::swap(this->NowReflected, this->Reflected);
    std::swap(this->NowRefracted, this->Refracted);
    this->follow(this->NowReflected, Kind::Reflected, this->Counters.reflection, order);
    this->follow(
      this->NowRefracted, Kind::Refracted, this->Counters.refraction, RayOrder::Incoherent);
    this->Frame.lighting.flush(this->Shadows, order, this->Sums, this->Signatures);
    order = RayOrder::Incoherent;
  }
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    image.pixels[pixels[i]] = glm::vec4(this->Sums[i], this->Alphas[i]);
  }
  result.rays += this->Counters;
}

TileTracer::Note TileTracer::note(std::size_t index) const
{
  return { this->Parts[index], this->Missed[index] != 0, this->Detailed[index] != 0,
    this->Signatures[index] };
}

// Whether one of the triangles that the pixel may turn out to show is a mirror's or glass.
bool TileTracer::mayShowOptics(std::uint32_t pixel, const std::uint32_t* ids) const
{
  FirstHits::Candidates candidates;
  this->Frame.firstHits.gather(ids, pixel, candidates);
  return std::any_of(candidates.triangles.begin(),
    candidates.triangles.begin() + candidates.count, [this](TriangleId triangle) {
      return this->Frame.hasOptics(this->Frame.snapshot.partOf(triangle));
    });
}

// The surface that a pixel shows, as the visibility engine has found it.
void TileTracer::start(std::uint32_t index, std::uint32_t pixel, Wanted wanted,
  const std::uint32_t* ids, SecondaryResult& result)
{
  result.invalidIds += ids[pixel] > this->Frame.snapshot.triangleCount ? 1 : 0;
  if (wanted == Wanted::SecondaryOnly && !this->mayShowOptics(pixel, ids))
  {
    return;
  }
  const Ray ray = this->Frame.primaryRay(pixel);
  Hit hit;
  Surfaces::Located where;
  const FirstHits::Outcome outcome =
    this->Frame.firstHits.find(ids, pixel, ray, hit, where, result.multisampling);
  this->Missed[index] = outcome == FirstHits::Outcome::Missed;
  if (outcome != FirstHits::Outcome::Found)
  {
    return;
  }
  const SurfacePoint point =
    this->Frame.surfaces.seenAtPixel(hit, ray.direction, pixel, where);
  const Material& material = *point.material;
  const bool mirror = this->Frame.isMirror(material);
  const bool optics = mirror || this->Frame.isGlass(material);
  if (wanted == Wanted::SecondaryOnly && !optics)
  {
    return;
  }
  ++result.interleave.traced;
  result.pixels += optics ? 1 : 0;
  this->Parts[index] = static_cast<std::uint32_t>(point.part);
  Path eye;
  eye.pixel = index;
  eye.way = this->Frame.surfaces.beginning(ray.direction, hit.t);
  if (this->Frame.isGlass(material))
  {
    // What it lies on, or is twin to, comes next. Rays would have said so; the rasteriser does not.
    std::vector<Hit> members;
    this->Frame.meetings.gatherAround(ray, hit, members);
    this->Frame.meetings.order(ray.direction, kNoTriangle, members, hit.triangle);
    this->enter(members, eye);
  }
  if (wanted == Wanted::SecondaryOnly && mirror)
  {
    this->Alphas[index] = 1.0f - material.reflectance;
    this->Signatures[index] +=
      signatureOf(PathEvent::SeenDirectly, 0, point.part, point.frontSide ? 1 : 0);
    this->startMirror(point, ray.direction, eye);
    return;
  }
  this->Alphas[index] = wanted == Wanted::Everything ? 1.0f : 0.0f;
  // As VTK does for every projection, the viewer of a directly seen surface is taken to be at the
  // view coordinates' origin.
  const glm::dvec3 toViewer = glm::normalize(this->Frame.viewer - point.position);
  this->arrive(point, ray.direction, toViewer, eye, Kind::Eye);
}

void TileTracer::startMirror(
  const SurfacePoint& point, const glm::dvec3& direction, const Path& path)
{
  this->spawn(this->Reflected, leave(point, mirrorDirection(point, direction)), path,
    glm::vec3(point.material->reflectance), true);
}

// Puts the path at the first of several surfaces in one place. One alone is none.
void TileTracer::enter(std::vector<Hit>& members, Path& path)
{
  if (members.size() > 1)
  {
    path.set = static_cast<std::int32_t>(this->Sets.size());
    path.member = 0;
    path.step = 1;
    this->Sets.push_back(std::move(members));
  }
}

// To the next surface of the set, or out of it.
void TileTracer::turnOn(Path& path, bool back) const
{
  if (path.set == kNoSet)
  {
    return;
  }
  path.step = back ? -path.step : path.step;
  path.member += path.step;
  const auto size =
    static_cast<std::int32_t>(this->Sets[static_cast<std::size_t>(path.set)].size());
  if (path.member < 0 || path.member >= size)
  {
    path.set = kNoSet;
  }
}

// `back`: to the side that the path has come from.
void TileTracer::spawn(
  PathQueue& queue, const Ray& ray, const Path& path, const glm::vec3& share, bool back)
{
  Path next = path;
  next.weight = path.weight * share;
  next.bounces = path.bounces + 1;
  next.layers = 0;
  this->turnOn(next, back);
  queue.rays.push_back(ray);
  queue.paths.push_back(next);
}

// Takes the queue's rays one generation on. Rays that are too deep or weigh too little are answered
// with nothing.
void TileTracer::follow(PathQueue& queue, Kind kind, RayCount& count, RayOrder order)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i < queue.rays.size(); ++i)
  {
    ++count.asked;
    if (queue.paths[i].bounces > this->Frame.settings.maximumDepth ||
      largest(queue.paths[i].weight) < kLeastWeight)
    {
      ++count.answered;
      continue;
    }
    if (queue.paths[i].set != kNoSet)
    {
      ++count.answered;
      this->Within.rays.push_back(queue.rays[i]);
      this->Within.paths.push_back(queue.paths[i]);
      continue;
    }
    ++count.traced;
    queue.rays[kept] = queue.rays[i];
    queue.paths[kept] = queue.paths[i];
    ++kept;
  }
  this->Hits.resize(kept);
  this->Frame.structure.intersect(queue.rays.data(), this->Hits.data(), kept, order);
  for (std::size_t i = 0; i < kept; ++i)
  {
    Path& path = queue.paths[i];
    Hit& hit = this->Hits[i];
    const glm::dvec3 direction = queue.rays[i].direction;
    if (!hit.valid())
    {
      this->addBackground(direction, path, path.weight);
      continue;
    }
    if (hit.shared)
    {
      hit = this->firstOfSet(queue.rays[i], hit, path);
    }
    path.way.add(hit.t);
    this->arrive(this->Frame.surfaces.seenFrom(hit, direction, path.way), direction, -direction,
      path, kind);
  }
  queue.clear();
  for (std::size_t i = 0; i < this->Within.rays.size(); ++i)
  {
    const Path& path = this->Within.paths[i];
    const Hit& hit = this->Sets[static_cast<std::size_t>(path.set)]
                               [static_cast<std::size_t>(path.member)];
    const glm::dvec3 direction = this->Within.rays[i].direction;
    this->arrive(this->Frame.surfaces.seenFrom(hit, direction, path.way), direction, -direction,
      path, kind);
  }
  this->Within.clear();
}

// The surface that the ray meets first where it may meet several in one place; the path is among them then.
Hit TileTracer::firstOfSet(const Ray& ray, const Hit& hit, Path& path)
{
  std::vector<Hit> members;
  this->Frame.meetings.gather(ray, hit, members);
  this->Frame.meetings.order(ray.direction, ray.originTriangle, members);
  const Hit first = members.empty() ? hit : members.front();
  this->enter(members, path);
  return first;
}

// Adds a surface's own light and sends on the rays that it asks for.
void TileTracer::arrive(const SurfacePoint& point, const glm::dvec3& direction,
  const glm::dvec3& toViewer, const Path& path, Kind kind)
{
  const PathEvent event = kind == Kind::Eye ? PathEvent::SeenDirectly
    : kind == Kind::Reflected               ? PathEvent::Reflected
                                            : PathEvent::Refracted;
  this->Signatures[path.pixel] +=
    signatureOf(event, path.bounces, point.part, point.frontSide ? 1 : 0);
  if (this->Frame.snapshot.parts[point.part].hasDetail())
  {
    this->Detailed[path.pixel] = 1;
  }
  if (this->Frame.isGlass(*point.material))
  {
    this->arriveAtGlass(point, direction, toViewer, path);
    return;
  }
  // What is seen directly is never translucent: VTK draws such actors itself.
  const float opacity = path.bounces == 0 ? 1.0f : point.opacity;
  const float mirror =
    this->Frame.isMirror(*point.material) ? point.material->reflectance : 0.0f;
  const Lighting::Target target{ path.pixel, path.weight * (opacity * (1.0f - mirror)),
    this->Sums[path.pixel], this->Signatures[path.pixel], path.bounces,
    path.bounces == 0 && path.layers == 0 };
  this->Frame.lighting.shade(point, toViewer, target, this->Shadows, this->Counters.shadow);
  if (mirror > 0.0f)
  {
    Path opaque = path;
    opaque.weight *= opacity;
    this->startMirror(point, direction, opaque);
  }
  if (opacity < 1.0f)
  {
    this->passThrough(point, direction, path, kind);
  }
}

// Straight on behind a translucent surface: the same ray prolonged, no new bounce.
void TileTracer::passThrough(const SurfacePoint& point, const glm::dvec3& direction,
  const Path& path, Kind kind)
{
  PathQueue& sameKind = kind == Kind::Reflected ? this->Reflected : this->Refracted;
  Path next = path;
  next.weight *= 1.0f - point.opacity;
  this->turnOn(next, false);
  if (++next.layers > kMostLayers)
  {
    this->addBackground(direction, path, next.weight);
    return;
  }
  sameKind.rays.push_back(leave(point, direction));
  sameKind.paths.push_back(next);
}

// Without reflections the light that glass would reflect goes the way of the refracted; where
// everything is reflected nothing is left.
void TileTracer::arriveAtGlass(const SurfacePoint& point, const glm::dvec3& direction,
  const glm::dvec3& toViewer, const Path& path)
{
  const Boundary boundary = boundaryAt(point, direction);
  this->Frame.lighting.highlights(point, toViewer,
    { path.pixel, path.weight, this->Sums[path.pixel], this->Signatures[path.pixel],
      path.bounces },
    this->Shadows, this->Counters.shadow);
  const bool reflections = this->Frame.settings.reflections;
  const auto reflectance = static_cast<float>(boundary.reflectance);
  if (point.edgeShare > 0.0f) // edges are painted on
  {
    this->Sums[path.pixel] +=
      path.weight * point.edgeShare * point.material->edges.color * point.textureColor;
  }
  if (reflections)
  {
    this->spawn(this->Reflected, leave(point, boundary.reflected), path,
      glm::vec3(reflectance * (1.0f - point.edgeShare)), true);
  }
  if (boundary.reflectance < 1.0)
  {
    const float share = reflections ? 1.0f - reflectance : 1.0f;
    this->spawn(
      this->Refracted, leave(point, boundary.refracted), path, share * point.diffuseColor, false);
  }
}

void TileTracer::addBackground(
  const glm::dvec3& direction, const Path& path, const glm::vec3& weight)
{
  this->Sums[path.pixel] += weight * this->background(direction);
  this->Signatures[path.pixel] += signatureOf(PathEvent::Background, path.bounces, 0, 0);
}

glm::vec3 TileTracer::background(const glm::dvec3& direction) const
{
  const Background& b = this->Frame.snapshot.background;
  const float height =
    0.5f * (1.0f + static_cast<float>(glm::dot(glm::normalize(direction), glm::dvec3(b.up))));
  return glm::mix(b.bottom, b.top, glm::clamp(height, 0.0f, 1.0f));
}

} // namespace hrt
