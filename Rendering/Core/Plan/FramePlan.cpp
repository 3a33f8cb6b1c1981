// The rules of the frame plan, one function a stage, in the order in which the stages run.
#include "Rendering/Core/Plan/FramePlan.h"

#include "Rendering/Core/Plan/Decision.h"
#include "Rendering/Core/Plan/Dependencies.h"
#include "Rendering/Core/Plan/Pipelining.h"

#include <algorithm>

namespace hrt
{

namespace
{

// Of what is not there: it is being traced.
const char* const kUnderWay = "the rays under way are finished";

StageDecision decide(Cause outdated, bool cached, const char* missing, const char* upToDate)
{
  return outdated ? run(outdated) : cached ? skip(upToDate) : run(missing);
}

StageDecision planUpload(const Facts& facts, const Settings& settings,
  const Dependencies& dependencies, const Caches& caches)
{
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view");
  }
  if (!settings.rasterises() && settings.shadesOnCPU())
  {
    return skip("all is done on the CPU");
  }
  return decide(dependencies.triangles(), caches.geometryUploaded,
    "the GPU does not hold the geometry", "the GPU holds the geometry");
}

StageDecision planShadowMap(std::size_t light, const Facts& facts, const Settings& settings,
  const Dependencies& dependencies, const Caches& caches)
{
  if (settings.shadows == ShadowMode::Off)
  {
    return skip("shadows are off");
  }
  if (settings.usesShadowRays())
  {
    return skip("the CPU shades with shadow rays");
  }
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view");
  }
  if (!facts.anyCaster)
  {
    return skip("nothing casts shadows");
  }
  if (!facts.lightCanCast.at(light))
  {
    return skip("the light casts no shadow that is seen");
  }
  const bool cached = light < caches.shadowMaps.size() && caches.shadowMaps[light];
  return decide(dependencies.shadowMap(light), cached, "the light has no map yet",
    "neither the light nor a caster moved");
}

// The stage of all maps runs when one map does.
StageDecision summarizeShadowMaps(const std::vector<StageDecision>& maps)
{
  for (const StageDecision& map : maps)
  {
    if (map.run)
    {
      return map;
    }
  }
  return maps.empty() ? skip("the scene has no lights") : maps.front();
}

StageDecision planVisibility(
  const Facts& facts, const Dependencies& dependencies, const Caches& caches)
{
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view");
  }
  return decide(dependencies.visibility(), caches.visibility, "no object intersection buffer yet",
    "nothing changed what is visible");
}

StageDecision planPrimaryShading(const Facts& facts, const Settings& settings,
  const FramePlan& plan, const Dependencies& dependencies, const Caches& caches)
{
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view");
  }
  if (plan[Stage::Visibility].run)
  {
    return run("visibility is new");
  }
  if (plan[Stage::ShadowMaps].run)
  {
    return run("a shadow map is new");
  }
  // The tracer's picture holds its mirrors and glass.
  const bool whole = settings.shadesOnCPU();
  return decide(whole ? dependencies.secondaryImage() : dependencies.primaryImage(),
    caches.primaryImage, whole && caches.tracing ? kUnderWay : "no primary image yet",
    "the primary image is valid");
}

// Whether the settings let secondary rays run for what is in view; else why not.
StageDecision needsSecondaryRays(const Facts& facts, const Settings& settings)
{
  if (!facts.mirrorInView && !facts.glassInView)
  {
    return skip("no mirror or glass is in view");
  }
  if (settings.maximumDepth <= 0)
  {
    return skip("the maximum depth is 0");
  }
  if (facts.mirrorInView && settings.reflections)
  {
    return run("a mirror is in view");
  }
  if (facts.glassInView && settings.refractions)
  {
    return run("glass is in view");
  }
  return skip("reflections or refractions are off");
}

StageDecision planSecondary(const StageDecision& needed, const Settings& settings,
  const FramePlan& plan, const Dependencies& dependencies, const Caches& caches)
{
  if (!needed.run)
  {
    return needed;
  }
  if (settings.shadesOnCPU())
  {
    return skip("traced with the primary image");
  }
  // New visibility always renews the rays: the pixels of mirrors and glass are others.
  const StageDecision& visibility = plan[Stage::Visibility];
  return decide(visibility.run ? visibility.reason : dependencies.secondaryImage(),
    caches.secondaryImage, caches.tracing ? kUnderWay : "no secondary image yet",
    "the secondary image is valid");
}

StageDecision planShadowReadBack(
  const Settings& settings, const FramePlan& plan, const Caches& caches)
{
  if (!settings.shadesOnCPU())
  {
    return skip("the GPU shades");
  }
  if (!settings.usesShadowMaps() || plan.shadowMaps.empty())
  {
    return skip(plan[Stage::ShadowMaps].reason);
  }
  if (!plan[Stage::PrimaryShading].run)
  {
    return skip(plan[Stage::PrimaryShading].reason);
  }
  return decide(plan[Stage::ShadowMaps].run ? "a shadow map is new" : nullptr,
    caches.hostShadowMaps, "the CPU shades with the maps", "the maps are on the host");
}

StageDecision planReadBack(
  const Settings& settings, const FramePlan& plan, const Caches& caches)
{
  const bool shadesOnCPU = settings.shadesOnCPU() && plan[Stage::PrimaryShading].run;
  if (!shadesOnCPU && !plan[Stage::SecondaryRays].run)
  {
    return skip(settings.shadesOnCPU()
        ? plan[Stage::PrimaryShading].reason
        : plan[Stage::SecondaryRays].reason);
  }
  if (!settings.rasterises())
  {
    return skip("primary rays leave their ids on the host");
  }
  if (!plan[Stage::Visibility].run && caches.hostIds)
  {
    return skip("the ids are on the host");
  }
  return run("rays start at the visible triangles");
}

// Whether some stage of this frame shoots rays; else why not.
StageDecision needsStructure(
  const StageDecision& secondary, const Settings& settings, const FramePlan& plan)
{
  if (!settings.rasterises() && plan[Stage::Visibility].run)
  {
    return run("primary rays");
  }
  if (settings.shadesOnCPU() && plan[Stage::PrimaryShading].run)
  {
    return settings.usesShadowRays() ? run("shadow rays") : secondary;
  }
  return plan[Stage::SecondaryRays];
}

StageDecision planStructure(
  const StageDecision& needed, const Dependencies& dependencies, const Caches& caches)
{
  if (!needed.run)
  {
    return needed;
  }
  return decide(dependencies.structure(), caches.structure, "no ray structure yet",
    "the ray structure is valid");
}

StageDecision planBlit(const Facts& facts, const FramePlan& plan)
{
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view"); // what is cached shows another view
  }
  const bool anyStage = std::any_of(plan.stages.begin(), plan.stages.end(),
    [](const StageDecision& stage) { return stage.run; });
  return run(anyStage ? "the image is new" : "nothing changed since the last frame");
}

FramePlan planStages(const Facts& facts, const Settings& settings, const Dependencies& dependencies,
  const Caches& caches)
{
  const StageDecision secondary = needsSecondaryRays(facts, settings);
  FramePlan plan;
  plan.features = facts.features;
  plan[Stage::GeometryUpload] = planUpload(facts, settings, dependencies, caches);
  for (std::size_t light = 0; light < facts.lightCanCast.size(); ++light)
  {
    plan.shadowMaps.push_back(planShadowMap(light, facts, settings, dependencies, caches));
  }
  plan[Stage::ShadowMaps] = summarizeShadowMaps(plan.shadowMaps);
  plan[Stage::Visibility] = planVisibility(facts, dependencies, caches);
  if (plan[Stage::Visibility].run && settings.rasterises())
  {
    plan.rasterised = facts.partInView;
  }
  plan[Stage::PrimaryShading] = planPrimaryShading(facts, settings, plan, dependencies, caches);
  plan[Stage::SecondaryRays] = planSecondary(secondary, settings, plan, dependencies, caches);
  plan[Stage::ShadowReadBack] = planShadowReadBack(settings, plan, caches);
  plan[Stage::ReadBack] = planReadBack(settings, plan, caches);
  plan[Stage::Structure] =
    planStructure(needsStructure(secondary, settings, plan), dependencies, caches);
  plan[Stage::Blit] = planBlit(facts, plan);
  plan.useSecondaryImage = secondary.run && !settings.shadesOnCPU();
  return plan;
}

} // namespace

FramePlan planFrame(const Facts& facts, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& caches)
{
  const Dependencies dependencies(changes, settingsChanges);
  FramePlan plan = planStages(facts, settings, dependencies, caches);
  const StageDecision pipelined =
    planPipelining(facts, settings, plan, changes, settingsChanges, dependencies, caches);
  if (pipelined.run)
  {
    // The frame before keeps its buffers until it is shown; this one fills others.
    Caches others = caches;
    others.visibility = others.hostIds = others.tracing = false;
    others.primaryImage = others.secondaryImage = false;
    plan = planStages(facts, settings, dependencies, others);
  }
  plan.pipelined = pipelined;
  plan.keepsTracing = caches.tracing &&
    (pipelined.run || (!plan[Stage::Visibility].run && !dependencies.secondaryImage()));
  return plan;
}

} // namespace hrt
