// See RemainingProps.h.
#include "Rendering/OpenGL2/RemainingProps.h"

#include "Rendering/OpenGL2/GLHeader.h"

#include "vtkActor.h"
#include "vtkDualDepthPeelingPass.h"
#include "vtkFrameBufferObjectBase.h"
#include "vtkHiddenLineRemovalPass.h"
#include "vtkOpaquePass.h"
#include "vtkOpenGLFXAAFilter.h"
#include "vtkOpenGLRenderer.h"
#include "vtkOpenGLState.h"
#include "vtkOrderIndependentTranslucentPass.h"
#include "vtkOverlayPass.h"
#include "vtkProp.h"
#include "vtkRenderState.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTranslucentPass.h"
#include "vtkVolumetricPass.h"

#include <algorithm>

namespace hrt
{
namespace gl
{
namespace
{

// The renderer's count of the props that it has drawn in this frame, which vtkRenderer keeps as it
// draws its geometry by itself; with a pass nobody does.
class PropsRendered : public vtkRenderer
{
public:
  static void set(vtkRenderer* renderer, int count)
  {
    renderer->*(&PropsRendered::NumberOfPropsRendered) = count;
  }
};

bool anyTranslucent(const vtkRenderState& state)
{
  for (int i = 0; i < state.GetPropArrayCount(); ++i)
  {
    if (state.GetPropArray()[i]->HasTranslucentPolygonalGeometry())
    {
      return true;
    }
  }
  return false;
}

} // namespace

//------------------------------------------------------------------------------
RemainingProps::RemainingProps() = default;

//------------------------------------------------------------------------------
RemainingProps::~RemainingProps() = default;

//------------------------------------------------------------------------------
int RemainingProps::draw(const vtkRenderState* state,
  const std::function<bool(vtkProp*)>& traced, const std::vector<vtkActor*>& hosted)
{
  vtkRenderer* renderer = state->GetRenderer();
  std::vector<vtkProp*> all(
    state->GetPropArray(), state->GetPropArray() + state->GetPropArrayCount());
  std::vector<vtkProp*> left(hosted.begin(), hosted.end());
  for (vtkProp* prop : all)
  {
    if (!traced(prop))
    {
      left.push_back(prop);
    }
  }
  vtkRenderState rest(renderer);
  rest.SetFrameBuffer(state->GetFrameBuffer());
  rest.SetRequiredKeys(state->GetRequiredKeys());
  rest.SetPropArrayAndCount(left.data(), static_cast<int>(left.size()));

  int drawn = 0;
  // As vtkOpenGLRenderer decides it. Wireframes are hidden by each other's faces then, and by what is
  // traced anyway.
  const bool hidesLines = renderer->GetUseHiddenLineRemoval() &&
    vtkHiddenLineRemovalPass::WireframePropsExist(left.data(), static_cast<int>(left.size()));
  vtkRenderPass* opaque = this->Opaque;
  if (hidesLines)
  {
    opaque = this->HiddenLines;
  }
  opaque->Render(&rest);
  drawn += opaque->GetNumberOfRenderedProps();
  const bool translucent = anyTranslucent(rest);
  // As vtkOpenGLRenderer decides it: then the peeling pass draws the volumes too.
  const bool peelsVolumes = translucent && renderer->GetUseDepthPeeling() &&
    renderer->GetUseDepthPeelingForVolumes();
  drawn += translucent ? this->drawTranslucent(rest, peelsVolumes) : 0;

  if (renderer->GetUseFXAA())
  {
    // Before volumes and overlays, as vtkOpenGLRenderer orders it.
    if (!this->FXAA)
    {
      this->FXAA = vtkSmartPointer<vtkOpenGLFXAAFilter>::New();
    }
    if (renderer->GetFXAAOptions())
    {
      this->FXAA->UpdateConfiguration(renderer->GetFXAAOptions());
    }
    this->FXAA->Execute(static_cast<vtkOpenGLRenderer*>(renderer));
  }

  if (!peelsVolumes)
  {
    // Volume mappers on the CPU hide what lies behind the picture's depth only where the renderer says
    // that something has been drawn.
    PropsRendered::set(renderer, static_cast<int>(all.size()));
    this->Volumetric->Render(&rest);
    drawn += this->Volumetric->GetNumberOfRenderedProps();
  }

  // A traced actor may still have an overlay part, so that all props take part here.
  vtkRenderState overlays(renderer);
  overlays.SetFrameBuffer(state->GetFrameBuffer());
  overlays.SetRequiredKeys(state->GetRequiredKeys());
  overlays.SetPropArrayAndCount(all.data(), static_cast<int>(all.size()));
  this->Overlay->Render(&overlays);
  drawn += this->Overlay->GetNumberOfRenderedProps();
  return drawn;
}

//------------------------------------------------------------------------------
void RemainingProps::closeOutside(
  vtkOpenGLState* state, const PixelBounds& bounds, const int origin[2], const int size[2])
{
  if (bounds == PixelBounds().within(size[0], size[1]))
  {
    return;
  }
  const PixelBounds around[4] = { { 0, size[0], 0, bounds.y0 },
    { 0, size[0], bounds.y1, size[1] }, { 0, bounds.x0, bounds.y0, bounds.y1 },
    { bounds.x1, size[0], bounds.y0, bounds.y1 } };
  vtkOpenGLState::ScopedglEnableDisable scissorTest(state, GL_SCISSOR_TEST);
  vtkOpenGLState::ScopedglScissor scissor(state);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  GLdouble before = 1.0;
  glGetDoublev(GL_DEPTH_CLEAR_VALUE, &before);
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglClearDepth(0.0);
  for (const PixelBounds& side : around)
  {
    state->vtkglScissor(origin[0] + side.x0, origin[1] + side.y0, side.width(), side.height());
    state->vtkglClear(GL_DEPTH_BUFFER_BIT);
  }
  state->vtkglClearDepth(before);
}

//------------------------------------------------------------------------------
int RemainingProps::drawTranslucent(const vtkRenderState& state, bool withVolumes)
{
  vtkRenderer* renderer = state.GetRenderer();
  vtkRenderPass* pass = nullptr;
  this->forgetOtherSize(renderer);
  if (renderer->GetUseDepthPeeling())
  {
    if (!this->Peeling)
    {
      this->Peeling = vtkSmartPointer<vtkDualDepthPeelingPass>::New();
    }
    auto* peeling = static_cast<vtkDualDepthPeelingPass*>(this->Peeling.GetPointer());
    peeling->SetTranslucentPass(this->Translucent);
    peeling->SetVolumetricPass(withVolumes ? this->Volumetric.GetPointer() : nullptr);
    peeling->SetMaximumNumberOfPeels(renderer->GetMaximumNumberOfPeels());
    peeling->SetOcclusionRatio(renderer->GetOcclusionRatio());
    pass = peeling;
  }
  else
  {
    if (!this->OrderIndependent)
    {
      this->OrderIndependent = vtkSmartPointer<vtkOrderIndependentTranslucentPass>::New();
    }
    auto* blended =
      static_cast<vtkOrderIndependentTranslucentPass*>(this->OrderIndependent.GetPointer());
    blended->SetTranslucentPass(this->Translucent);
    pass = blended;
  }
  pass->Render(&state);
  return pass->GetNumberOfRenderedProps();
}

//------------------------------------------------------------------------------
void RemainingProps::forgetOtherSize(vtkRenderer* renderer)
{
  int size[2], origin[2];
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
  if (this->Size[0] != size[0] || this->Size[1] != size[1])
  {
    std::copy(size, size + 2, this->Size);
    this->forgetTranslucentPasses(renderer->GetRenderWindow());
  }
}

//------------------------------------------------------------------------------
// VTK's translucent passes reuse their texture objects, and then in another precision than new ones:
// the picture would depend on what the window has been through.
void RemainingProps::forgetTranslucentPasses(vtkWindow* window)
{
  for (vtkSmartPointer<vtkRenderPass>* pass : { &this->Peeling, &this->OrderIndependent })
  {
    if (*pass)
    {
      (*pass)->ReleaseGraphicsResources(window);
      *pass = nullptr;
    }
  }
}

//------------------------------------------------------------------------------
void RemainingProps::releaseGraphicsResources(vtkWindow* window)
{
  this->forgetTranslucentPasses(window);
  this->Opaque->ReleaseGraphicsResources(window);
  this->HiddenLines->ReleaseGraphicsResources(window);
  this->Translucent->ReleaseGraphicsResources(window);
  this->Volumetric->ReleaseGraphicsResources(window);
  this->Overlay->ReleaseGraphicsResources(window);
  if (this->FXAA)
  {
    this->FXAA->ReleaseGraphicsResources();
  }
}

} // namespace gl
} // namespace hrt
