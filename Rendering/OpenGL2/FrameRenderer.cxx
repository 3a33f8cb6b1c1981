// See FrameRenderer.h.
#include "Rendering/OpenGL2/FrameRenderer.h"

#include "Rendering/Core/Structures/EmbreeStructure.h"

#include "vtkOpenGLRenderWindow.h"

#include <chrono>
#include <exception>

namespace hrt
{
namespace gl
{

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
Caches FrameRenderer::currentCaches(const Snapshot& snapshot, const Settings& settings)
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
  const Facts facts = gatherFacts(snapshot);
  std::vector<bool> wanted = facts.lightCanCast;
  for (std::size_t i = 0; i < wanted.size(); ++i)
  {
    wanted[i] = wanted[i] && settings.shadows == ShadowMode::ShadowMaps && facts.anyCaster;
  }
  const std::vector<bool> present =
    this->Shadows.prepare(snapshot, wanted, settings.shadowMapResolution);
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
  const Caches caches = this->currentCaches(*snapshot, settings);
  FramePlan& plan = this->Statistics.plan;
  plan = planFrame(gatherFacts(*snapshot), settings, settingsChanges, changes, caches);

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
  this->LastSettings = settings;
  this->Valid = error.empty() ? cachesAfter(plan, settingsChanges, changes, caches) : Caches();
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
    case Stage::Visibility:
      return this->drawVisibility(snapshot);
    case Stage::PrimaryShading:
      return this->shadePrimary(snapshot);
    case Stage::ReadBack:
      this->ReadBack.begin(this->Hits);
      return {};
    case Stage::Structure:
      return this->updateStructure(snapshot);
    case Stage::SecondaryRays:
      return this->traceSecondaryRays(snapshot, settings);
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
std::string FrameRenderer::updateStructure(const Snapshot& snapshot)
{
  try
  {
    if (!this->Rays)
    {
      this->Rays = std::make_unique<EmbreeStructure>();
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
std::string FrameRenderer::traceSecondaryRays(const Snapshot& snapshot, const Settings& settings)
{
  std::vector<std::uint32_t> ids;
  if (!this->ReadBack.finish(ids))
  {
    return "the object intersection buffer could not be read back";
  }
  this->Statistics.bytesReadBack += this->ReadBack.bytes();

  TracerSettings tracing;
  tracing.maximumDepth = settings.maximumDepth;
  tracing.shadows = settings.shadows != ShadowMode::Off;
  tracing.reflections = settings.reflections;
  tracing.refractions = settings.refractions;
  SecondaryImage image;
  try
  {
    const SecondaryResult result =
      traceSecondary(snapshot, *this->Rays, tracing, ids.data(), image);
    this->Statistics.rays = result.rays;
    this->Statistics.secondaryPixels = result.pixels;
    this->Statistics.invalidIds = result.invalidIds;
  }
  catch (const std::exception& exception)
  {
    return std::string("the secondary rays could not be traced: ") + exception.what();
  }
  this->Secondary.allocate(image.width, image.height, GL_RGBA32F, GL_RGBA, GL_FLOAT);
  this->Secondary.upload(image.pixels.data());
  this->Statistics.bytesUploaded += image.pixels.size() * sizeof(image.pixels[0]);
  return {};
}

//------------------------------------------------------------------------------
bool FrameRenderer::readIds(std::vector<std::uint32_t>& ids)
{
  this->ReadBack.begin(this->Hits);
  this->Statistics.bytesReadBack += this->ReadBack.bytes();
  return this->ReadBack.finish(ids);
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
  const bool done =
    this->Caster.readShadow(this->Pool.window(), this->inputs(*this->Scene), light, share);
  this->Statistics.bytesReadBack += share.size() * sizeof(float);
  return done;
}

} // namespace gl
} // namespace hrt
