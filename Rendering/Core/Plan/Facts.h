// What a scene and its surroundings hold, as far as a frame's plan depends on it: a few values that
// a test can write down, gathered once a frame from the whole snapshot.
#pragma once

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Snapshot.h"

#include <vector>

namespace hrt
{

// What surrounds a frame, as far as pipelining needs to know.
struct FrameConditions
{
  bool animation = false;     // more frames follow soon; the window asks for an interactive rate
  bool stereo = false;        // the next frame is the other eye's
  bool othersDraw = false;    // VTK draws props of its own at this frame's view
  bool sharedCamera = false;  // so does another renderer of the window
  bool buffersWanted = false; // the user asks for this frame's buffers
};

// What shading has to know of beside plain colours.
struct SurfaceFeatures
{
  bool textures = false;
  bool edges = false;
  bool physical = false;
  bool copies = false; // see Copies.h
};

// What the scene holds, as far as the plan needs to know.
struct Facts
{
  FrameConditions conditions;
  // Per part: the camera sees it and it meets the view frustum of the pixel bounds.
  std::vector<bool> partInView;
  bool anyPartInView = false;
  bool mirrorInView = false;          // same, for a part with reflectance
  bool glassInView = false;           // same, for a part of glass
  SurfaceFeatures features;           // of the parts in view
  bool anyCaster = false;
  std::vector<bool> lightCanCast;     // per light: false where it casts none, or none that is seen
};

// Gathers the facts of a snapshot; `lightCanCast` included.
Facts gatherFacts(const Snapshot& snapshot, const PixelBounds& bounds = {});

} // namespace hrt
