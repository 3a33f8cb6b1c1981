// The two words that the rules of the plan are written in.
#pragma once

#include "Rendering/Core/Plan/Stage.h"

namespace hrt
{

inline StageDecision run(const char* reason)
{
  return { true, reason };
}

inline StageDecision skip(const char* reason)
{
  return { false, reason };
}

} // namespace hrt
