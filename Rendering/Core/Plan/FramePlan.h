// The frame plan decides, before any work is done, which stages of a frame run and records why each
// other stage is skipped. It is a pure function of plain values, tested by table; nothing else in
// the code decides to skip anything.
#pragma once

#include "Rendering/Core/Plan/Caches.h"
#include "Rendering/Core/Plan/Facts.h"
#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Plan/Stage.h"
#include "Rendering/Core/Snapshot.h"

#include <array>
#include <cstddef>
#include <vector>

namespace hrt
{

struct FramePlan
{
  std::array<StageDecision, kStageCount> stages;
  std::vector<StageDecision> shadowMaps; // per light of the snapshot
  std::vector<bool> rasterised;          // per part: drawn into the object intersection buffer
  SurfaceFeatures features;              // that primary shading has to know of
  bool useSecondaryImage = false;        // composite the secondary image over the primary one
  StageDecision pipelined;               // trace on after the frame, which shows the one before
  bool keepsTracing = false;             // the rays under way since the last frame are still wanted

  const StageDecision& operator[](Stage s) const { return stages[static_cast<std::size_t>(s)]; }
  StageDecision& operator[](Stage s) { return stages[static_cast<std::size_t>(s)]; }
};

FramePlan planFrame(const Facts& facts, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& caches);

} // namespace hrt
