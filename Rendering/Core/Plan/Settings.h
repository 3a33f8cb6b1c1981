// What the user can choose, as plain values that the pass fills in, and what follows from a choice.
// Which results a change of the choice outdates is told here too, beside the settings: whoever adds
// one sees that it must be compared.
#pragma once

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Tracing/Multisampling.h"

#include <cstdint>

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
  GPU, // the primary shader, shadows from maps
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
  // The rasteriser finds what the camera sees; else primary rays do.
  bool rasterises() const { return visibility != Visibility::RayCasting; }
  // How what the camera sees gets its shadows. The traditional ray tracer draws nothing, maps neither.
  bool usesShadowMaps() const
  {
    return shadows == ShadowMode::ShadowMaps &&
      !(shadesOnCPU() && !rasterises());
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

} // namespace hrt
