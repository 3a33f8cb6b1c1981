// See Facts.h.
#include "Rendering/Core/Plan/Facts.h"

#include "Rendering/Core/Plan/PixelFrustum.h"

namespace hrt
{

Facts gatherFacts(const Snapshot& snapshot, const PixelBounds& bounds)
{
  Facts facts;
  const PixelFrustum frustum(snapshot.camera, bounds);
  for (const Part& part : snapshot.parts)
  {
    const bool seen = part.visibleToCamera && frustum.mayShow(part);
    facts.partInView.push_back(seen);
    facts.anyPartInView = facts.anyPartInView || seen;
    facts.mirrorInView = facts.mirrorInView || (seen && part.material.isMirror());
    facts.glassInView = facts.glassInView || (seen && part.material.isGlass());
    facts.features.textures =
      facts.features.textures || (seen && !part.material.textures.layers.empty());
    facts.features.physical = facts.features.physical || (seen && part.material.physical.used);
    facts.features.edges = facts.features.edges || (seen && part.showsEdges());
    facts.features.copies = facts.features.copies || (seen && part.copies);
    facts.anyCaster =
      facts.anyCaster || (part.castsShadowInMaps() && part.triangleCount() > 0);
  }
  for (const Light& light : snapshot.lights)
  {
    // From the eye itself no shadow is seen: whatever hides a point from the light hides it from
    // the camera too. The rays of a parallel projection do not start at one eye.
    const bool atEye = light.isHeadlight && light.kind == Light::Kind::Positional &&
      !snapshot.camera.parallel;
    facts.lightCanCast.push_back(light.castsShadows && !atEye);
  }
  return facts;
}

} // namespace hrt
