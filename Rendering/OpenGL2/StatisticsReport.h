// The statistics that scripts read, as JSON. Numbers only of what happened: the reasons come from
// the frame plan.
#pragma once

#include "Rendering/OpenGL2/FrameStatistics.h"

#include "Rendering/Core/Snapshot.h"

#include <string>
#include <utility>
#include <vector>

namespace hrt
{
namespace gl
{

// `leftToVTK`: names of the actors that VTK draws itself, each with the reason.
std::string statisticsReport(const FrameStatistics& statistics, const Snapshot& snapshot,
  const std::vector<std::pair<std::string, std::string>>& leftToVTK);

} // namespace gl
} // namespace hrt
