// See FrameRenderer.h.
#include "Rendering/OpenGL2/FrameRenderer.h"

#include "Rendering/OpenGL2/Animation.h"

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

// Does a piece of work; what it threw becomes the end of a sentence, for no exception may cross
// VTK.
template <class Work>
std::string attempt(const char* failure, const Work& work)
{
  try
  {
    work();
  }
  catch (const std::exception& exception)
  {
    return std::string(failure) + ": " + exception.what();
  }
  return {};
}

const char* const kNotTraced = "the rays could not be traced";

} // namespace

//------------------------------------------------------------------------------
FrameRenderer::FrameRenderer(vtkOpenGLRenderWindow* window)
  : Pool(window)
  , Convention(DepthConvention::ofCurrentContext())
  , Hardware(isHardwareContext())
  , OnGPU(Pool, Convention)
  , ReadBack(Pool)
  , ToWindow(Pool)
  , Pictures{ { { Pool, Convention }, { Pool, Convention } } }
{
}

//------------------------------------------------------------------------------
Caches FrameRenderer::currentCaches(
  const Snapshot& snapshot, const Facts& facts, const Settings& settings)
{
  Caches caches = this->Valid;
  if (this->picture().resize(snapshot.camera.width, snapshot.camera.height, settings.visibility))
  {
    caches.visibility = caches.primaryImage = caches.secondaryImage = false;
    caches.previousPicture = caches.tracing = false;
  }
  this->OnGPU.prepare(snapshot, facts, settings, this->Statistics, caches);
  return caches;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::render(const std::shared_ptr<const Snapshot>& snapshot,
  const Changes& changes, const Settings& settings, const FrameConditions& conditions, int x,
  int y)
{
  this->Statistics = FrameStatistics();
  this->Scene = snapshot;
  const SettingsChanges settingsChanges = compareSettings(this->LastSettings, settings);
  Facts facts = gatherFacts(*snapshot, settings.tracedBounds);
  facts.conditions = conditions;
  this->OthersDraw = conditions.othersDraw;
  const Caches caches = this->currentCaches(*snapshot, facts, settings);
  FramePlan& plan = this->Statistics.plan;
  plan = planFrame(facts, settings, settingsChanges, changes, caches);
  if (!plan.keepsTracing)
  {
    this->Background.abandon();
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
    this->Background.abandon();
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
      return this->OnGPU.uploadGeometry(snapshot, this->Statistics);
    case Stage::ShadowMaps:
      return this->OnGPU.drawShadowMaps(snapshot, this->Statistics);
    case Stage::Visibility:
      this->picture().margin = DepthMargin::of(snapshot);
      return settings.visibility == Visibility::RayCasting
        ? this->castPrimary(snapshot, settings)
        : this->drawVisibility(snapshot, settings);
    case Stage::Structure:
      return this->updateStructure(snapshot, settings);
    case Stage::ShadowReadBack:
      return this->OnGPU.readBackShadowMaps(this->Statistics);
    case Stage::ReadBack:
      return this->readBackAndTrace(settings);
    case Stage::PrimaryShading:
      return !settings.shadesOnCPU()
        ? this->OnGPU.shade(
            snapshot, settings.tracedBounds, this->picture(), this->Statistics)
        : pipelined ? std::string() // goes on when the frame is over
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
  return this->ToWindow.draw(
           this->Pool.window(), this->Pictures[picture], bounds, this->OthersDraw, x, y)
    ? std::string()
    : "the blit's shader is not usable";
}

//------------------------------------------------------------------------------
std::string FrameRenderer::drawVisibility(const Snapshot& snapshot, const Settings& settings)
{
  const std::string error = this->OnGPU.prepareDrawing(snapshot, this->Statistics);
  if (!error.empty())
  {
    return error;
  }
  ObjectIntersectionBuffer& hits = this->picture().hits;
  if (!hits.draw(this->Pool.window(), snapshot, this->OnGPU.tables(),
        this->Statistics.plan.rasterised, settings.tracedBounds))
  {
    return "the object intersection buffer could not be drawn";
  }
  this->Statistics.trianglesDrawn += hits.trianglesDrawn();
  return {};
}

//------------------------------------------------------------------------------
std::string FrameRenderer::updateStructure(const Snapshot& snapshot, const Settings& settings)
{
  const std::string error = this->finishFrameBefore(); // its rays go through the present structure
  if (!error.empty())
  {
    return error;
  }
  return attempt("the ray structure could not be built",
    [&] { this->Statistics.structure = this->Rays.update(snapshot, settings.accelerator); });
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
    tracing.shadowMaps = this->OnGPU.shadowMaps().hostTables(*this->Scene);
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
  const std::string error = attempt("the primary rays could not be traced", [&] {
    this->Statistics.rays +=
      castPrimaryRays(snapshot, *this->Rays.get(), this->tracerSettings(settings), this->Host);
  });
  if (!error.empty())
  {
    return error;
  }
  this->picture().hits.upload(this->Host, settings.tracedBounds);
  this->Statistics.bytesUploaded +=
    settings.tracedBounds.pixels() * (sizeof(this->Host.ids[0]) + sizeof(float));
  return {};
}

//------------------------------------------------------------------------------
void FrameRenderer::beginTracing(const Settings& settings)
{
  const Camera& camera = this->Scene->camera;
  // The ids are written in place when tracing has begun.
  this->Host.ids.resize(static_cast<std::size_t>(camera.width) * camera.height);
  // Where neither shadows nor mirrors are, an empty structure will not be asked.
  this->Background.begin(this->Scene, this->Rays.getOrEmpty(settings.accelerator),
    this->tracerSettings(settings),
    settings.shadesOnCPU() ? Wanted::Everything : Wanted::SecondaryOnly, this->Host.ids.data(),
    this->picture());
}

//------------------------------------------------------------------------------
std::string FrameRenderer::readBackAndTrace(const Settings& settings)
{
  std::string error = this->finishFrameBefore(); // it reads the ids that are overwritten
  if (!error.empty())
  {
    return error;
  }
  bool arrived = false;
  error = attempt(kNotTraced, [&] {
    this->beginTracing(settings);
    arrived = this->readIds(
      settings.tracedBounds, [this](int rows) { this->Background.idsReady(rows); });
  });
  return !error.empty() || arrived ? error
                                   : "the object intersection buffer could not be read back";
}

//------------------------------------------------------------------------------
std::string FrameRenderer::trace(const Settings& settings)
{
  const std::string error = attempt(kNotTraced, [&] {
    if (!this->Background.underWay()) // the ids were on the host already
    {
      this->beginTracing(settings);
    }
  });
  return error.empty() ? this->finishTracing() : error;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::finishTracing()
{
  const std::string error = attempt(kNotTraced, [this] {
    const SecondaryResult result = this->Background.finish();
    this->Statistics.rays += result.rays;
    this->Statistics.multisampling = result.multisampling;
    this->Statistics.interleave = result.interleave;
    this->Statistics.secondaryPixels = result.pixels;
    this->Statistics.invalidIds = result.invalidIds;
  });
  if (error.empty())
  {
    this->Statistics.bytesUploaded += this->Background.upload();
  }
  return error;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::finishFrameBefore()
{
  return this->Background.underWay() && !this->Background.fills(this->picture())
    ? this->finishTracing()
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
  const PixelBounds& bounds = this->LastSettings.tracedBounds;
  const bool done = this->OnGPU.readShadow(*this->Scene, bounds, this->picture(), light, share);
  this->Statistics.bytesReadBack += bounds.pixels() * sizeof(float);
  return done;
}

//------------------------------------------------------------------------------
bool FrameRenderer::castShadows(int light, std::vector<float>& share)
{
  const TracerSettings settings = this->tracerSettings(this->LastSettings);
  const std::vector<std::uint32_t>& ids = this->ids();
  if (ids.empty() || !this->Rays.get())
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
  return attempt(kNotTraced, [&] {
    share = castShadowRays(
      *this->Scene, *this->Rays.get(), settings, ids.data(), static_cast<std::size_t>(light));
  }).empty();
}

} // namespace gl
} // namespace hrt
