// Reads vtkCamera by the same calls as vtkOpenGLCamera::GetKeyMatrices.

#include "Rendering/Scene/CameraExtraction.h"

#include "Rendering/Scene/VTKConversions.h"

#include "vtkCamera.h"
#include "vtkRenderer.h"

namespace hrt
{
namespace scene
{
namespace
{

// OpenGL's clip space, as vtkOpenGLCamera asks for it.
constexpr double kClipNear = -1.0;
constexpr double kClipFar = 1.0;

//------------------------------------------------------------------------------
// A projection is parallel when the clip coordinate w does not depend on the point.
bool isParallel(const glm::dmat4& viewToClip)
{
  return viewToClip[0][3] == 0.0 && viewToClip[1][3] == 0.0 && viewToClip[2][3] == 0.0;
}

//------------------------------------------------------------------------------
// The view's y axis in the world: the camera's view-up made orthogonal to the line of sight.
glm::vec3 upward(const Camera& camera)
{
  const glm::dvec3 up(glm::inverse(camera.worldToView)[1]);
  const double length = glm::length(up);
  return isFinite(up) && length > 0.0 ? glm::vec3(up / length) : Background().up;
}

} // anonymous namespace

//------------------------------------------------------------------------------
Camera extractCamera(vtkRenderer* renderer, int width, int height)
{
  vtkCamera* source = renderer->GetActiveCamera();
  Camera camera;
  camera.worldToView = toMatrix(source->GetModelViewTransformMatrix());
  camera.viewToClip = toMatrix(
    source->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), kClipNear, kClipFar));
  camera.parallel = isParallel(camera.viewToClip);
  camera.width = width;
  camera.height = height;
  return camera;
}

//------------------------------------------------------------------------------
Background extractBackground(vtkRenderer* renderer, const Camera& camera)
{
  Background background;
  background.bottom = toColor(renderer->GetBackground());
  const bool gradient = renderer->GetGradientBackground() && !renderer->GetTexturedBackground();
  background.top = gradient ? toColor(renderer->GetBackground2()) : background.bottom;
  // Without a gradient the direction does not matter; left alone, it does not change with the
  // camera.
  if (background.top != background.bottom)
  {
    background.up = upward(camera);
  }
  return background;
}

} // namespace scene
} // namespace hrt
