// The memory between frames: which results of earlier frames may be used again. A plan reads it;
// after the frame it is brought up to date by the same dependencies that the plan was made by.
#pragma once

#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Snapshot.h"

#include <vector>

namespace hrt
{

struct FramePlan;

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

// What is valid after a frame that ran the plan: results of stages that ran are; results of stages
// that were skipped although what they depend on changed are no longer. Without this a structure
// that no mirror needed while a part moved would look up to date when the mirror comes into view.
Caches cachesAfter(const FramePlan& plan, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& before);

} // namespace hrt
