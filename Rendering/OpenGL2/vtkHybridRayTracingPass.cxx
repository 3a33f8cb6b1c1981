// The VTK face of the module: settings, the order of a frame, and what VTK expects of a render pass.
// The work is done by vtkHybridScene (what there is to draw), hrt::planFrame (what has to be done)
// and hrt::gl::FrameRenderer (doing it).
#include "vtkHybridRayTracingPass.h"

#include "Rendering/OpenGL2/Animation.h"
#include "Rendering/OpenGL2/CompositeMappers.h"
#include "Rendering/OpenGL2/FrameRenderer.h"
#include "Rendering/OpenGL2/RemainingProps.h"
#include "Rendering/OpenGL2/StatisticsReport.h"
#include "Rendering/OpenGL2/UserBuffers.h"
#include "Rendering/Scene/vtkHybridScene.h"

#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkProp.h"
#include "vtkPropCollection.h"
#include "vtkRenderState.h"
#include "vtkRenderer.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

vtkStandardNewMacro(vtkHybridRayTracingPass);

namespace
{

// The values of each choice, from 0 on, by the names that its setters have.
using Names = std::vector<const char*>;
const Names kVisibilities{ "ItemBuffer", "DirectRendering", "RayCasting" };
const Names kShadings{ "GPU", "CPU" };
const Names kAccelerators{ "Embree", "KdTree" };
const Names kShadowModes{ "Off", "ShadowMaps", "Exact" };
const Names kPipelined{ "Never", "InAnimations", "Automatic" };
const Names kMultisampling{ "Off", "Clamp", "Lazy3x3", "Lazy5x5", "Full3x3", "Full5x5" };

// Sets a choice, or says what there is to choose from. Returns whether it has changed.
bool choose(vtkObject* pass, const char* setter, const Names& names, int value, int& setting)
{
  if (value < 0 || value >= static_cast<int>(names.size()))
  {
    std::string all;
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      all += std::string(i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i] + " (" +
        std::to_string(i) + ")";
    }
    vtkErrorWithObjectMacro(pass, << setter << ": " << value << " is none of " << all);
    return false;
  }
  if (setting == value)
  {
    return false;
  }
  setting = value;
  pass->Modified();
  return true;
}

} // namespace

//------------------------------------------------------------------------------
class vtkHybridRayTracingPass::vtkInternals
{
public:
  // Makes the GL side for a window, anew when its context is another one than last time.
  hrt::gl::FrameRenderer& Frame(vtkOpenGLRenderWindow* window)
  {
    if (this->Renderer && !this->Renderer->pool().belongsToCurrentContextOf(window))
    {
      this->Renderer.reset();
    }
    if (!this->Renderer)
    {
      this->Renderer = std::make_unique<hrt::gl::FrameRenderer>(window);
    }
    return *this->Renderer;
  }

  vtkNew<vtkHybridScene> Scene;
  std::unique_ptr<hrt::gl::FrameRenderer> Renderer;
  hrt::gl::RemainingProps Remaining;
  hrt::gl::UserBuffers Buffers;
  // Of the last frame, for whoever asks; no snapshot: there is none.
  hrt::gl::FrameStatistics Statistics;
  std::shared_ptr<const hrt::Snapshot> Snapshot;
  vtkWeakPointer<vtkRenderer> LastRenderer;
  bool WarnedOfMultisampling = false; // since it was set
};

//------------------------------------------------------------------------------
vtkHybridRayTracingPass::vtkHybridRayTracingPass()
  : Internals(new vtkInternals)
{
  hrt::gl::registerCompositeMappers();
}

//------------------------------------------------------------------------------
vtkHybridRayTracingPass::~vtkHybridRayTracingPass() = default;

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Visibility: " << kVisibilities[this->Visibility] << "\n";
  os << indent << "PrimaryShading: " << kShadings[this->PrimaryShading] << "\n";
  os << indent << "Accelerator: " << kAccelerators[this->Accelerator] << "\n";
  os << indent << "ShadowMode: " << kShadowModes[this->ShadowMode] << "\n";
  os << indent << "HeadlightShadows: " << (this->HeadlightShadows ? "On" : "Off") << "\n";
  os << indent << "ShadowMapResolution: " << this->ShadowMapResolution << "\n";
  os << indent << "Reflections: " << (this->Reflections ? "On" : "Off") << "\n";
  os << indent << "Refractions: " << (this->Refractions ? "On" : "Off") << "\n";
  os << indent << "MaximumDepth: " << this->MaximumDepth << "\n";
  os << indent << "Pipelined: " << kPipelined[this->Pipelined] << "\n";
  os << indent << "Multisampling: " << kMultisampling[this->Multisampling] << "\n";
  os << indent << "Interleave: " << this->Interleave << "\n";
  os << indent << "InterleaveErrorControl: " << (this->InterleaveErrorControl ? "On" : "Off")
     << "\n";
  os << indent << "PixelBounds: " << this->PixelBounds[0] << " " << this->PixelBounds[1] << " "
     << this->PixelBounds[2] << " " << this->PixelBounds[3] << "\n";
  os << indent << "Buffers:";
  for (const std::string& name : this->Internals->Buffers.names())
  {
    os << " " << name;
  }
  os << "\n";
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetVisibility(int visibility)
{
  choose(this, "SetVisibility", kVisibilities, visibility, this->Visibility);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetPrimaryShading(int shading)
{
  choose(this, "SetPrimaryShading", kShadings, shading, this->PrimaryShading);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetAccelerator(int accelerator)
{
  choose(this, "SetAccelerator", kAccelerators, accelerator, this->Accelerator);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetShadowMode(int mode)
{
  choose(this, "SetShadowMode", kShadowModes, mode, this->ShadowMode);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetPipelined(int pipelined)
{
  choose(this, "SetPipelined", kPipelined, pipelined, this->Pipelined);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetMultisampling(int mode)
{
  if (choose(this, "SetMultisampling", kMultisampling, mode, this->Multisampling))
  {
    this->Internals->WarnedOfMultisampling = false;
  }
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetPixelBounds(int x0, int x1, int y0, int y1)
{
  const int bounds[4] = { x0, x1, y0, y1 };
  if (!std::equal(bounds, bounds + 4, this->PixelBounds))
  {
    std::copy_n(bounds, 4, this->PixelBounds);
    // Where the new bounds show nothing no stage runs that would outdate the buffers.
    this->Internals->Buffers.invalidate();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetPixelBounds(const int bounds[4])
{
  this->SetPixelBounds(bounds[0], bounds[1], bounds[2], bounds[3]);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetBuffers(const std::vector<std::string>& names)
{
  const std::vector<std::string>& known = hrt::gl::UserBuffers::knownNames();
  std::vector<std::string> wanted;
  for (const std::string& name : names)
  {
    if (std::find(known.begin(), known.end(), name) == known.end())
    {
      std::string all;
      for (const std::string& k : known)
      {
        all += (all.empty() ? "" : ", ") + k;
      }
      vtkErrorMacro("SetBuffers: there is no buffer \"" << name << "\"; the buffers are " << all);
      return;
    }
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end())
    {
      wanted.push_back(name);
    }
  }
  if (wanted != this->Internals->Buffers.names())
  {
    this->Internals->Buffers.setNames(wanted);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::SetBuffers(const char* name)
{
  const std::string text = name ? name : "";
  vtkErrorMacro("SetBuffers takes a list of names and got the string \"" << text
    << "\"; for one buffer give a list of one, [\"" << text << "\"]");
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkHybridRayTracingPass::GetBuffers()
{
  return this->Internals->Buffers.names();
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkHybridRayTracingPass::GetKnownBuffers()
{
  return hrt::gl::UserBuffers::knownNames();
}

//------------------------------------------------------------------------------
vtkImageData* vtkHybridRayTracingPass::GetBuffer(const char* name)
{
  const std::string wanted = name ? name : "";
  const auto& names = this->Internals->Buffers.names();
  if (std::find(names.begin(), names.end(), wanted) == names.end())
  {
    vtkErrorMacro("GetBuffer: \"" << wanted << "\" was not asked for with SetBuffers");
    return nullptr;
  }
  vtkImageData* image = this->Internals->Buffers.image(wanted);
  if (!image)
  {
    vtkErrorMacro("GetBuffer: \"" << wanted << "\" has not been rendered yet");
  }
  return image;
}

//------------------------------------------------------------------------------
vtkProp* vtkHybridRayTracingPass::GetPropFromId(vtkIdType id)
{
  return id < 0 ? nullptr : this->Internals->Scene->GetProp(static_cast<std::size_t>(id));
}

//------------------------------------------------------------------------------
std::string vtkHybridRayTracingPass::GetStatistics()
{
  vtkInternals& in = *this->Internals;
  if (!in.Snapshot)
  {
    return "{}";
  }
  hrt::gl::PropReasons left, hosted;
  const auto tell = [&](vtkProp* prop, int place) {
    const std::string reason = in.Scene->GetReasonLeftToVTK(prop);
    if (!reason.empty())
    {
      // By its place among the renderer's view props, which a script can look up.
      (in.Scene->IsHosted(prop) ? hosted : left)
        .emplace_back(std::string(prop->GetClassName()) + " #" + std::to_string(place), reason);
    }
  };
  if (in.LastRenderer)
  {
    vtkPropCollection* props = in.LastRenderer->GetViewProps();
    vtkCollectionSimpleIterator at;
    props->InitTraversal(at);
    int place = 0;
    while (vtkProp* prop = props->GetNextProp(at))
    {
      tell(prop, place++);
    }
  }
  return hrt::gl::statisticsReport(in.Statistics, *in.Snapshot, left, hosted);
}

//------------------------------------------------------------------------------
int vtkHybridRayTracingPass::GetNumberOfOpenGLObjects()
{
  return this->Internals->Renderer
    ? static_cast<int>(this->Internals->Renderer->pool().size())
    : 0;
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Internals->Remaining.releaseGraphicsResources(window);
  // A pass may be told about a window that it never drew to.
  if (this->Internals->Renderer && this->Internals->Renderer->pool().window() == window)
  {
    this->Internals->Renderer.reset();
  }
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::Render(const vtkRenderState* s)
{
  this->NumberOfRenderedProps = 0;
  vtkRenderer* renderer = s->GetRenderer();
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window)
  {
    vtkErrorMacro("the renderer has no OpenGL render window");
    return;
  }
  auto* framebuffer = vtkOpenGLFramebufferObject::SafeDownCast(s->GetFrameBuffer());
  if (!framebuffer)
  {
    int size[2], origin[2];
    this->UpdateCamera(renderer);
    renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
    this->RenderPicture(s, window, size, origin);
    return;
  }
  // Another pass has made us its delegate and wants its own framebuffer filled, as vtkCameraPass
  // would do it.
  int size[2];
  const int origin[2] = { 0, 0 };
  framebuffer->GetLastSize(size);
  vtkOpenGLState* state = window->GetState();
  vtkOpenGLState::ScopedglViewport viewport(state);
  vtkOpenGLState::ScopedglScissor scissor(state);
  vtkOpenGLState::ScopedglEnableDisable scissorTest(state, GL_SCISSOR_TEST);
  state->vtkglViewport(0, 0, size[0], size[1]);
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->vtkglScissor(0, 0, size[0], size[1]);
  if (window->GetErase() && renderer->GetErase())
  {
    renderer->Clear();
  }
  this->RenderPicture(s, window, size, origin);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::RenderPicture(const vtkRenderState* s,
  vtkOpenGLRenderWindow* window, const int size[2], const int origin[2])
{
  vtkRenderer* renderer = s->GetRenderer();
  this->UpdateLightGeometry(renderer);
  this->UpdateLights(renderer);
  if (renderer->GetSelector())
  {
    // The selector draws props by its own rules; our picture would overwrite its ids.
    this->UpdateGeometry(renderer, s->GetFrameBuffer());
    this->NumberOfRenderedProps = s->GetPropArrayCount();
    return;
  }
  if (size[0] <= 0 || size[1] <= 0)
  {
    return;
  }
  this->DrainErrors(false);
  std::string error;
  try
  {
    error = this->TraceFrame(s, window, size, origin);
  }
  catch (const std::exception& exception)
  {
    // Not even for want of memory may an exception cross VTK.
    error = exception.what();
    this->Internals->Renderer.reset();
  }
  if (!error.empty())
  {
    vtkErrorMacro("the frame is drawn by VTK alone: " << error);
    this->Internals->Snapshot = nullptr;
    this->UpdateGeometry(renderer, s->GetFrameBuffer());
    this->NumberOfRenderedProps = s->GetPropArrayCount();
    return;
  }
  hrt::gl::RemainingProps::closeOutside(
    window->GetState(), this->BoundsWithin(size), origin, size);
  vtkHybridScene* scene = this->Internals->Scene;
  const auto isTraced = [scene](vtkProp* prop) { return scene->IsDrawnByTracer(prop); };
  this->NumberOfRenderedProps =
    static_cast<int>(std::count_if(
      s->GetPropArray(), s->GetPropArray() + s->GetPropArrayCount(), isTraced)) +
    this->Internals->Remaining.draw(s, isTraced, scene->GetHostedActors());
  this->DrainErrors(true);
}

//------------------------------------------------------------------------------
void vtkHybridRayTracingPass::DrainErrors(bool own)
{
  // OpenGL keeps one error of each kind; a lost context would report one for ever.
  constexpr int kMostErrors = 16;
  for (int i = 0; i < kMostErrors; ++i)
  {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR)
    {
      return;
    }
    if (own)
    {
      char number[16];
      std::snprintf(number, sizeof(number), "0x%04x", static_cast<unsigned int>(error));
      vtkErrorMacro("OpenGL reported error " << number);
    }
  }
}

//------------------------------------------------------------------------------
hrt::PixelBounds vtkHybridRayTracingPass::BoundsWithin(const int size[2]) const
{
  const int* b = this->PixelBounds;
  return hrt::PixelBounds{ b[0], b[1], b[2], b[3] }.within(size[0], size[1]);
}

//------------------------------------------------------------------------------
std::string vtkHybridRayTracingPass::TraceFrame(const vtkRenderState* s,
  vtkOpenGLRenderWindow* window, const int size[2], const int origin[2])
{
  vtkInternals& in = *this->Internals;
  vtkRenderer* renderer = s->GetRenderer();
  in.Scene->SetHeadlightShadows(this->HeadlightShadows);
  in.Scene->Update(renderer, size[0], size[1]);
  const std::shared_ptr<const hrt::Snapshot> snapshot = in.Scene->GetSnapshot();

  hrt::Settings settings;
  settings.visibility = this->Visibility == RayCasting ? hrt::Visibility::RayCasting
    : this->Visibility == DirectRendering              ? hrt::Visibility::DirectRendering
                                                       : hrt::Visibility::ItemBuffer;
  settings.primaryShading =
    this->PrimaryShading == CPU ? hrt::PrimaryShading::CPU : hrt::PrimaryShading::GPU;
  settings.accelerator =
    this->Accelerator == KdTree ? hrt::Accelerator::KdTree : hrt::Accelerator::Embree;
  settings.shadows = this->ShadowMode == ShadowsOff ? hrt::ShadowMode::Off
    : this->ShadowMode == Exact                      ? hrt::ShadowMode::Exact
                                                     : hrt::ShadowMode::ShadowMaps;
  settings.shadowMapResolution = this->ShadowMapResolution;
  settings.reflections = this->Reflections;
  settings.refractions = this->Refractions;
  settings.maximumDepth = this->MaximumDepth;
  settings.multisampling = static_cast<hrt::Multisampling>(this->Multisampling);
  settings.interleave = this->Interleave;
  settings.interleaveErrorControl = this->InterleaveErrorControl;
  if (settings.usedMultisampling() != hrt::Multisampling::Clamp &&
    !settings.shadesOnCPU() && !in.WarnedOfMultisampling)
  {
    in.WarnedOfMultisampling = true;
    vtkWarningMacro("Multisampling has no effect on what the GPU shades, which always clamps; it "
                    "holds for what the CPU traces (SetPrimaryShadingToCPU)");
  }
  settings.setBounds(this->BoundsWithin(size), size[0], size[1]);

  hrt::gl::FrameRenderer& frame = in.Frame(window);
  settings.pipelined = this->Pipelined == PipelinedInAnimations ||
    (this->Pipelined == PipelinedAutomatic && frame.onHardware());
  const hrt::FrameConditions conditions =
    hrt::gl::frameConditionsOf(s, window, *in.Scene, !in.Buffers.names().empty());
  const std::string error = frame.render(
    snapshot, in.Scene->GetChanges(), settings, conditions, origin[0], origin[1]);
  if (!error.empty())
  {
    return error;
  }
  if (!in.Buffers.names().empty())
  {
    // Any stage that ran may have changed what they show.
    if (frame.statistics().plan[hrt::Stage::PrimaryShading].run || in.Scene->GetChanges().any())
    {
      in.Buffers.invalidate();
    }
    const std::string missing =
      in.Buffers.current() ? std::string() : in.Buffers.update(frame, *snapshot);
    if (!missing.empty())
    {
      vtkErrorMacro("the buffers are not available: " << missing);
    }
  }
  in.Statistics = frame.statistics();
  in.Snapshot = snapshot;
  in.LastRenderer = renderer;
  return {};
}
