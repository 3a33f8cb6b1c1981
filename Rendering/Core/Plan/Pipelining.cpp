// See Pipelining.h.
#include "Rendering/Core/Plan/Pipelining.h"

#include "Rendering/Core/Plan/Decision.h"
#include "Rendering/Core/Plan/FramePlan.h"

namespace hrt
{

StageDecision planPipelining(const Facts& facts, const Settings& settings, const FramePlan& plan,
  const Changes& changes, const SettingsChanges& settingsChanges, const Dependencies& dependencies,
  const Caches& caches)
{
  const FrameConditions& around = facts.conditions;
  const Stage traced = settings.shadesOnCPU() ? Stage::PrimaryShading : Stage::SecondaryRays;
  return !settings.pipelined ? skip("pipelining is off")
    : !settings.rasterises() ? skip("primary rays are traced at once")
    : !plan[traced].run      ? skip("no rays are traced")
    : !around.animation      ? skip("no interactive update rate is asked for")
    : changes.first || changes.geometry ? skip("what is gone must not be shown")
    : settingsChanges.bounds  ? skip("the frame before shows other pixels")
    : !caches.previousPicture ? skip("there is no frame before to be shown")
    : !plan[Stage::Visibility].run && !dependencies.secondaryImage()
    ? skip("nothing changed: the frame is finished")
    : around.stereo        ? skip("the next frame is the other eye's")
    : around.othersDraw    ? skip("VTK draws props into this frame")
    : around.sharedCamera  ? skip("another renderer shows the same view")
    : around.buffersWanted ? skip("buffers of this frame are wanted")
                           : run("an animation");
}

} // namespace hrt
