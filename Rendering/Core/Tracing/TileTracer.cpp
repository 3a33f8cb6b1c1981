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
  const glm::dvec3 origins[] = { this->rays.origin0, this->rays.originX, this->rays.originY };
  const glm::dvec3 directions[] = { this->rays.direction0, this->rays.directionX,
    this->rays.directionY };
  for (int i = 0; i < 3; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->pixelRays.origin[i][axis] = origins[i][axis];
      this->pixelRays.direction[i][axis] = directions[i][axis];
    }
  }
  this->pixelRays.width = s.camera.width;
  this->pixelRays.height = s.camera.height;
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
  , Block(frame.surfaces)
{
}

void TileTracer::trace(const std::vector<std::uint32_t>& pixels, Wanted wanted,
  const std::uint32_t* ids, SecondaryImage& image, SecondaryResult& result)
{
  this->Sums.assign(pixels.size(), glm::vec3(0.0f));
  // No hit: nothing to add. In the whole picture alpha 0 says so, in the secondary image the
  // primary colour stays.
  this->Alphas.assign(pixels.size(), noLight(wanted).a);
  this->Parts.assign(pixels.size(), kNoPart);
  this->Missed.assign(pixels.size(), 0);
  this->Detailed.assign(pixels.size(), 0);
  this->Signatures.assign(pixels.size(), 0);
  this->Sets.clear();
  this->Counters = RayCounters();
  this->start(pixels, wanted, ids, result);
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

// The surfaces that the pixels show, as the visibility engine has found them.
void TileTracer::start(const std::vector<std::uint32_t>& pixels, Wanted wanted,
  const std::uint32_t* ids, SecondaryResult& result)
{
  const bool everywhere = testsAlways(this->Frame.settings.multisampling);
  unsigned int count = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    const std::uint32_t id = ids[pixels[i]];
    const bool valid = id <= this->Frame.snapshot.triangleCount;
    result.invalidIds += valid ? 0 : 1;
    if ((everywhere || (id != 0 && valid)) &&
      (wanted == Wanted::Everything || this->mayShowOptics(pixels[i], ids)))
    {
      this->Indices[count] = static_cast<std::uint32_t>(i);
      this->Block.lanes().pixel[count] = pixels[i];
      ++count;
    }
    if (count == SurfaceBlock::kLanes || (count > 0 && i + 1 == pixels.size()))
    {
      this->startBlock(count, wanted, ids, result);
      count = 0;
    }
  }
}

void TileTracer::startBlock(
  unsigned int count, Wanted wanted, const std::uint32_t* ids, SecondaryResult& result)
{
  this->Block.pixelRays(this->Frame.pixelRays, count);
  const std::uint32_t* pixels = this->Block.lanes().pixel;
  const Multisampling mode = this->Frame.settings.multisampling;
  unsigned int found = 0;
  if (!testsAlways(mode))
  {
    for (unsigned int lane = 0; lane < count; ++lane)
    {
      this->Block.set(lane, ids[pixels[lane]] - 1);
    }
    found = this->Block.meet(count, mode != Multisampling::Clamp);
  }
  for (unsigned int lane = 0; lane < count && mode != Multisampling::Clamp; ++lane)
  {
    if (((found >> lane) & 1u) == 0)
    {
      Hit hit;
      const FirstHits::Outcome outcome = this->Frame.firstHits.find(
        ids, pixels[lane], this->Block.ray(lane), hit, this->Where, result.multisampling);
      this->Missed[this->Indices[lane]] = outcome == FirstHits::Outcome::Missed;
      if (outcome == FirstHits::Outcome::Found)
      {
        this->Block.set(lane, hit.triangle);
        this->Block.setHit(lane, hit);
        found |= 1u << lane;
      }
    }
  }
  for (unsigned int lane = 0; lane < count; ++lane)
  {
    if (((found >> lane) & 1u) == 0)
    {
      continue;
    }
    const std::size_t part = this->Block.partIndex(lane);
    const bool optics = this->Frame.hasOptics(part);
    if (wanted == Wanted::SecondaryOnly && !optics)
    {
      found &= ~(1u << lane);
      continue;
    }
    ++result.interleave.traced;
    result.pixels += optics ? 1 : 0;
    const std::uint32_t index = this->Indices[lane];
    this->Parts[index] = static_cast<std::uint32_t>(part);
    this->Alphas[index] = wanted == Wanted::Everything ? 1.0f : 0.0f;
    Path& eye = this->Eyes[lane];
    eye = Path();
    eye.pixel = index;
    if (optics)
    {
      eye.way = this->Frame.surfaces.beginning(this->Block.ray(lane).direction,
        this->Block.hit(lane).t);
    }
    if (this->Block.part(lane).showsEdges())
    {
      found &= ~(1u << lane);
      this->startAlone(lane, wanted);
    }
  }
  if (found == 0)
  {
    return;
  }
  // As VTK does for every projection, the viewer of a directly seen surface is taken to be at the
  // view coordinates' origin.
  this->Block.evaluate(count, found, &this->Frame.viewer);
  for (unsigned int lane = 0; lane < count; ++lane)
  {
    if (((found >> lane) & 1u) != 0 && this->Frame.hasOptics(this->Block.partIndex(lane)) &&
      this->startOptics(this->Block.point(lane), this->Block.ray(lane), this->Block.hit(lane),
        this->Eyes[lane], wanted))
    {
      found &= ~(1u << lane);
    }
  }
  this->arrive(found, this->Eyes, Kind::Eye);
}

// A surface with edges.
void TileTracer::startAlone(unsigned int lane, Wanted wanted)
{
  const Ray ray = this->Block.ray(lane);
  const Hit hit = this->Block.hit(lane);
  const SurfacePoint point = this->Frame.surfaces.seenAtPixel(
    hit, ray.direction, this->Block.lanes().pixel[lane], this->Where);
  if (!this->startOptics(point, ray, hit, this->Eyes[lane], wanted))
  {
    this->arrive(point, ray.direction, glm::normalize(this->Frame.viewer - point.position),
      this->Eyes[lane], Kind::Eye);
  }
}

// What is to be done before a path arrives at the first mirror or glass. True: it does not arrive, only its
// mirror image is wanted.
bool TileTracer::startOptics(
  const SurfacePoint& point, const Ray& ray, const Hit& hit, Path& eye, Wanted wanted)
{
  if (this->Frame.isGlass(*point.material))
  {
    // What it lies on, or is twin to, comes next. Rays would have said so; the rasteriser does not.
    std::vector<Hit> members;
    this->Frame.meetings.gatherAround(ray, hit, members);
    this->Frame.meetings.order(ray.direction, kNoTriangle, members, hit.triangle);
    this->enter(members, eye);
  }
  if (wanted != Wanted::SecondaryOnly || !this->Frame.isMirror(*point.material))
  {
    return false;
  }
  this->Alphas[eye.pixel] = 1.0f - point.material->reflectance;
  this->note(PathEvent::SeenDirectly, eye, point.part, point.frontSide ? 1 : 0);
  this->startMirror(point, ray.direction, eye);
  return true;
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
  unsigned int lanes = 0;
  const auto arriveAtAll = [&]
  {
    if (lanes > 0)
    {
      this->arriveFrom(lanes, this->Arriving, kind);
      lanes = 0;
    }
  };
  // A pixel's paths arrive one after the other, whatever other pixels' do: its sums have one order.
  const auto waitFor = [&](const Path& path)
  {
    const bool pending = std::any_of(this->Arriving, this->Arriving + lanes,
      [&path](const Path& other) { return other.pixel == path.pixel; });
    if (pending || lanes == SurfaceBlock::kLanes)
    {
      arriveAtAll();
    }
  };
  for (std::size_t i = 0; i < kept; ++i)
  {
    Path& path = queue.paths[i];
    Hit& hit = this->Hits[i];
    waitFor(path);
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
    this->put(lanes++, hit, direction, path);
  }
  queue.clear();
  for (std::size_t i = 0; i < this->Within.rays.size(); ++i)
  {
    const Path& path = this->Within.paths[i];
    const Hit& hit = this->Sets[static_cast<std::size_t>(path.set)]
                               [static_cast<std::size_t>(path.member)];
    waitFor(path);
    this->put(lanes++, hit, this->Within.rays[i].direction, path);
  }
  arriveAtAll();
  this->Within.clear();
}

// Where a path's ray has met a surface.
void TileTracer::put(
  unsigned int lane, const Hit& hit, const glm::dvec3& direction, const Path& path)
{
  this->Block.set(lane, hit.triangle);
  this->Block.setHit(lane, hit);
  this->Block.setDirection(lane, direction);
  this->Arriving[lane] = path;
}

// The first `count` lanes' rays arrive.
void TileTracer::arriveFrom(unsigned int count, const Path* paths, Kind kind)
{
  unsigned int bits = (1u << count) - 1u;
  for (unsigned int lane = 0; lane < count; ++lane)
  {
    if (this->Block.part(lane).showsEdges())
    {
      bits &= ~(1u << lane);
      const glm::dvec3 direction = this->Block.ray(lane).direction;
      this->arrive(
        this->Frame.surfaces.seenFrom(this->Block.hit(lane), direction, paths[lane].way),
        direction, -direction, paths[lane], kind);
    }
  }
  if (bits != 0)
  {
    this->Block.evaluate(count, bits, nullptr);
    this->arrive(bits, paths, kind);
  }
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

// Adds the light of the block's surfaces and sends on the rays that they ask for.
void TileTracer::arrive(unsigned int bits, const Path* paths, Kind kind)
{
  unsigned int together = 0, glass = 0;
  const Lighting::Target* targets[SurfaceBlock::kLanes] = {};
  for (; bits != 0; bits &= bits - 1)
  {
    const auto lane = static_cast<unsigned int>(__builtin_ctz(bits));
    const Part& part = this->Block.part(lane);
    const Path& path = paths[lane];
    const Material& material = part.material;
    const bool mirror = this->Frame.isMirror(material);
    // What is seen directly is never translucent: VTK draws such actors itself.
    const float opacity = path.bounces == 0 ? 1.0f : this->Block.coloring(lane).opacity;
    if (this->Frame.isGlass(material))
    {
      this->noteArrival(path, part, this->Block.partIndex(lane), this->Block.isFront(lane), kind);
      this->sendThroughGlass(this->Block.point(lane), this->Block.ray(lane).direction, path);
      if (material.lit)
      {
        this->Targets[lane].emplace(this->highlightOf(path));
        targets[lane] = &*this->Targets[lane];
        glass |= 1u << lane;
      }
      continue;
    }
    if (!Lighting::goesInBlocks(material) || opacity < 1.0f)
    {
      const Ray ray = this->Block.ray(lane);
      this->arrive(this->Block.point(lane), ray.direction,
        SurfaceBlock::vectorOf(this->Block.lanes().toViewer, lane), path, kind);
      continue;
    }
    this->noteArrival(path, part, this->Block.partIndex(lane), this->Block.isFront(lane), kind);
    this->Targets[lane].emplace(
      this->targetOf(path, mirror ? material.reflectance : 0.0f, opacity));
    targets[lane] = &*this->Targets[lane];
    together |= 1u << lane;
    if (mirror)
    {
      Path opaque = path;
      opaque.weight *= opacity;
      this->startMirror(this->Block.point(lane), this->Block.ray(lane).direction, opaque);
    }
  }
  if (together != 0)
  {
    this->Frame.lighting.shade(
      this->Block, together, targets, this->Shadows, this->Counters.shadow);
  }
  if (glass != 0)
  {
    this->Frame.lighting.highlights(
      this->Block, glass, targets, this->Shadows, this->Counters.shadow);
  }
}

void TileTracer::noteArrival(
  const Path& path, const Part& part, std::size_t index, bool front, Kind kind)
{
  this->note(kind == Kind::Eye    ? PathEvent::SeenDirectly
      : kind == Kind::Reflected ? PathEvent::Reflected
                                : PathEvent::Refracted,
    path, index, front ? 1 : 0);
  if (part.hasDetail())
  {
    this->Detailed[path.pixel] = 1;
  }
}

void TileTracer::note(
  PathEvent event, const Path& path, std::size_t index, unsigned int outcome)
{
  if (this->Frame.settings.interleave > 1) // only interpolation asks
  {
    this->Signatures[path.pixel] += signatureOf(event, path.bounces, index, outcome);
  }
}

// What the light of a surface at the path's end goes to.
Lighting::Target TileTracer::targetOf(const Path& path, float mirror, float opacity)
{
  return { path.pixel, path.weight * (opacity * (1.0f - mirror)), this->Sums[path.pixel],
    this->Signatures[path.pixel], path.bounces, path.bounces == 0 && path.layers == 0 };
}

// The highlights on glass are no matter of shadow maps.
Lighting::Target TileTracer::highlightOf(const Path& path)
{
  return { path.pixel, path.weight, this->Sums[path.pixel], this->Signatures[path.pixel],
    path.bounces };
}

// Of one surface.
void TileTracer::arrive(const SurfacePoint& point, const glm::dvec3& direction,
  const glm::dvec3& toViewer, const Path& path, Kind kind)
{
  this->noteArrival(
    path, this->Frame.snapshot.parts[point.part], point.part, point.frontSide, kind);
  if (this->Frame.isGlass(*point.material))
  {
    this->arriveAtGlass(point, direction, toViewer, path);
    return;
  }
  const float opacity = path.bounces == 0 ? 1.0f : point.opacity;
  const float mirror =
    this->Frame.isMirror(*point.material) ? point.material->reflectance : 0.0f;
  this->Frame.lighting.shade(point, toViewer, this->targetOf(path, mirror, opacity), this->Shadows,
    this->Counters.shadow);
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

void TileTracer::arriveAtGlass(const SurfacePoint& point, const glm::dvec3& direction,
  const glm::dvec3& toViewer, const Path& path)
{
  this->Frame.lighting.highlights(
    point, toViewer, this->highlightOf(path), this->Shadows, this->Counters.shadow);
  this->sendThroughGlass(point, direction, path);
}

// Without reflections the light that glass would reflect goes the way of the refracted; where
// everything is reflected nothing is left.
void TileTracer::sendThroughGlass(
  const SurfacePoint& point, const glm::dvec3& direction, const Path& path)
{
  const Boundary boundary = boundaryAt(point, direction);
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
  this->note(PathEvent::Background, path, 0, 0);
}

glm::vec3 TileTracer::background(const glm::dvec3& direction) const
{
  const Background& b = this->Frame.snapshot.background;
  const float height =
    0.5f * (1.0f + static_cast<float>(glm::dot(glm::normalize(direction), glm::dvec3(b.up))));
  return glm::mix(b.bottom, b.top, glm::clamp(height, 0.0f, 1.0f));
}

} // namespace hrt
