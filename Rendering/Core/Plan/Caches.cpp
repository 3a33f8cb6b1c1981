// See Caches.h.
#include "Rendering/Core/Plan/Caches.h"

#include "Rendering/Core/Plan/Dependencies.h"
#include "Rendering/Core/Plan/FramePlan.h"

namespace hrt
{

Caches cachesAfter(const FramePlan& plan, const Settings& settings,
  const SettingsChanges& settingsChanges, const Changes& changes, const Caches& before)
{
  const Dependencies dependencies(changes, settingsChanges);
  const auto valid = [&plan](Stage stage, Cause outdated, bool cached) {
    return plan[stage].run || (cached && !outdated);
  };
  Caches after;
  after.geometryUploaded =
    valid(Stage::GeometryUpload, dependencies.triangles(), before.geometryUploaded);
  after.visibility = valid(Stage::Visibility, dependencies.visibility(), before.visibility);
  // Ids are on the host after a read-back or after primary rays, which need none.
  after.hostIds = plan[Stage::ReadBack].run ||
    (plan[Stage::Visibility].run ? !settings.rasterises()
                                 : before.hostIds && !dependencies.visibility());
  after.hostShadowMaps = plan[Stage::ShadowReadBack].run ||
    (before.hostShadowMaps && !plan[Stage::ShadowMaps].run);
  const bool whole = settings.shadesOnCPU();
  after.primaryImage = valid(Stage::PrimaryShading,
    whole ? dependencies.secondaryImage() : dependencies.primaryImage(), before.primaryImage);
  after.secondaryImage =
    valid(Stage::SecondaryRays, dependencies.secondaryImage(), before.secondaryImage);
  if (plan.pipelined.run)
  {
    (whole ? after.primaryImage : after.secondaryImage) = false;
  }
  after.tracing = plan.pipelined.run;
  after.previousPicture = plan[Stage::Blit].run;
  after.structure = valid(Stage::Structure, dependencies.structure(), before.structure);
  for (std::size_t light = 0; light < plan.shadowMaps.size(); ++light)
  {
    const bool cached = light < before.shadowMaps.size() && before.shadowMaps[light];
    after.shadowMaps.push_back(
      plan.shadowMaps[light].run || (cached && !dependencies.shadowMap(light)));
  }
  return after;
}

} // namespace hrt
