// See FrameRenderer.h.
#include "Rendering/OpenGL2/FrameRenderer.h"

#include "Rendering/OpenGL2/Animation.h"

#include "Rendering/Core/Structures/EmbreeStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"

#include "vtkOpenGLRenderWindow.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>

namespace hrt
{
namespace gl
{
namespace
{

// What overlaps best: the host builds the structure while the GPU rasterises, and shades on the GPU
// while the host traces - in a pipelined frame, the frame before.
std::vector<Stage> orderOf(const FramePlan& plan, const Settings& settings)
{
  std::vector<Stage> order = { Stage::GeometryUpload, Stage::ShadowMaps };
  if (settings.visibility == Visibility::RayCasting)
  {
    order.insert(order.end(), { Stage::Structure, Stage::Visibility });
  }
  else if (plan.pipelined.run && !settings.shadesOnCPU())
  {
    order.insert(order.end(), { Stage::Visibility, Stage::PrimaryShading, Stage::Structure });
  }
  else
  {
    order.insert(order.end(), { Stage::Visibility, Stage::Structure });
  }
  order.insert(order.end(), { Stage::ShadowReadBack, Stage::ReadBack });
  if (std::find(order.begin(), order.end(), Stage::PrimaryShading) == order.end())
  {
    order.push_back(Stage::PrimaryShading);
  }
  order.insert(order.end(), { Stage::SecondaryRays, Stage::Blit });
  return order;
}

std::unique_ptr<Structure> makeStructure(Accelerator accelerator)
{
  if (accelerator == Accelerator::KdTree)
  {
    return std::make_unique<KdTreeStructure>();
  }
  return std::make_unique<EmbreeStructure>();
}

} // namespace


//------------------------------------------------------------------------------
FrameRenderer::FrameRenderer(vtkOpenGLRenderWindow* window)
  : Pool(window)
  , Convention(DepthConvention::ofCurrentContext())
  , Hardware(isHardwareContext())
  , Geometry(Pool)
  , Tables(Pool)
  , Shadows(Pool, Convention)
  , Caster(Pool)
  , ReadBack(Pool)
  , ToWindow(Pool)
  , Pictures{ { { Pool, Convention }, { Pool, Convention } } }
{
}

//------------------------------------------------------------------------------
Caches FrameRenderer::currentCaches(
  const Snapshot& snapshot, const Facts& facts, const Settings& settings)
{
  const int width = snapshot.camera.width;
  const int height = snapshot.camera.height;
  Caches caches = this->Valid;
  caches.geometryUploaded = this->Geometry.holds(snapshot);
  if (this->picture().resize(width, height, settings.visibility))
  {
    caches.visibility = caches.primaryImage = caches.secondaryImage = false;
    caches.previousPicture = caches.tracing = false;
  }
  std::vector<bool> wanted = facts.lightCanCast;
  for (std::size_t i = 0; i < wanted.size(); ++i)
  {
    wanted[i] = wanted[i] && settings.usesShadowMaps() && facts.anyCaster;
  }
  const std::vector<bool> present =
    this->Shadows.prepare(snapshot, wanted, settings.shadowMapResolution);
  this->Statistics.shadowMapResolution = this->Shadows.resolution();
  caches.shadowMaps.resize(present.size(), false);
  for (std::size_t i = 0; i < present.size(); ++i)
  {
    caches.shadowMaps[i] = caches.shadowMaps[i] && present[i];
  }
  return caches;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::render(const std::shared_ptr<const Snapshot>& snapshot,
  const Changes& changes, const Settings& settings, const Circumstances& circumstances, int x,
  int y)
{
  this->Statistics = FrameStatistics();
  this->Scene = snapshot;
  const SettingsChanges settingsChanges = compareSettings(this->LastSettings, settings);
  Facts facts = gatherFacts(*snapshot, settings.tracedBounds);
  facts.circumstances = circumstances;
  const Caches caches = this->currentCaches(*snapshot, facts, settings);
  FramePlan& plan = this->Statistics.plan;
  plan = planFrame(facts, settings, settingsChanges, changes, caches);
  if (!plan.keepsTracing)
  {
    this->Tracer.reset();
  }
  const std::size_t shown = this->Current;
  if (plan.pipelined.run)
  {
    this->Current = 1 - this->Current;
    this->picture().resize(snapshot->camera.width, snapshot->camera.height, settings.visibility);
  }
  this->picture().useSecondary = plan.useSecondaryImage;

  std::string error;
  for (const Stage stage : orderOf(plan, settings))
  {
    if (!plan[stage].run || !error.empty())
    {
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    error = stage == Stage::Blit ? this->show(shown, settings.bounds, x, y)
                                 : this->runStage(stage, settings);
    this->Statistics.milliseconds[static_cast<std::size_t>(stage)] =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  if (!plan.pipelined.run || !error.empty())
  {
    this->Tracer.reset();
  }
  this->LastSettings = settings;
  this->Valid =
    error.empty() ? cachesAfter(plan, settings, settingsChanges, changes, caches) : Caches();
  return error;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::runStage(Stage stage, const Settings& settings)
{
  const Snapshot& snapshot = *this->Scene;
  const bool pipelined = this->Statistics.plan.pipelined.run;
  switch (stage)
  {
    case Stage::GeometryUpload:
      return this->uploadGeometry(snapshot);
    case Stage::ShadowMaps:
      return this->drawShadowMaps(snapshot);
    case Stage::Visibility:
      return settings.visibility == Visibility::RayCasting
        ? this->castPrimary(snapshot, settings)
        : this->drawVisibility(snapshot, settings);
    case Stage::Structure:
      return this->updateStructure(snapshot, settings);
    case Stage::ShadowReadBack:
      return this->Shadows.readBack(this->Pool.window(), this->Statistics.bytesReadBack)
        ? std::string()
        : "the shadow maps could not be read back";
    case Stage::ReadBack:
      return this->readBackAndTrace(settings);
    case Stage::PrimaryShading:
      return !settings.shadesOnCPU() ? this->shadePrimary(snapshot, settings)
        : pipelined                  ? std::string() // goes on when the frame is over
                                     : this->trace(settings);
    case Stage::SecondaryRays:
      return pipelined ? std::string() : this->trace(settings);
    case Stage::Blit:
    case Stage::Count:
      break;
  }
  return {};
}

//------------------------------------------------------------------------------
std::string FrameRenderer::show(std::size_t picture, const PixelBounds& bounds, int x, int y)
{
  return this->ToWindow.draw(this->Pool.window(), this->Pictures[picture], bounds, x, y)
    ? std::string()
    : "the blit's shader is not usable";
}

//------------------------------------------------------------------------------
std::string FrameRenderer::uploadGeometry(const Snapshot& snapshot)
{
  std::string error;
  this->Geometry.update(snapshot, error);
  this->Statistics.bytesUploaded += this->Geometry.uploadedBytes();
  return error;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::drawShadowMaps(const Snapshot& snapshot)
{
  std::vector<bool> draw;
  for (const StageDecision& decision : this->Statistics.plan.shadowMaps)
  {
    draw.push_back(decision.run);
  }
  if (!this->Shadows.draw(this->Pool.window(), snapshot, this->Geometry, draw))
  {
    return "the shadow maps could not be drawn";
  }
  this->Statistics.trianglesDrawn += this->Shadows.trianglesDrawn();
  return {};
}

//------------------------------------------------------------------------------
std::string FrameRenderer::drawVisibility(const Snapshot& snapshot, const Settings& settings)
{
  ObjectIntersectionBuffer& hits = this->picture().hits;
  if (!hits.draw(this->Pool.window(), snapshot, this->Geometry, this->Statistics.plan.rasterised,
        settings.tracedBounds))
  {
    return "the object intersection buffer could not be drawn";
  }
  this->Statistics.trianglesDrawn += hits.trianglesDrawn();
  return {};
}

//------------------------------------------------------------------------------
RayCaster::Inputs FrameRenderer::inputs(const Snapshot& snapshot, const Settings& settings)
{
  return { snapshot, this->Geometry, this->Tables, this->Shadows, this->picture().hits,
    settings.tracedBounds };
}

//------------------------------------------------------------------------------
std::string FrameRenderer::shadePrimary(const Snapshot& snapshot, const Settings& settings)
{
  this->Shadows.updateTable(snapshot);
  this->Tables.update(snapshot, this->Shadows.slots());
  return this->Caster.draw(
           this->Pool.window(), this->inputs(snapshot, settings), this->picture().primary)
    ? std::string()
    : "the ray caster could not be drawn";
}

//------------------------------------------------------------------------------
std::string FrameRenderer::updateStructure(const Snapshot& snapshot, const Settings& settings)
{
  const std::string error = this->finishFrameBefore(); // its rays go through the present structure
  if (!error.empty())
  {
    return error;
  }
  try
  {
    if (!this->Rays || this->RaysKind != settings.accelerator)
    {
      this->Rays = makeStructure(settings.accelerator);
      this->RaysKind = settings.accelerator;
    }
    this->Statistics.structure = this->Rays->update(snapshot);
  }
  catch (const std::exception& exception)
  {
    this->Rays.reset();
    return std::string("the ray structure could not be built: ") + exception.what();
  }
  return {};
}

//------------------------------------------------------------------------------
bool FrameRenderer::readIds(
  const PixelBounds& bounds, const std::function<void(int)>& rowsReady)
{
  const bool done = this->ReadBack.read(
    this->Pool.window(), this->picture().hits, bounds, this->Host.ids, rowsReady);
  this->Statistics.bytesReadBack += bounds.pixels() * sizeof(this->Host.ids[0]);
  return done;
}

//------------------------------------------------------------------------------
TracerSettings FrameRenderer::tracerSettings(const Settings& settings) const
{
  TracerSettings tracing;
  tracing.maximumDepth = settings.maximumDepth;
  tracing.shadows = settings.shadows != ShadowMode::Off;
  if (settings.shadesOnCPU() && settings.usesShadowMaps())
  {
    tracing.shadowMaps = this->Shadows.hostTables(*this->Scene);
  }
  // Shadow maps know nothing of translucent casters; a mirror must not show what is not there.
  tracing.tintedShadows = settings.usesShadowRays();
  tracing.reflections = settings.reflections;
  tracing.refractions = settings.refractions;
  tracing.multisampling = settings.usedMultisampling();
  tracing.interleave = settings.interleave;
  tracing.interleaveErrorControl = settings.interleaveErrorControl;
  tracing.bounds = settings.tracedBounds;
  return tracing;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::castPrimary(const Snapshot& snapshot, const Settings& settings)
{
  try
  {
    this->Statistics.rays +=
      castPrimaryRays(snapshot, *this->Rays, tracerSettings(settings), this->Host);
  }
  catch (const std::exception& exception)
  {
    return std::string("the primary rays could not be traced: ") + exception.what();
  }
  this->picture().hits.upload(this->Host, settings.tracedBounds);
  this->Statistics.bytesUploaded +=
    settings.tracedBounds.pixels() * (sizeof(this->Host.ids[0]) + sizeof(float));
  return {};
}

//------------------------------------------------------------------------------
void FrameRenderer::beginTracing(const Settings& settings)
{
  if (!this->Rays) // neither shadows nor mirrors: an empty structure will not be asked
  {
    this->Rays = makeStructure(settings.accelerator);
    this->RaysKind = settings.accelerator;
  }
  this->TracedScene = this->Scene;
  this->TracedPicture = this->Current;
  this->TracesEverything = settings.shadesOnCPU();
  this->Tracing = this->tracerSettings(settings);
  const Camera& camera = this->TracedScene->camera;
  // The ids are written in place when tracing has begun.
  this->Host.ids.resize(static_cast<std::size_t>(camera.width) * camera.height);
  this->Tracer = std::make_unique<ImageTracer>(*this->TracedScene, *this->Rays, this->Tracing,
    this->TracesEverything ? Wanted::Everything : Wanted::SecondaryOnly, this->Host.ids.data(),
    this->Traced);
}

//------------------------------------------------------------------------------
std::string FrameRenderer::readBackAndTrace(const Settings& settings)
{
  const std::string error = this->finishFrameBefore(); // it reads the ids that are overwritten
  if (!error.empty())
  {
    return error;
  }
  try
  {
    this->beginTracing(settings);
    return this->readIds(settings.tracedBounds, [this](int rows) { this->Tracer->idsReady(rows); })
      ? std::string()
      : "the object intersection buffer could not be read back";
  }
  catch (const std::exception& exception)
  {
    return std::string("the rays could not be traced: ") + exception.what();
  }
}

//------------------------------------------------------------------------------
std::string FrameRenderer::trace(const Settings& settings)
{
  try
  {
    if (!this->Tracer) // the ids were on the host already
    {
      this->beginTracing(settings);
    }
  }
  catch (const std::exception& exception)
  {
    return std::string("the rays could not be traced: ") + exception.what();
  }
  return this->finishTracing();
}

//------------------------------------------------------------------------------
std::string FrameRenderer::finishTracing()
{
  try
  {
    const SecondaryResult result = this->Tracer->finish();
    this->Tracer.reset();
    this->Statistics.rays += result.rays;
    this->Statistics.multisampling = result.multisampling;
    this->Statistics.interleave = result.interleave;
    this->Statistics.secondaryPixels = result.pixels;
    this->Statistics.invalidIds = result.invalidIds;
  }
  catch (const std::exception& exception)
  {
    this->Tracer.reset();
    return std::string("the rays could not be traced: ") + exception.what();
  }
  Picture& picture = this->Pictures[this->TracedPicture];
  Image2D& target = this->TracesEverything ? picture.primary : picture.secondary;
  target.allocate(this->Traced.width, this->Traced.height, GL_RGBA32F, GL_RGBA, GL_FLOAT);
  const PixelBounds& bounds = this->Tracing.bounds;
  target.upload(this->Traced.pixels.data(), bounds);
  this->Statistics.bytesUploaded += bounds.pixels() * sizeof(this->Traced.pixels[0]);
  return {};
}

//------------------------------------------------------------------------------
std::string FrameRenderer::finishFrameBefore()
{
  return this->Tracer && this->TracedPicture != this->Current ? this->finishTracing()
                                                             : std::string();
}

//------------------------------------------------------------------------------
const std::vector<std::uint32_t>& FrameRenderer::ids()
{
  if (!this->Valid.hostIds)
  {
    this->Valid.hostIds = this->readIds(this->LastSettings.tracedBounds, [](int) {});
  }
  if (!this->Valid.hostIds)
  {
    this->Host.ids.clear();
  }
  return this->Host.ids;
}

//------------------------------------------------------------------------------
bool FrameRenderer::readBarycentrics(std::vector<glm::dvec2>& barycentrics)
{
  const PixelBounds& bounds = this->LastSettings.tracedBounds;
  if (!HitReadBack::readBarycentrics(
        this->Pool.window(), this->picture().hits, bounds, barycentrics))
  {
    return false;
  }
  this->Statistics.bytesReadBack += bounds.pixels() * sizeof(glm::uvec4);
  return true;
}

//------------------------------------------------------------------------------
bool FrameRenderer::readShadow(int light, std::vector<float>& share)
{
  if (this->LastSettings.shadesOnCPU())
  {
    return this->castShadows(light, share);
  }
  const bool done = this->Caster.readShadow(
    this->Pool.window(), this->inputs(*this->Scene, this->LastSettings), light, share);
  this->Statistics.bytesReadBack += this->LastSettings.tracedBounds.pixels() * sizeof(float);
  return done;
}

//------------------------------------------------------------------------------
bool FrameRenderer::castShadows(int light, std::vector<float>& share)
{
  const TracerSettings settings = this->tracerSettings(this->LastSettings);
  const std::vector<std::uint32_t>& ids = this->ids();
  if (ids.empty() || !this->Rays)
  {
    return false;
  }
  if (!settings.shadows)
  {
    share.clear();
    for (const std::uint32_t id : ids)
    {
      share.push_back(id ? 1.0f : std::numeric_limits<float>::quiet_NaN());
    }
    return true;
  }
  try
  {
    share = castShadowRays(
      *this->Scene, *this->Rays, settings, ids.data(), static_cast<std::size_t>(light));
  }
  catch (const std::exception&)
  {
    return false;
  }
  return true;
}

} // namespace gl
} // namespace hrt
