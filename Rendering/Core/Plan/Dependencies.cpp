// See Dependencies.h.
#include "Rendering/Core/Plan/Dependencies.h"

#include <algorithm>

namespace hrt
{

namespace
{

bool anyLightMoved(const Changes& changes)
{
  return std::any_of(
    changes.lightMoved.begin(), changes.lightMoved.end(), [](bool moved) { return moved; });
}

} // namespace

Cause Dependencies::triangles() const
{
  return this->C.first ? "first frame" : this->C.geometry ? "geometry changed" : nullptr;
}

Cause Dependencies::placedTriangles() const
{
  const Cause cause = this->triangles();
  return cause ? cause : this->C.transforms ? "an actor moved" : nullptr;
}

Cause Dependencies::structure() const
{
  const Cause cause = this->placedTriangles();
  return cause ? cause : this->Settings.structure ? "another accelerator was chosen" : nullptr;
}

Cause Dependencies::shadowMap(std::size_t light) const
{
  if (const Cause cause = this->placedTriangles())
  {
    return cause;
  }
  if (this->C.lightCount)
  {
    return "the set of lights changed";
  }
  return this->C.lightMoved.at(light) ? "the light moved" : nullptr;
}

Cause Dependencies::visibility() const
{
  if (const Cause cause = this->placedTriangles())
  {
    return cause;
  }
  return this->C.camera ? "the camera changed"
    : this->C.culling   ? "face culling or a polygon offset changed"
    : this->Settings.bounds     ? "the pixel bounds changed"
    : this->Settings.visibility ? "the visibility setting changed"
                                : nullptr;
}

Cause Dependencies::shading() const
{
  return this->C.materials      ? "a material changed"
    : this->C.lightCount        ? "the set of lights changed"
    : anyLightMoved(this->C)    ? "a light moved"
    : this->C.lightColors       ? "a light's colour changed"
    : this->Settings.shading    ? "the shading or shadow settings changed"
                                : nullptr;
}

Cause Dependencies::primaryImage() const
{
  const Cause cause = this->visibility();
  return cause ? cause : this->shading();
}

Cause Dependencies::secondaryImage() const
{
  const Cause cause = this->primaryImage();
  return cause            ? cause
    : this->C.background ? "the background changed"
    : this->Settings.secondary ? "the reflection or refraction settings changed"
    : this->Settings.sampling  ? "the multisampling or interleaving settings changed"
                               : nullptr;
}

} // namespace hrt
