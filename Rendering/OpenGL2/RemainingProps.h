// Everything that the ray tracer does not draw itself, drawn by VTK in its usual order over our
// image and against our depth: opaque props left to VTK (lines, points, textured actors, ...),
// translucent geometry with depth peeling when asked for, volumes and overlays.
#pragma once

#include "Rendering/Core/PixelBounds.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <vector>

class vtkActor;
class vtkHiddenLineRemovalPass;
class vtkOpaquePass;
class vtkOpenGLFXAAFilter;
class vtkOpenGLState;
class vtkOverlayPass;
class vtkProp;
class vtkRenderPass;
class vtkRenderState;
class vtkRenderer;
class vtkTranslucentPass;
class vtkVolumetricPass;
class vtkWindow;

namespace hrt
{
namespace gl
{

class RemainingProps
{
public:
  RemainingProps();
  ~RemainingProps();

  // `traced` tells which props are already in the picture, `hosted` what is to be drawn besides the
  // renderer's props. Returns the number of props drawn.
  int draw(const vtkRenderState* state, const std::function<bool(vtkProp*)>& traced,
    const std::vector<vtkActor*>& hosted);

  void releaseGraphicsResources(vtkWindow* window);

  // Keeps what is drawn from now on within the bounds: around them, in a viewport of that origin and
  // size, the depth becomes the nearest there is; colours stay. VTK's passes set scissors of their own,
  // and depth peeling goes on for as long as any pixel of the viewport needs it: without our depth
  // there, pixels outside would make it peel otherwise than the whole frame does.
  static void closeOutside(
    vtkOpenGLState* state, const PixelBounds& bounds, const int origin[2], const int size[2]);

private:
  int drawTranslucent(const vtkRenderState& state, bool withVolumes);
  void forgetOtherSize(vtkRenderer* renderer);
  void forgetTranslucentPasses(vtkWindow* window);

  vtkNew<vtkOpaquePass> Opaque;
  vtkNew<vtkHiddenLineRemovalPass> HiddenLines; // in its place where the renderer asks for it
  vtkNew<vtkTranslucentPass> Translucent;
  vtkNew<vtkVolumetricPass> Volumetric;
  vtkNew<vtkOverlayPass> Overlay;
  int Size[2] = { 0, 0 }; // of the viewport that the translucent passes were made for
  vtkSmartPointer<vtkRenderPass> Peeling;
  vtkSmartPointer<vtkRenderPass> OrderIndependent;
  vtkSmartPointer<vtkOpenGLFXAAFilter> FXAA;
};

} // namespace gl
} // namespace hrt
