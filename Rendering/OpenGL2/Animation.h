// What the frame plan has to know about the surroundings of a frame before it may be pipelined: whether
// more frames follow, and whether anything else is drawn that would no longer fit to a picture shown
// one frame late.
#pragma once

#include "Rendering/Core/Plan/Facts.h"

class vtkHybridScene;
class vtkOpenGLRenderWindow;
class vtkRenderState;

namespace hrt
{
namespace gl
{

// Frames per second that a window must ask for at least for its frames to be an animation. VTK's
// interactor styles ask for 15 while they move something and for 0.0001 otherwise, which is also a
// window's default; one frame a second parts the two.
inline constexpr double kAnimationRate = 1.0;

FrameConditions frameConditionsOf(const vtkRenderState* state, vtkOpenGLRenderWindow* window,
  vtkHybridScene& scene, bool buffersWanted);

// Whether the current context is a graphics card's. By the renderer's name: those of Mesa's software
// rasterisers, of SwiftShader and of Windows' and Apple's own are known.
bool isHardwareContext();

} // namespace gl
} // namespace hrt
