// See Settings.h.
#include "Rendering/Core/Plan/Settings.h"

namespace hrt
{

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

} // namespace hrt
