// See FrameRenderer.h.
#include "Rendering/OpenGL2/FrameRenderer.h"

#include "Rendering/Core/Structures/EmbreeStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"

#include "vtkOpenGLRenderWindow.h"

#include <chrono>
#include <exception>
#include <limits>

namespace hrt
{
namespace gl
{
namespace
{

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
  , Geometry(Pool)
  , Tables(Pool)
  , Shadows(Pool, Convention)
  , Hits(Pool, Convention)
  , Caster(Pool)
  , ReadBack(Pool)
  , Secondary(Pool)
  , ToWindow(Pool)
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
  if (this->Hits.resize(width, height, settings.visibility))
  {
    caches.visibility = false;
  }
  if (this->Caster.resize(width, height))
  {
    caches.primaryImage = false;
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
  const Changes& changes, const Settings& settings, int x, int y)
{
  this->Statistics = FrameStatistics();
  this->Scene = snapshot;
  const SettingsChanges settingsChanges = compareSettings(this->LastSettings, settings);
  const Facts facts = gatherFacts(*snapshot);
  const Caches caches = this->currentCaches(*snapshot, facts, settings);
  FramePlan& plan = this->Statistics.plan;
  plan = planFrame(facts, settings, settingsChanges, changes, caches);

  std::string error;
  for (std::size_t i = 0; i < kStageCount && error.empty(); ++i)
  {
    const auto stage = static_cast<Stage>(i);
    if (!plan[stage].run || stage == Stage::Blit)
    {
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    error = this->runStage(stage, *snapshot, settings);
    this->Statistics.milliseconds[i] =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  if (error.empty() && plan[Stage::Blit].run)
  {
    const auto start = std::chrono::steady_clock::now();
    const Image2D* secondary = plan.useSecondaryImage ? &this->Secondary : nullptr;
    if (!this->ToWindow.draw(
          this->Pool.window(), this->Caster.image(), secondary, this->Hits, x, y))
    {
      error = "the blit's shader is not usable";
    }
    this->Statistics.milliseconds[static_cast<std::size_t>(Stage::Blit)] =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  this->Tracer.reset(); // when a stage between failed
  this->LastSettings = settings;
  this->Valid = error.empty() ? cachesAfter(plan, settings, settingsChanges, changes, caches) : Caches();
  return error;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::runStage(
  Stage stage, const Snapshot& snapshot, const Settings& settings)
{
  switch (stage)
  {
    case Stage::GeometryUpload:
      return this->uploadGeometry(snapshot);
    case Stage::ShadowMaps:
      return this->drawShadowMaps(snapshot);
    case Stage::Structure:
      return this->updateStructure(snapshot, settings);
    case Stage::Visibility:
      return settings.visibility == Visibility::RayCasting ? this->castPrimary(snapshot)
                                                           : this->drawVisibility(snapshot);
    case Stage::ShadowReadBack:
      return this->Shadows.readBack(this->Pool.window(), this->Statistics.bytesReadBack)
        ? std::string()
        : "the shadow maps could not be read back";
    case Stage::ReadBack:
      return this->readBackAndTrace(snapshot, settings);
    case Stage::PrimaryShading:
      return settings.shadesOnCPU()
        ? this->finishTracing(snapshot, settings, this->Caster.image())
        : this->shadePrimary(snapshot);
    case Stage::SecondaryRays:
      return this->finishTracing(snapshot, settings, this->Secondary);
    case Stage::Blit:
    case Stage::Count:
      break;
  }
  return {};
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
std::string FrameRenderer::drawVisibility(const Snapshot& snapshot)
{
  if (!this->Hits.draw(this->Pool.window(), snapshot, this->Geometry))
  {
    return "the object intersection buffer could not be drawn";
  }
  this->Statistics.trianglesDrawn += this->Hits.trianglesDrawn();
  return {};
}

//------------------------------------------------------------------------------
RayCaster::Inputs FrameRenderer::inputs(const Snapshot& snapshot) const
{
  return { snapshot, this->Geometry, this->Tables, this->Shadows, this->Hits };
}

//------------------------------------------------------------------------------
std::string FrameRenderer::shadePrimary(const Snapshot& snapshot)
{
  this->Shadows.updateTable(snapshot);
  this->Tables.update(snapshot, this->Shadows.slots());
  return this->Caster.draw(this->Pool.window(), this->inputs(snapshot))
    ? std::string()
    : "the ray caster could not be drawn";
}

//------------------------------------------------------------------------------
std::string FrameRenderer::updateStructure(const Snapshot& snapshot, const Settings& settings)
{
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
bool FrameRenderer::readIds(const std::function<void(int)>& rowsReady)
{
  const bool done =
    this->ReadBack.read(this->Pool.window(), this->Hits, this->Host.ids, rowsReady);
  this->Statistics.bytesReadBack += this->Host.ids.size() * sizeof(this->Host.ids[0]);
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
  return tracing;
}

//------------------------------------------------------------------------------
std::string FrameRenderer::castPrimary(const Snapshot& snapshot)
{
  try
  {
    this->Statistics.rays += castPrimaryRays(snapshot, *this->Rays, this->Host);
  }
  catch (const std::exception& exception)
  {
    return std::string("the primary rays could not be traced: ") + exception.what();
  }
  this->Hits.upload(this->Host);
  this->Statistics.bytesUploaded +=
    this->Host.ids.size() * (sizeof(this->Host.ids[0]) + sizeof(float));
  return {};
}

//------------------------------------------------------------------------------
void FrameRenderer::beginTracing(const Snapshot& snapshot, const Settings& settings)
{
  if (!this->Rays) // neither shadows nor mirrors: an empty structure will not be asked
  {
    this->Rays = makeStructure(settings.accelerator);
    this->RaysKind = settings.accelerator;
  }
  // The ids are written in place while tracing has begun.
  this->Host.ids.resize(
    static_cast<std::size_t>(snapshot.camera.width) * snapshot.camera.height);
  this->Tracing = this->tracerSettings(settings);
  this->Tracer = std::make_unique<ImageTracer>(snapshot, *this->Rays, this->Tracing,
    settings.shadesOnCPU() ? Wanted::Everything : Wanted::SecondaryOnly, this->Host.ids.data(),
    this->Traced);
}

//------------------------------------------------------------------------------
std::string FrameRenderer::readBackAndTrace(const Snapshot& snapshot, const Settings& settings)
{
  try
  {
    this->beginTracing(snapshot, settings);
    if (this->readIds([this](int rows) { this->Tracer->idsReady(rows); }))
    {
      return {};
    }
  }
  catch (const std::exception& exception)
  {
    this->Tracer.reset();
    return std::string("the rays could not be traced: ") + exception.what();
  }
  this->Tracer.reset();
  return "the object intersection buffer could not be read back";
}

//------------------------------------------------------------------------------
std::string FrameRenderer::finishTracing(
  const Snapshot& snapshot, const Settings& settings, Image2D& target)
{
  try
  {
    if (!this->Tracer) // the ids were on the host already
    {
      this->beginTracing(snapshot, settings);
    }
    const SecondaryResult result = this->Tracer->finish();
    this->Tracer.reset();
    this->Statistics.rays += result.rays;
    this->Statistics.secondaryPixels = result.pixels;
    this->Statistics.invalidIds = result.invalidIds;
    target.allocate(this->Traced.width, this->Traced.height, GL_RGBA32F, GL_RGBA, GL_FLOAT);
    target.upload(this->Traced.pixels.data());
    this->Statistics.bytesUploaded += this->Traced.pixels.size() * sizeof(this->Traced.pixels[0]);
  }
  catch (const std::exception& exception)
  {
    this->Tracer.reset();
    return std::string("the rays could not be traced: ") + exception.what();
  }
  return {};
}

//------------------------------------------------------------------------------
const std::vector<std::uint32_t>& FrameRenderer::ids()
{
  if (!this->Valid.hostIds)
  {
    this->Valid.hostIds = this->readIds([](int) {});
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
  if (!HitReadBack::readBarycentrics(this->Hits, barycentrics))
  {
    return false;
  }
  this->Statistics.bytesReadBack += barycentrics.size() * sizeof(glm::uvec4);
  return true;
}

//------------------------------------------------------------------------------
bool FrameRenderer::readShadow(int light, std::vector<float>& share)
{
  if (this->LastSettings.shadesOnCPU())
  {
    return this->castShadows(light, share);
  }
  const bool done =
    this->Caster.readShadow(this->Pool.window(), this->inputs(*this->Scene), light, share);
  this->Statistics.bytesReadBack += share.size() * sizeof(float);
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
