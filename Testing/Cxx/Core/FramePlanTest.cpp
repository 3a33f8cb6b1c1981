// The frame plan, rule by rule: which stages run after which change, and why the others do not.
#include "Rendering/Core/Plan/FramePlan.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>

namespace
{

using namespace hrt;

// A scene with everything in view, all caches valid and nothing changed; each test departs from it.
struct Frame
{
  Facts facts;
  Settings settings;
  SettingsChanges settingsChanges;
  Changes changes;
  Caches caches;

  Frame()
  {
    facts.anyPartInView = facts.mirrorInView = facts.anyCaster = true;
    facts.partInView = { true, false };
    facts.lightCanCast = { true, true };
    changes.first = changes.camera = changes.geometry = changes.transforms = false;
    changes.materials = changes.culling = changes.lightColors = changes.background = false;
    changes.lightCount = false;
    changes.lightMoved = { false, false };
    caches.geometryUploaded = caches.visibility = caches.primaryImage = true;
    caches.secondaryImage = caches.structure = caches.hostIds = true;
    caches.hostShadowMaps = true;
    caches.shadowMaps = { true, true };
  }

  FramePlan plan() const
  {
    return planFrame(facts, settings, settingsChanges, changes, caches);
  }
};

// The stages that run, by initials: Upload, shadow maps 0 and 1, Visibility, Primary, sHadow map
// read-back, Read-back, sTructure, secondarY rays, Blit.
std::string running(const FramePlan& plan)
{
  std::string names;
  const auto add = [&](bool run, const char* name) { names += run ? name : ""; };
  add(plan[Stage::GeometryUpload].run, "U");
  for (std::size_t i = 0; i < plan.shadowMaps.size(); ++i)
  {
    add(plan.shadowMaps[i].run, i == 0 ? "0" : "1");
  }
  add(plan[Stage::Visibility].run, "V");
  add(plan[Stage::PrimaryShading].run, "P");
  add(plan[Stage::ShadowReadBack].run, "H");
  add(plan[Stage::ReadBack].run, "R");
  add(plan[Stage::Structure].run, "T");
  add(plan[Stage::SecondaryRays].run, "Y");
  add(plan[Stage::Blit].run, "B");
  return names;
}

TEST(FramePlan, StillFrameOnlyBlits)
{
  const FramePlan plan = Frame().plan();
  EXPECT_EQ(running(plan), "B");
  EXPECT_STREQ(plan[Stage::Blit].reason, "nothing changed since the last frame");
  EXPECT_TRUE(plan.useSecondaryImage);
}

TEST(FramePlan, FirstFrameRunsEverything)
{
  Frame frame;
  frame.changes = Changes();
  frame.changes.lightMoved = { true, true };
  frame.caches = Caches();
  EXPECT_EQ(running(frame.plan()), "U01VPRTYB");
}

TEST(FramePlan, RunsWhatAChangeNeeds)
{
  const struct
  {
    const char* what;
    const char* stages;
    std::function<void(Frame&)> change;
  } table[] = {
    { "geometry", "U01VPRTYB", [](Frame& f) { f.changes.geometry = true; } },
    { "actor moved", "01VPRTYB", [](Frame& f) { f.changes.transforms = true; } },
    { "camera", "VPRYB", [](Frame& f) { f.changes.camera = true; } },
    { "material", "PYB", [](Frame& f) { f.changes.materials = true; } },
    { "culling", "VPRYB",
      [](Frame& f) { f.changes.materials = f.changes.culling = true; } },
    { "light colour", "PYB", [](Frame& f) { f.changes.lightColors = true; } },
    { "light 1 moved", "1PYB", [](Frame& f) { f.changes.lightMoved[1] = true; } },
    { "light 1 moved, no mirror", "1PB",
      [](Frame& f) {
        f.changes.lightMoved[1] = true;
        f.facts.mirrorInView = false;
      } },
    { "lights replaced", "01PYB", [](Frame& f) { f.changes.lightCount = true; } },
    { "background", "YB", [](Frame& f) { f.changes.background = true; } },
    { "background, no mirror", "B",
      [](Frame& f) {
        f.changes.background = true;
        f.facts.mirrorInView = false;
      } },
    { "visibility setting", "VPRYB", [](Frame& f) { f.settingsChanges.visibility = true; } },
    { "shadow setting", "PYB", [](Frame& f) { f.settingsChanges.shading = true; } },
    { "depth setting", "YB", [](Frame& f) { f.settingsChanges.secondary = true; } },
    { "pixel bounds", "VPRYB", [](Frame& f) { f.settingsChanges.bounds = true; } },
    { "pixel bounds, no mirror in them", "VPB",
      [](Frame& f) {
        f.settingsChanges.bounds = true;
        f.facts.mirrorInView = false;
      } },
    { "no upload yet", "UB", [](Frame& f) { f.caches.geometryUploaded = false; } },
    { "no map yet", "0PB", [](Frame& f) { f.caches.shadowMaps[0] = false; } },
    { "caches of fewer lights", "1PB", [](Frame& f) { f.caches.shadowMaps.resize(1); } },
    { "no buffer yet", "VPRYB", [](Frame& f) { f.caches.visibility = false; } },
    { "no primary image", "PB", [](Frame& f) { f.caches.primaryImage = false; } },
    { "no secondary image", "YB", [](Frame& f) { f.caches.secondaryImage = false; } },
    { "unneeded structure", "B", [](Frame& f) { f.caches.structure = false; } },
    { "no structure", "TYB",
      [](Frame& f) { f.caches.structure = f.caches.secondaryImage = false; } },
    { "shadows off", "VPRTYB",
      [](Frame& f) {
        f.settings.shadows = ShadowMode::Off;
        f.changes.transforms = true;
      } },
    { "no caster", "VPRTYB",
      [](Frame& f) {
        f.facts.anyCaster = false;
        f.changes.transforms = true;
      } },
    { "light at the eye", "1VPRTYB",
      [](Frame& f) {
        f.facts.lightCanCast[0] = false;
        f.changes.transforms = true;
      } },
    { "camera, no mirror", "VPB",
      [](Frame& f) {
        f.facts.mirrorInView = false;
        f.changes.camera = true;
      } },
    { "glass only", "VPRYB",
      [](Frame& f) {
        f.facts.mirrorInView = false;
        f.facts.glassInView = true;
        f.changes.camera = true;
      } },
    { "ids not on the host", "PRYB",
      [](Frame& f) {
        f.changes.materials = true;
        f.caches.hostIds = false;
      } },
    { "another interleaving", "YB", [](Frame& f) { f.settingsChanges.sampling = true; } },
    { "another interleaving without mirror", "B",
      [](Frame& f) {
        f.settingsChanges.sampling = true;
        f.facts.mirrorInView = false;
      } },
    { "another interleaving, shaded on the CPU", "PB",
      [](Frame& f) {
        f.settingsChanges.sampling = true;
        f.settings.primaryShading = PrimaryShading::CPU;
      } },
    { "another accelerator", "B", [](Frame& f) { f.settingsChanges.structure = true; } },
    { "another accelerator, moved", "VPRTYB",
      [](Frame& f) {
        f.settingsChanges.structure = f.changes.camera = true;
      } },
    { "nothing in view", "",
      [](Frame& f) {
        f.facts.anyPartInView = f.facts.mirrorInView = false;
        f.changes.geometry = f.changes.camera = true;
      } },
    { "empty scene", "",
      [](Frame& f) {
        f.facts = Facts();
        f.changes = Changes();
      } },
  };
  for (const auto& row : table)
  {
    Frame frame;
    row.change(frame);
    EXPECT_EQ(running(frame.plan()), row.stages) << row.what;
  }
}

TEST(FramePlan, SecondaryRaysFollowTheSettings)
{
  const struct
  {
    bool mirror, glass, reflections, refractions;
    int depth;
    bool used;
  } table[] = {
    { true, false, true, true, 3, true },
    { true, false, false, true, 3, false },
    { false, true, true, true, 1, true },
    { false, true, true, false, 3, false },
    { false, true, false, true, 3, true },
    { true, true, false, false, 3, false },
    { true, true, true, true, 0, false },
    { false, false, true, true, 3, false },
  };
  for (const auto& row : table)
  {
    Frame frame;
    frame.changes.geometry = true;
    frame.facts.mirrorInView = row.mirror;
    frame.facts.glassInView = row.glass;
    frame.settings.reflections = row.reflections;
    frame.settings.refractions = row.refractions;
    frame.settings.maximumDepth = row.depth;
    const FramePlan plan = frame.plan();
    EXPECT_EQ(plan.useSecondaryImage, row.used);
    EXPECT_EQ(plan[Stage::Structure].run, row.used);
    EXPECT_EQ(plan[Stage::ReadBack].run, row.used);
    EXPECT_EQ(plan[Stage::SecondaryRays].run, row.used);
  }
}

TEST(FramePlan, EveryStageHasANameAndAReason)
{
  Frame moved, empty;
  moved.changes.transforms = true;
  empty.facts = Facts();
  for (const FramePlan& plan : { Frame().plan(), moved.plan(), empty.plan() })
  {
    for (std::size_t i = 0; i < kStageCount; ++i)
    {
      EXPECT_STRNE(plan.stages[i].reason, "") << i;
      EXPECT_STRNE(stageName(static_cast<Stage>(i)), "") << i;
    }
    for (const StageDecision& map : plan.shadowMaps)
    {
      EXPECT_STRNE(map.reason, "");
    }
  }
  EXPECT_STREQ(stageName(Stage::SecondaryRays), "secondary_rays");
  EXPECT_STREQ(moved.plan()[Stage::Structure].reason, "an actor moved");
}

// The same rows for pictures that the CPU shades, over rasterised ids with shadow maps and with
// shadow rays, and over primary rays.
TEST(FramePlan, CPUShadingTracesAllAtOnce)
{
  const struct
  {
    const char* what;
    const char* maps;
    const char* exact;
    const char* rayCast;
    std::function<void(Frame&)> change;
  } table[] = {
    { "nothing", "B", "B", "B", [](Frame&) {} },
    { "first frame", "U01VPHRTB", "UVPRTB", "VPTB",
      [](Frame& f) {
        f.changes = Changes();
        f.changes.lightMoved = { true, true };
        f.caches = Caches();
      } },
    { "camera", "VPRB", "VPRB", "VPB", [](Frame& f) { f.changes.camera = true; } },
    { "camera, maps on the GPU only", "VPHRB", "VPRB", "VPB",
      [](Frame& f) {
        f.changes.camera = true;
        f.caches.hostShadowMaps = false;
      } },
    { "actor moved", "01VPHRTB", "VPRTB", "VPTB", [](Frame& f) { f.changes.transforms = true; } },
    { "actor moved, no mirror", "01VPHRB", "VPRTB", "VPTB",
      [](Frame& f) {
        f.changes.transforms = true;
        f.facts.mirrorInView = false;
      } },
    { "light moved", "1PHB", "PB", "PB", [](Frame& f) { f.changes.lightMoved[1] = true; } },
    { "background", "PB", "PB", "PB", [](Frame& f) { f.changes.background = true; } },
    { "depth setting", "PB", "PB", "PB", [](Frame& f) { f.settingsChanges.secondary = true; } },
    { "pixel bounds", "VPRB", "VPRB", "VPB", [](Frame& f) { f.settingsChanges.bounds = true; } },
    { "maps on the GPU only", "B", "B", "B",
      [](Frame& f) { f.caches.hostShadowMaps = false; } },
    { "nothing in view", "", "", "", [](Frame& f) { f.facts.anyPartInView = false; } },
  };
  for (const auto& row : table)
  {
    Frame frame;
    frame.settings.primaryShading = PrimaryShading::CPU;
    row.change(frame);
    EXPECT_EQ(running(frame.plan()), row.maps) << row.what;
    EXPECT_FALSE(frame.plan().useSecondaryImage) << row.what;
    frame.settings.shadows = ShadowMode::Exact;
    EXPECT_EQ(running(frame.plan()), row.exact) << row.what;
    frame.settings.primaryShading = PrimaryShading::GPU; // shadow rays bring the shading with them
    EXPECT_EQ(running(frame.plan()), row.exact) << row.what;
    frame.settings.primaryShading = PrimaryShading::CPU;
    frame.settings.visibility = Visibility::RayCasting;
    EXPECT_EQ(running(frame.plan()), row.rayCast) << row.what;
    frame.settings.shadows = ShadowMode::ShadowMaps; // nothing is rasterised, maps neither
    EXPECT_EQ(running(frame.plan()), row.rayCast) << row.what;
  }
}

TEST(FramePlan, CPUShadingWithoutShadowsOrMirrorsTracesNothing)
{
  Frame frame;
  frame.settings.primaryShading = PrimaryShading::CPU;
  frame.settings.shadows = ShadowMode::Off;
  frame.facts.mirrorInView = false;
  frame.changes.transforms = true;
  EXPECT_EQ(running(frame.plan()), "VPRB");
  frame.settings.visibility = Visibility::RayCasting;
  EXPECT_EQ(running(frame.plan()), "VPTB");
}

// A moving camera in an animation, the frame before shown or still being traced.
Frame animatedFrame(PrimaryShading shading)
{
  Frame frame;
  frame.settings.pipelined = true;
  frame.settings.primaryShading = shading;
  frame.facts.conditions.animation = true;
  frame.changes.camera = true;
  frame.caches.previousPicture = true;
  return frame;
}

TEST(FramePlan, AnAnimationIsPipelined)
{
  for (const PrimaryShading shading : { PrimaryShading::GPU, PrimaryShading::CPU })
  {
    Frame frame = animatedFrame(shading);
    const char* const stages = shading == PrimaryShading::GPU ? "VPRYB" : "VPRB";
    FramePlan plan = frame.plan();
    EXPECT_TRUE(plan.pipelined.run);
    EXPECT_FALSE(plan.keepsTracing); // nothing was under way
    EXPECT_EQ(running(plan), stages);
    frame.caches = cachesAfter(
      plan, frame.settings, frame.settingsChanges, frame.changes, frame.caches);
    EXPECT_TRUE(frame.caches.tracing);
    EXPECT_TRUE(frame.caches.hostIds);
    EXPECT_NE(frame.caches.primaryImage, shading == PrimaryShading::CPU);
    EXPECT_FALSE(frame.caches.secondaryImage && shading == PrimaryShading::GPU);

    // The next frame keeps the rays under way.
    plan = frame.plan();
    EXPECT_TRUE(plan.pipelined.run);
    EXPECT_TRUE(plan.keepsTracing);
    EXPECT_EQ(running(plan), stages);

    // Then nothing changes: what is under way is finished, and nothing drawn anew.
    frame.changes.camera = false;
    plan = frame.plan();
    EXPECT_FALSE(plan.pipelined.run);
    EXPECT_TRUE(plan.keepsTracing);
    EXPECT_EQ(running(plan), shading == PrimaryShading::GPU ? "YB" : "PB");
    frame.caches = cachesAfter(
      plan, frame.settings, frame.settingsChanges, frame.changes, frame.caches);
    EXPECT_FALSE(frame.caches.tracing);
    EXPECT_EQ(running(frame.plan()), "B");
  }
}

// Where only a light's colour changes, the picture that is shown still keeps its buffers to itself.
TEST(FramePlan, APipelinedFrameFillsBuffersOfItsOwn)
{
  Frame frame = animatedFrame(PrimaryShading::GPU);
  frame.changes.camera = false;
  frame.changes.lightColors = true;
  EXPECT_TRUE(frame.plan().pipelined.run);
  EXPECT_EQ(running(frame.plan()), "VPRYB");
  frame.settings.pipelined = false;
  EXPECT_EQ(running(frame.plan()), "PYB");
}

TEST(FramePlan, WhatForbidsPipelining)
{
  const std::function<void(Frame&)> table[] = {
    [](Frame& f) { f.settings.pipelined = false; },
    [](Frame& f) { f.settings.visibility = Visibility::RayCasting; },
    [](Frame& f) { f.facts.mirrorInView = false; },
    [](Frame& f) { f.facts.conditions.animation = false; },
    [](Frame& f) { f.facts.conditions.stereo = true; },
    [](Frame& f) { f.facts.conditions.othersDraw = true; },
    [](Frame& f) { f.facts.conditions.sharedCamera = true; },
    [](Frame& f) { f.facts.conditions.buffersWanted = true; },
    [](Frame& f) { f.changes.geometry = true; },
    [](Frame& f) { f.changes.first = true; },
    [](Frame& f) { f.caches.previousPicture = false; },
    [](Frame& f) { f.settingsChanges.bounds = true; },
    [](Frame& f) { f.facts.anyPartInView = f.facts.mirrorInView = false; },
  };
  std::set<std::string> reasons;
  for (const auto& change : table)
  {
    Frame frame = animatedFrame(PrimaryShading::GPU);
    frame.caches.tracing = true;
    frame.caches.secondaryImage = false;
    change(frame);
    const FramePlan plan = frame.plan();
    EXPECT_FALSE(plan.pipelined.run) << plan.pipelined.reason;
    EXPECT_FALSE(plan.keepsTracing) << plan.pipelined.reason; // another view's rays
    reasons.insert(plan.pipelined.reason);
    EXPECT_FALSE(
      cachesAfter(plan, frame.settings, frame.settingsChanges, frame.changes, frame.caches)
        .tracing);
  }
  EXPECT_GE(reasons.size(), 10u);
}

TEST(FramePlan, MapsThatNobodyReadBackAreNotOnTheHost)
{
  Frame frame;
  frame.changes.lightMoved[0] = true;
  const Caches after = cachesAfter(
    frame.plan(), frame.settings, frame.settingsChanges, frame.changes, frame.caches);
  EXPECT_TRUE(after.shadowMaps[0]);
  EXPECT_FALSE(after.hostShadowMaps);
  frame.settings.primaryShading = PrimaryShading::CPU;
  EXPECT_TRUE(cachesAfter(
    frame.plan(), frame.settings, frame.settingsChanges, frame.changes, frame.caches)
                .hostShadowMaps);
}

TEST(FramePlan, PrimaryRaysFeedTheGPU)
{
  Frame frame;
  frame.settings.visibility = Visibility::RayCasting;
  frame.facts.mirrorInView = false;
  frame.changes.camera = true;
  FramePlan plan = frame.plan();
  EXPECT_EQ(running(plan), "VPB");
  frame.caches = cachesAfter(plan, frame.settings, {}, frame.changes, frame.caches);
  EXPECT_TRUE(frame.caches.hostIds) << "the rays' own";
  frame.caches.structure = false;
  EXPECT_EQ(running(frame.plan()), "VPTB");
  frame.facts.mirrorInView = true;
  EXPECT_EQ(running(frame.plan()), "VPTYB");
  EXPECT_STREQ(frame.plan()[Stage::ReadBack].reason, "primary rays leave their ids on the host");
}

TEST(FramePlan, SkippedStagesGoStale)
{
  // A part moves while no mirror is in view; in the next frame the mirror appears.
  Frame frame;
  frame.facts.mirrorInView = false;
  frame.changes.transforms = true;
  FramePlan plan = frame.plan();
  EXPECT_FALSE(plan[Stage::Structure].run);
  frame.caches = cachesAfter(plan, frame.settings, {}, frame.changes, frame.caches);
  EXPECT_TRUE(frame.caches.visibility && frame.caches.primaryImage);
  EXPECT_FALSE(frame.caches.structure || frame.caches.secondaryImage);

  frame.facts.mirrorInView = true;
  frame.changes.transforms = false;
  frame.changes.camera = true;
  plan = frame.plan();
  EXPECT_TRUE(plan[Stage::Structure].run);
  EXPECT_STREQ(plan[Stage::Structure].reason, "no ray structure yet");
  frame.caches = cachesAfter(plan, frame.settings, {}, frame.changes, frame.caches);
  EXPECT_TRUE(frame.caches.structure && frame.caches.secondaryImage);
  EXPECT_TRUE(frame.caches.geometryUploaded);

  frame.changes.camera = false;
  EXPECT_EQ(running(frame.plan()), "B");
}

TEST(FramePlan, RasterisesThePartsInView)
{
  Frame frame;
  EXPECT_TRUE(frame.plan().rasterised.empty()) << "nothing changed";
  frame.changes.camera = true;
  EXPECT_EQ(frame.plan().rasterised, std::vector<bool>({ true, false }));
  frame.settings.visibility = Visibility::RayCasting;
  EXPECT_TRUE(frame.plan().rasterised.empty()) << "rays are cast";
}

// Bounds that show nothing run no stage; what was in the pictures is gone all the same.
TEST(FramePlan, BoundsThatShowNothingOutdateThePictures)
{
  Frame frame;
  frame.facts.anyPartInView = frame.facts.mirrorInView = false;
  frame.settingsChanges.bounds = true;
  const FramePlan plan = frame.plan();
  EXPECT_EQ(running(plan), "");
  frame.caches =
    cachesAfter(plan, frame.settings, frame.settingsChanges, frame.changes, frame.caches);
  EXPECT_FALSE(frame.caches.visibility || frame.caches.hostIds || frame.caches.primaryImage ||
    frame.caches.secondaryImage || frame.caches.previousPicture);
  EXPECT_TRUE(frame.caches.geometryUploaded && frame.caches.structure);
  EXPECT_EQ(frame.caches.shadowMaps, std::vector<bool>({ true, true }));
  frame.settingsChanges.bounds = false;
  frame.facts.anyPartInView = frame.facts.mirrorInView = true;
  EXPECT_EQ(running(frame.plan()), "VPRYB");
}

TEST(FramePlan, ShadowMapsGoStaleWhileShadowsAreOff)
{
  Frame frame;
  frame.settings.shadows = ShadowMode::Off;
  frame.changes.lightMoved[1] = true;
  frame.caches = cachesAfter(frame.plan(), frame.settings, {}, frame.changes, frame.caches);
  EXPECT_EQ(frame.caches.shadowMaps, std::vector<bool>({ true, false }));
  frame.changes.lightMoved[1] = false;
  frame.settings.shadows = ShadowMode::ShadowMaps;
  frame.settingsChanges.shading = true;
  EXPECT_EQ(running(frame.plan()), "1PYB");
}

TEST(SettingsChanges, NameWhatTheyOutdate)
{
  const auto compareFrom = [](const Settings& before, const std::function<void(Settings&)>& change) {
    Settings now = before;
    change(now);
    const SettingsChanges c = compareSettings(before, now);
    return std::string(c.visibility ? "V" : "") + (c.shading ? "S" : "") +
      (c.secondary ? "R" : "") + (c.structure ? "T" : "") + (c.sampling ? "I" : "") +
      (c.bounds ? "B" : "");
  };
  const auto compare = [&](const std::function<void(Settings&)>& change) {
    return compareFrom(Settings(), change);
  };
  EXPECT_EQ(compare([](Settings&) {}), "");
  EXPECT_EQ(compare([](Settings& s) { s.visibility = Visibility::DirectRendering; }), "V");
  EXPECT_EQ(compare([](Settings& s) { s.shadows = ShadowMode::Off; }), "S");
  EXPECT_EQ(compare([](Settings& s) { s.primaryShading = PrimaryShading::CPU; }), "S");
  EXPECT_EQ(compare([](Settings& s) { s.accelerator = Accelerator::KdTree; }), "T");
  EXPECT_EQ(compare([](Settings& s) { s.shadowMapResolution = 64; }), "S");
  EXPECT_EQ(compare([](Settings& s) { s.reflections = false; }), "R");
  EXPECT_EQ(compare([](Settings& s) { s.refractions = false; }), "R");
  EXPECT_EQ(compare([](Settings& s) { s.maximumDepth = 7; }), "R");

  const auto lazy = [](Settings& s) { s.multisampling = Multisampling::Lazy3x3; };
  const auto thinner = [](Settings& s) { s.interleave = 2; };
  const auto uncontrolled = [](Settings& s) { s.interleaveErrorControl = false; };
  EXPECT_EQ(compare(lazy), "I");
  EXPECT_EQ(compare(thinner), "I");
  EXPECT_EQ(compare(uncontrolled), ""); // of every pixel there is nothing to control
  Settings every;
  every.interleave = 3;
  EXPECT_EQ(compareFrom(every, uncontrolled), "I");
  // Primary rays are thinned too, and need no repair; nor does direct rendering.
  Settings rays;
  rays.visibility = Visibility::RayCasting;
  EXPECT_EQ(compareFrom(rays, thinner), "VI");
  EXPECT_EQ(compareFrom(rays, lazy), "");
  Settings direct;
  direct.visibility = Visibility::DirectRendering;
  EXPECT_EQ(compareFrom(direct, lazy), "");
  EXPECT_EQ(compare([](Settings& s) { s.bounds.x0 = 7; }), "B");
  EXPECT_EQ(compare([](Settings& s) { s.bounds.y1 = 7; }), "B");
  EXPECT_EQ(compare([](Settings& s) { s.tracedBounds.y1 = 7; }), "B");
}

TEST(GatherFacts, SeesWhatIsInTheFrustum)
{
  const auto ball = scenes::sphere(8, 4);
  const auto at = [](double x, double y, double z) {
    return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, z));
  };
  const auto facts = [&](const glm::dmat4& place, bool visible) {
    Snapshot s;
    s.camera = scenes::perspective({ 0, 0, 10 }, { 0, 0, 0 }, 64, 64, 40.0);
    Part& part = scenes::addPart(s, ball, place);
    part.visibleToCamera = visible;
    part.material.reflectance = 0.5f;
    return gatherFacts(s);
  };
  EXPECT_TRUE(facts(at(0, 0, 0), true).mirrorInView);
  EXPECT_TRUE(facts(at(4, 0, 0), true).anyPartInView); // cut by the frustum's side, 3.64 wide
  EXPECT_FALSE(facts(at(6, 0, 0), true).anyPartInView);
  EXPECT_FALSE(facts(at(0, -6, 0), true).anyPartInView);
  EXPECT_FALSE(facts(at(0, 0, 12), true).anyPartInView);   // behind the camera
  EXPECT_FALSE(facts(at(0, 0, -100), true).anyPartInView); // beyond the far plane
  EXPECT_FALSE(facts(at(0, 0, 0), false).anyPartInView);
  EXPECT_FALSE(facts(at(6, 0, 0), true).mirrorInView);
  EXPECT_FALSE(facts(at(0, 0, 0), true).glassInView);
  EXPECT_TRUE(facts(at(6, 0, 0), true).anyCaster); // out of view still casts
}

TEST(GatherFacts, PositionalHeadlightsCastNoVisibleShadow)
{
  Snapshot s;
  s.lights.resize(4);
  s.lights[0].isHeadlight = true;
  s.lights[0].kind = Light::Kind::Positional;
  s.lights[1].isHeadlight = true;
  s.lights[2].kind = Light::Kind::Positional;
  EXPECT_EQ(gatherFacts(s).lightCanCast, std::vector<bool>({ false, true, true, true }));
  EXPECT_FALSE(gatherFacts(s).anyCaster);
}

} // namespace
