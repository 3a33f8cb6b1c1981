// See RemainingProps.h.
#include "Rendering/OpenGL2/RemainingProps.h"

#include "vtkDualDepthPeelingPass.h"
#include "vtkFrameBufferObjectBase.h"
#include "vtkOpaquePass.h"
#include "vtkOpenGLFXAAFilter.h"
#include "vtkOpenGLRenderer.h"
#include "vtkOrderIndependentTranslucentPass.h"
#include "vtkOverlayPass.h"
#include "vtkProp.h"
#include "vtkRenderState.h"
#include "vtkTranslucentPass.h"
#include "vtkVolumetricPass.h"

namespace hrt
{
namespace gl
{
namespace
{

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
int RemainingProps::draw(
  const vtkRenderState* state, const std::function<bool(vtkProp*)>& traced)
{
  vtkRenderer* renderer = state->GetRenderer();
  std::vector<vtkProp*> all(
    state->GetPropArray(), state->GetPropArray() + state->GetPropArrayCount());
  std::vector<vtkProp*> left;
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
  this->Opaque->Render(&rest);
  drawn += this->Opaque->GetNumberOfRenderedProps();
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
int RemainingProps::drawTranslucent(const vtkRenderState& state, bool withVolumes)
{
  vtkRenderer* renderer = state.GetRenderer();
  vtkRenderPass* pass = nullptr;
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
void RemainingProps::releaseGraphicsResources(vtkWindow* window)
{
  this->Opaque->ReleaseGraphicsResources(window);
  this->Translucent->ReleaseGraphicsResources(window);
  this->Volumetric->ReleaseGraphicsResources(window);
  this->Overlay->ReleaseGraphicsResources(window);
  if (this->Peeling)
  {
    this->Peeling->ReleaseGraphicsResources(window);
  }
  if (this->OrderIndependent)
  {
    this->OrderIndependent->ReleaseGraphicsResources(window);
  }
  if (this->FXAA)
  {
    this->FXAA->ReleaseGraphicsResources();
  }
}

} // namespace gl
} // namespace hrt
