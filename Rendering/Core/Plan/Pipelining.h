// Whether a frame may be shown while the next one is traced (paper, section 3.3): each frame of an
// animation is then one late. Whatever must be of one frame with the picture, or must not be seen
// once it is gone, forbids it.
#pragma once

#include "Rendering/Core/Plan/Caches.h"
#include "Rendering/Core/Plan/Dependencies.h"
#include "Rendering/Core/Plan/Facts.h"
#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Plan/Stage.h"
#include "Rendering/Core/Snapshot.h"

namespace hrt
{

struct FramePlan;

// `plan`: the stages that would run without pipelining.
StageDecision planPipelining(const Facts& facts, const Settings& settings, const FramePlan& plan,
  const Changes& changes, const SettingsChanges& settingsChanges, const Dependencies& dependencies,
  const Caches& caches);

} // namespace hrt
