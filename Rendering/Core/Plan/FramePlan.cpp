// The rules of the frame plan, one function a stage, in the order in which the stages run. What a
// stage depends on is written once, in Inputs, and used both to plan a frame and to tell what is
// still valid after it.
#include "Rendering/Core/Plan/FramePlan.h"

#include "Rendering/Core/Plan/PixelFrustum.h"

#include <algorithm>

namespace hrt
{

namespace
{

StageDecision run(const char* reason)
{
  return { true, reason };
}

StageDecision skip(const char* reason)
{
  return { false, reason };
}

// Why a result is out of date; null when it is not.
using Cause = const char*;

bool anyLightMoved(const Changes& changes)
{
  return std::any_of(
    changes.lightMoved.begin(), changes.lightMoved.end(), [](bool moved) { return moved; });
}

// What each stage's result depends on.
class Inputs
{
public:
  Inputs(const Changes& changes, const SettingsChanges& settings)
    : C(changes)
    , Settings(settings)
  {
  }

  Cause triangles() const
  {
    return this->C.first ? "first frame" : this->C.geometry ? "geometry changed" : nullptr;
  }

  Cause placedTriangles() const
  {
    const Cause cause = this->triangles();
    return cause ? cause : this->C.transforms ? "an actor moved" : nullptr;
  }

  Cause structure() const
  {
    const Cause cause = this->placedTriangles();
    return cause ? cause : this->Settings.structure ? "another accelerator was chosen" : nullptr;
  }

  Cause shadowMap(std::size_t light) const
  {
    if (const Cause cause = this->placedTriangles())
    {
      return cause;
    }
    if (this->C.lightCount)
    {
      return "the set of lights changed";
    }
    return this->C.lightMoved.at(light) ? "the light moved" : nullptr;
  }

  Cause visibility() const
  {
    if (const Cause cause = this->placedTriangles())
    {
      return cause;
    }
    return this->C.camera ? "the camera changed"
      : this->C.culling   ? "face culling changed"
      : this->Settings.bounds     ? "the pixel bounds changed"
      : this->Settings.visibility ? "the visibility setting changed"
                                  : nullptr;
  }

  // What shading depends on beside the visible triangles.
  Cause shading() const
  {
    return this->C.materials      ? "a material changed"
      : this->C.lightCount        ? "the set of lights changed"
      : anyLightMoved(this->C)    ? "a light moved"
      : this->C.lightColors       ? "a light's colour changed"
      : this->Settings.shading    ? "the shading or shadow settings changed"
                                  : nullptr;
  }

  Cause primaryImage() const
  {
    const Cause cause = this->visibility();
    return cause ? cause : this->shading();
  }

  // What rays beyond the first hit see.
  Cause secondaryImage() const
  {
    const Cause cause = this->primaryImage();
    return cause            ? cause
      : this->C.background ? "the background changed"
      : this->Settings.secondary ? "the reflection or refraction settings changed"
      : this->Settings.sampling  ? "the multisampling or interleaving settings changed"
                                 : nullptr;
  }

private:
  const Changes& C;
  const SettingsChanges& Settings;
};

bool rasterises(const Settings& settings)
{
  return settings.visibility != Visibility::RayCasting;
}

// Of what is not there: it is being traced.
const char* const kUnderWay = "the rays under way are finished";

StageDecision decide(Cause outdated, bool cached, const char* missing, const char* upToDate)
{
  return outdated ? run(outdated) : cached ? skip(upToDate) : run(missing);
}

StageDecision planUpload(
  const Facts& facts, const Settings& settings, const Inputs& inputs, const Caches& caches)
{
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view");
  }
  if (!rasterises(settings) && settings.shadesOnCPU())
  {
    return skip("all is done on the CPU");
  }
  return decide(inputs.triangles(), caches.geometryUploaded, "the GPU does not hold the geometry",
    "the GPU holds the geometry");
}

StageDecision planShadowMap(std::size_t light, const Facts& facts, const Settings& settings,
  const Inputs& inputs, const Caches& caches)
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
    return skip("the light is at the eye and its shadows are hidden");
  }
  const bool cached = light < caches.shadowMaps.size() && caches.shadowMaps[light];
  return decide(inputs.shadowMap(light), cached, "the light has no map yet",
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

StageDecision planVisibility(const Facts& facts, const Inputs& inputs, const Caches& caches)
{
  if (!facts.anyPartInView)
  {
    return skip("nothing is in view");
  }
  return decide(inputs.visibility(), caches.visibility, "no object intersection buffer yet",
    "nothing changed what is visible");
}

StageDecision planPrimaryShading(const Facts& facts, const Settings& settings,
  const FramePlan& plan, const Inputs& inputs, const Caches& caches)
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
  return decide(whole ? inputs.secondaryImage() : inputs.primaryImage(), caches.primaryImage,
    whole && caches.tracing ? kUnderWay : "no primary image yet", "the primary image is valid");
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
  const FramePlan& plan, const Inputs& inputs, const Caches& caches)
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
  return decide(visibility.run ? visibility.reason : inputs.secondaryImage(),
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
  if (!rasterises(settings))
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
  if (!rasterises(settings) && plan[Stage::Visibility].run)
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
  const StageDecision& needed, const Inputs& inputs, const Caches& caches)
{
  if (!needed.run)
  {
    return needed;
  }
  return decide(inputs.structure(), caches.structure, "no ray structure yet",
    "the ray structure is valid");
}

// Pipelining shows each frame of an animation one frame late (paper, section 3.3). Whatever must be of
// one frame with the picture, or must not be seen once it is gone, forbids it.
StageDecision planPipelining(const Facts& facts, const Settings& settings, const FramePlan& plan,
  const Changes& changes, const SettingsChanges& settingsChanges, const Inputs& inputs,
  const Caches& caches)
{
  const Circumstances& around = facts.circumstances;
  const Stage traced = settings.shadesOnCPU() ? Stage::PrimaryShading : Stage::SecondaryRays;
  return !settings.pipelined ? skip("pipelining is off")
    : !rasterises(settings)  ? skip("primary rays are traced at once")
    : !plan[traced].run      ? skip("no rays are traced")
    : !around.animation      ? skip("no interactive update rate is asked for")
    : changes.first || changes.geometry ? skip("what is gone must not be shown")
    : settingsChanges.bounds  ? skip("the frame before shows other pixels")
    : !caches.previousPicture ? skip("there is no frame before to be shown")
    : !plan[Stage::Visibility].run && !inputs.secondaryImage()
    ? skip("nothing changed: the frame is finished")
    : around.stereo        ? skip("the next frame is the other eye's")
    : around.othersDraw    ? skip("VTK draws props into this frame")
    : around.sharedCamera  ? skip("another renderer shows the same view")
    : around.buffersWanted ? skip("buffers of this frame are wanted")
                           : run("an animation");
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

} // namespace

const char* stageName(Stage stage)
{
  switch (stage)
  {
    case Stage::GeometryUpload:
      return "geometry_upload";
    case Stage::ShadowMaps:
      return "shadow_maps";
    case Stage::Visibility:
      return "visibility";
    case Stage::PrimaryShading:
      return "primary_shading";
    case Stage::ShadowReadBack:
      return "shadow_read_back";
    case Stage::ReadBack:
      return "read_back";
    case Stage::Structure:
      return "structure";
    case Stage::SecondaryRays:
      return "secondary_rays";
    case Stage::Blit:
      return "blit";
    case Stage::Count:
      break;
  }
  return "";
}

SettingsChanges compareSettings(const Settings& before, const Settings& now)
{
  SettingsChanges changes;
  const bool interleave = before.interleave != now.interleave ||
    (now.interleave > 1 && before.interleaveErrorControl != now.interleaveErrorControl);
  changes.visibility = before.visibility != now.visibility ||
    (now.visibility == Visibility::RayCasting && interleave);
  changes.sampling = interleave || before.usedMultisampling() != now.usedMultisampling();
  changes.structure = before.accelerator != now.accelerator;
  changes.bounds = before.bounds != now.bounds || before.tracedBounds != now.tracedBounds;
  changes.shading = before.shadows != now.shadows || before.primaryShading != now.primaryShading ||
    (now.shadows == ShadowMode::ShadowMaps &&
      before.shadowMapResolution != now.shadowMapResolution);
  changes.secondary = before.reflections != now.reflections ||
    before.refractions != now.refractions || before.maximumDepth != now.maximumDepth;
  return changes;
}

namespace
{

FramePlan planStages(const Facts& facts, const Settings& settings, const Inputs& inputs,
  const Caches& caches)
{
  const StageDecision secondary = needsSecondaryRays(facts, settings);
  FramePlan plan;
  plan[Stage::GeometryUpload] = planUpload(facts, settings, inputs, caches);
  for (std::size_t light = 0; light < facts.lightCanCast.size(); ++light)
  {
    plan.shadowMaps.push_back(planShadowMap(light, facts, settings, inputs, caches));
  }
  plan[Stage::ShadowMaps] = summarizeShadowMaps(plan.shadowMaps);
  plan[Stage::Visibility] = planVisibility(facts, inputs, caches);
  if (plan[Stage::Visibility].run && rasterises(settings))
  {
    plan.rasterised = facts.partInView;
  }
  plan[Stage::PrimaryShading] = planPrimaryShading(facts, settings, plan, inputs, caches);
  plan[Stage::SecondaryRays] = planSecondary(secondary, settings, plan, inputs, caches);
  plan[Stage::ShadowReadBack] = planShadowReadBack(settings, plan, caches);
  plan[Stage::ReadBack] = planReadBack(settings, plan, caches);
  plan[Stage::Structure] =
    planStructure(needsStructure(secondary, settings, plan), inputs, caches);
  plan[Stage::Blit] = planBlit(facts, plan);
  plan.useSecondaryImage =
    secondary.run && !settings.shadesOnCPU();
  return plan;
}

} // namespace

FramePlan planFrame(const Facts& facts, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& caches)
{
  const Inputs inputs(changes, settingsChanges);
  FramePlan plan = planStages(facts, settings, inputs, caches);
  const StageDecision pipelined =
    planPipelining(facts, settings, plan, changes, settingsChanges, inputs, caches);
  if (pipelined.run)
  {
    // The frame before keeps its buffers until it is shown; this one fills others.
    Caches others = caches;
    others.visibility = others.hostIds = others.tracing = false;
    others.primaryImage = others.secondaryImage = false;
    plan = planStages(facts, settings, inputs, others);
  }
  plan.pipelined = pipelined;
  plan.keepsTracing = caches.tracing &&
    (pipelined.run || (!plan[Stage::Visibility].run && !inputs.secondaryImage()));
  return plan;
}

Caches cachesAfter(const FramePlan& plan, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& before)
{
  const Inputs inputs(changes, settingsChanges);
  const auto valid = [&plan](Stage stage, Cause outdated, bool cached) {
    return plan[stage].run || (cached && !outdated);
  };
  Caches after;
  after.geometryUploaded =
    valid(Stage::GeometryUpload, inputs.triangles(), before.geometryUploaded);
  after.visibility = valid(Stage::Visibility, inputs.visibility(), before.visibility);
  // Ids are on the host after a read-back or after primary rays, which need none.
  after.hostIds = plan[Stage::ReadBack].run ||
    (plan[Stage::Visibility].run ? settings.visibility == Visibility::RayCasting
                                 : before.hostIds && !inputs.visibility());
  after.hostShadowMaps = plan[Stage::ShadowReadBack].run ||
    (before.hostShadowMaps && !plan[Stage::ShadowMaps].run);
  const bool whole = settings.shadesOnCPU();
  after.primaryImage = valid(Stage::PrimaryShading,
    whole ? inputs.secondaryImage() : inputs.primaryImage(), before.primaryImage);
  after.secondaryImage =
    valid(Stage::SecondaryRays, inputs.secondaryImage(), before.secondaryImage);
  if (plan.pipelined.run)
  {
    (whole ? after.primaryImage : after.secondaryImage) = false;
  }
  after.tracing = plan.pipelined.run;
  after.previousPicture = plan[Stage::Blit].run;
  after.structure = valid(Stage::Structure, inputs.structure(), before.structure);
  for (std::size_t light = 0; light < plan.shadowMaps.size(); ++light)
  {
    const bool cached = light < before.shadowMaps.size() && before.shadowMaps[light];
    after.shadowMaps.push_back(
      plan.shadowMaps[light].run || (cached && !inputs.shadowMap(light)));
  }
  return after;
}

Facts gatherFacts(const Snapshot& snapshot, const PixelBounds& bounds)
{
  Facts facts;
  facts.triangles = snapshot.triangleCount;
  const PixelFrustum frustum(snapshot.camera, bounds);
  for (const Part& part : snapshot.parts)
  {
    const bool seen = part.visibleToCamera && frustum.mayShow(part);
    facts.partInView.push_back(seen);
    facts.anyPartInView = facts.anyPartInView || seen;
    facts.mirrorInView = facts.mirrorInView || (seen && part.material.isMirror());
    facts.glassInView = facts.glassInView || (seen && part.material.isGlass());
    facts.anyCaster =
      facts.anyCaster || (part.castsShadow && part.geometry->triangleCount() > 0);
  }
  for (const Light& light : snapshot.lights)
  {
    // From the eye itself no shadow is seen: whatever hides a point from the light hides it from
    // the camera too. The rays of a parallel projection do not start at one eye.
    facts.lightCanCast.push_back(!(light.isHeadlight && light.kind == Light::Kind::Positional &&
      !snapshot.camera.parallel));
  }
  return facts;
}

} // namespace hrt
