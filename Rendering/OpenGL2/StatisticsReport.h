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

// Names of props that VTK draws itself, each with the reason.
using PropReasons = std::vector<std::pair<std::string, std::string>>;

// `leftToVTK`: surfaces that are not traced; `hosted`: what VTK draws by its nature.
std::string statisticsReport(const FrameStatistics& statistics, const Snapshot& snapshot,
  const PropReasons& leftToVTK, const PropReasons& hosted);

} // namespace gl
} // namespace hrt
