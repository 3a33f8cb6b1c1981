// The frame plan decides, before any work is done, which stages of a frame run and records why each
// other stage is skipped. It is a pure function of plain values, tested by table; nothing else in
// the code decides to skip anything.
#pragma once

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Tracing/Multisampling.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace hrt
{

enum class Visibility : std::uint8_t
{
  ItemBuffer,      // rasterised ids, one intersection a pixel
  DirectRendering, // rasterised ids and (u, v)
  RayCasting       // primary rays on the CPU
};
enum class PrimaryShading : std::uint8_t
{
  GPU, // the ray caster's shader, shadows from maps
  CPU  // the tracer, shadows from maps that were read back or from rays
};
enum class Accelerator : std::uint8_t
{
  Embree,
  KdTree
};
enum class ShadowMode : std::uint8_t
{
  Off,
  ShadowMaps, // drawn by the rasteriser
  Exact       // rays
};

// What the user asked for; read from the pass.
struct Settings
{
  Visibility visibility = Visibility::ItemBuffer;
  PrimaryShading primaryShading = PrimaryShading::GPU;
  Accelerator accelerator = Accelerator::Embree;
  ShadowMode shadows = ShadowMode::ShadowMaps;
  bool reflections = true;
  bool refractions = true;
  int maximumDepth = 3;          // bounces of a secondary ray
  int shadowMapResolution = 2048;// texels along a side of one map face
  bool pipelined = false;        // in animations, show a frame while the next one is traced
  Multisampling multisampling = Multisampling::Clamp;
  int interleave = 1;            // every n-th column and row is traced
  bool interleaveErrorControl = true;
  PixelBounds bounds;            // pixels to show, within the viewport
  PixelBounds tracedBounds;      // these and what they depend on: see setBounds

  // Shadow rays end at the CPU, and so must be shaded what they were cast for.
  bool shadesOnCPU() const
  {
    return primaryShading == PrimaryShading::CPU || shadows == ShadowMode::Exact;
  }
  // How what the camera sees gets its shadows. The traditional ray tracer draws nothing, maps neither.
  bool usesShadowMaps() const
  {
    return shadows == ShadowMode::ShadowMaps &&
      !(shadesOnCPU() && visibility == Visibility::RayCasting);
  }
  bool usesShadowRays() const { return shadows != ShadowMode::Off && !usesShadowMaps(); }
  // What rays and direct rendering find needs no repair.
  Multisampling usedMultisampling() const
  {
    return visibility == Visibility::ItemBuffer ? multisampling : Multisampling::Clamp;
  }
  // After all other settings are made; multisampling and interleaving look at neighbours.
  void setBounds(const PixelBounds& wanted, int width, int height)
  {
    bounds = wanted.within(width, height);
    tracedBounds =
      bounds.grownBy(pixelsAround(usedMultisampling(), interleave)).within(width, height);
  }
};

// Which results a change of the settings outdates.
struct SettingsChanges
{
  bool visibility = false; // how the first hits are found
  bool shading = false;    // where and with which shadows they are shaded
  bool secondary = false;  // reflections, refractions, depth
  bool sampling = false;   // from which pixels and triangles rays start on the CPU
  bool structure = false;  // the kind of ray structure
  bool bounds = false;     // which pixels are traced
};
SettingsChanges compareSettings(const Settings& before, const Settings& now);

// What surrounds a frame, as far as pipelining needs to know.
struct Circumstances
{
  bool animation = false;     // more frames follow soon; the window asks for an interactive rate
  bool stereo = false;        // the next frame is the other eye's
  bool othersDraw = false;    // VTK draws props of its own at this frame's view
  bool sharedCamera = false;  // so does another renderer of the window
  bool buffersWanted = false; // the user asks for this frame's buffers
};

// What the scene holds, as far as the plan needs to know.
struct Facts
{
  Circumstances circumstances;
  std::uint64_t triangles = 0;        // in the snapshot
  // Per part: the camera sees it and it meets the view frustum of the pixel bounds.
  std::vector<bool> partInView;
  bool anyPartInView = false;
  bool mirrorInView = false;          // same, for a part with reflectance
  bool glassInView = false;           // same, for a part of glass
  bool anyCaster = false;
  std::vector<bool> lightCanCast;     // per light: false e.g. for a headlight placed at the eye
};

// What is still valid from earlier frames on this GL context.
struct Caches
{
  bool geometryUploaded = false;      // the GPU holds this snapshot's geometry
  bool visibility = false;            // the object intersection buffer exists with this size
  bool hostIds = false;               // its ids are in host memory
  bool hostShadowMaps = false;        // all valid shadow maps are in host memory
  bool primaryImage = false;          // the shaded primary image exists
  bool secondaryImage = false;        // the secondary rays' image exists
  bool structure = false;             // a ray structure exists
  bool previousPicture = false;       // the picture of the last frame, of this size, can be shown
  bool tracing = false;               // its rays are still under way
  std::vector<bool> shadowMaps;       // per light: its map exists at the wanted resolution
};

// In the order in which they run.
enum class Stage : std::uint8_t
{
  GeometryUpload,  // triangles to vertex and texture buffers
  ShadowMaps,      // depth maps as seen from the lights
  Structure,       // acceleration structure for rays
  Visibility,      // what each pixel shows: rasterised or by primary rays
  ShadowReadBack,  // shadow maps to host memory
  ReadBack,        // ids of the pixels to host memory
  PrimaryShading,  // GPU ray caster, or the tracer
  SecondaryRays,   // reflection, refraction and their shadow rays
  Blit,            // result into the window's framebuffer
  Count
};
inline constexpr std::size_t kStageCount = static_cast<std::size_t>(Stage::Count);

// The name scripts read in the statistics: snake case.
const char* stageName(Stage stage);

struct StageDecision
{
  bool run = false;
  const char* reason = ""; // why it runs or why it is skipped; a short English phrase
};

struct FramePlan
{
  std::array<StageDecision, kStageCount> stages;
  std::vector<StageDecision> shadowMaps; // per light of the snapshot
  std::vector<bool> rasterised;          // per part: drawn into the object intersection buffer
  bool useSecondaryImage = false;        // composite the secondary image over the primary one
  StageDecision pipelined;               // trace on after the frame, which shows the one before
  bool keepsTracing = false;             // the rays under way since the last frame are still wanted

  const StageDecision& operator[](Stage s) const { return stages[static_cast<std::size_t>(s)]; }
  StageDecision& operator[](Stage s) { return stages[static_cast<std::size_t>(s)]; }
};

FramePlan planFrame(const Facts& facts, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& caches);

// Gathers the facts of a snapshot; `lightCanCast` included.
Facts gatherFacts(const Snapshot& snapshot, const PixelBounds& bounds = {});

// What is valid after a frame that ran the plan: results of stages that ran are; results of stages
// that were skipped although what they depend on changed are no longer. Without this a structure
// that no mirror needed while a part moved would look up to date when the mirror comes into view.
Caches cachesAfter(const FramePlan& plan, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& before);

} // namespace hrt
