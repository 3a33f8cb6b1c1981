// See Animation.h.
#include "Rendering/OpenGL2/Animation.h"

#include "Rendering/OpenGL2/GLHeader.h"
#include "Rendering/Scene/vtkHybridScene.h"

#include "vtkActor2D.h"
#include "vtkCoordinate.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkProp.h"
#include "vtkRenderState.h"
#include "vtkRenderer.h"
#include "vtkRendererCollection.h"

#include <algorithm>
#include <string>

namespace hrt
{
namespace gl
{
namespace
{

// A caption or a label that follows a point of the world moves with the camera; a title does not.
bool movesWithTheView(vtkProp* prop)
{
  auto* flat = vtkActor2D::SafeDownCast(prop);
  if (!flat)
  {
    return true;
  }
  const auto inWorld = [](vtkCoordinate* coordinate) {
    return coordinate && coordinate->GetCoordinateSystem() == VTK_WORLD;
  };
  return inWorld(flat->GetPositionCoordinate()) || inWorld(flat->GetPosition2Coordinate());
}

bool othersDraw(const vtkRenderState* state, vtkHybridScene& scene)
{
  if (!scene.GetHostedActors().empty())
  {
    return true;
  }
  vtkProp** const props = state->GetPropArray();
  return std::any_of(props, props + state->GetPropArrayCount(), [&scene](vtkProp* prop) {
    return !scene.IsDrawnByTracer(prop) && movesWithTheView(prop);
  });
}

bool sharesCamera(vtkRenderer* renderer, vtkOpenGLRenderWindow* window)
{
  vtkRendererCollection* renderers = window->GetRenderers();
  vtkCollectionSimpleIterator at;
  renderers->InitTraversal(at);
  while (vtkRenderer* other = renderers->GetNextRenderer(at))
  {
    if (other != renderer && other->GetDraw() && other->IsActiveCameraCreated() &&
      other->GetActiveCamera() == renderer->GetActiveCamera())
    {
      return true;
    }
  }
  return false;
}

} // namespace

//------------------------------------------------------------------------------
FrameConditions frameConditionsOf(const vtkRenderState* state, vtkOpenGLRenderWindow* window,
  vtkHybridScene& scene, bool buffersWanted)
{
  FrameConditions around;
  around.animation = window->GetDesiredUpdateRate() >= kAnimationRate;
  around.stereo = window->GetStereoRender() != 0;
  around.othersDraw = othersDraw(state, scene);
  around.sharedCamera = sharesCamera(state->GetRenderer(), window);
  around.buffersWanted = buffersWanted;
  return around;
}

//------------------------------------------------------------------------------
bool isHardwareContext()
{
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string renderer = name ? name : "";
  for (const char* software : { "llvmpipe", "softpipe", "swrast", "SWR", "SwiftShader",
         "GDI Generic", "Software", "Microsoft Basic Render" })
  {
    if (renderer.find(software) != std::string::npos)
    {
      return false;
    }
  }
  return !renderer.empty();
}

} // namespace gl
} // namespace hrt
