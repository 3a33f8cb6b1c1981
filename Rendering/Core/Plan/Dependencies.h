// What each stage's result depends on, written once: a frame is planned by it, and by it is told what
// is still valid after the frame. Two such lists would drift apart, and a result that the one
// forgets to renew the other would take for valid.
#pragma once

#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Snapshot.h"

#include <cstddef>

namespace hrt
{

// Why a result is out of date; null when it is not.
using Cause = const char*;

// Both must outlive it.
class Dependencies
{
public:
  Dependencies(const Changes& changes, const SettingsChanges& settings)
    : C(changes)
    , Settings(settings)
  {
  }

  Cause triangles() const;
  Cause placedTriangles() const;
  Cause structure() const;
  Cause shadowMap(std::size_t light) const;
  Cause visibility() const;
  // What shading depends on beside the visible triangles.
  Cause shading() const;
  Cause primaryImage() const;
  // What rays beyond the first hit see.
  Cause secondaryImage() const;

private:
  const Changes& C;
  const SettingsChanges& Settings;
};

} // namespace hrt
