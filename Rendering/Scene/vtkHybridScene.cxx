// The VTK face of the scene: keeps the last frame, tells what differs from the one before, and
// passes on to VTK what went wrong. The reading itself is hrt::scene::SceneReader's. A new frame
// replaces the last one only when it is complete.

#include "vtkHybridScene.h"

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/SceneReader.h"

#include "vtkObjectFactory.h"
#include "vtkRenderer.h"
#include "vtkWeakPointer.h"

#include <exception>
#include <utility>

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkHybridScene);

using namespace hrt::scene;

//------------------------------------------------------------------------------
class vtkHybridScene::vtkInternals
{
public:
  Frame Current;
  hrt::Changes Changes;
  vtkWeakPointer<vtkRenderer> LastRenderer;
  SceneReader Reader;
  ReaderSettings Settings;

  SceneReader::Messages Update(vtkRenderer* renderer, int width, int height);
};

//------------------------------------------------------------------------------
SceneReader::Messages vtkHybridScene::vtkInternals::Update(
  vtkRenderer* renderer, int width, int height)
{
  Frame frame = this->Reader.read(renderer, width, height, this->Settings);
  const bool sameRenderer = this->LastRenderer == renderer;
  this->Changes =
    hrt::compareSnapshots(sameRenderer ? this->Current.snapshot.get() : nullptr, *frame.snapshot);
  this->Current = std::move(frame);
  this->LastRenderer = renderer;
  return this->Reader.endFrame();
}

//------------------------------------------------------------------------------
vtkHybridScene::vtkHybridScene()
  : Internals(new vtkInternals)
{
}

//------------------------------------------------------------------------------
vtkHybridScene::~vtkHybridScene() = default;

//------------------------------------------------------------------------------
void vtkHybridScene::Update(vtkRenderer* renderer)
{
  int width = 0, height = 0, left = 0, bottom = 0;
  if (renderer)
  {
    renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  }
  this->Update(renderer, width, height);
}

//------------------------------------------------------------------------------
void vtkHybridScene::Update(vtkRenderer* renderer, int width, int height)
{
  if (!renderer)
  {
    vtkErrorMacro("Update needs a renderer.");
    return;
  }
  // No exception may cross VTK, which is not written to survive one.
  try
  {
    const SceneReader::Messages messages = this->Internals->Update(renderer, width, height);
    if (!messages.warnings.empty())
    {
      vtkWarningMacro(<< messages.warnings);
    }
    if (!messages.errors.empty())
    {
      vtkErrorMacro(<< messages.errors);
    }
  }
  catch (const std::exception& e)
  {
    vtkErrorMacro("The scene could not be read, the last one is kept: " << e.what());
  }
}

//------------------------------------------------------------------------------
std::shared_ptr<const hrt::Snapshot> vtkHybridScene::GetSnapshot() const
{
  return this->Internals->Current.snapshot;
}

//------------------------------------------------------------------------------
const hrt::Changes& vtkHybridScene::GetChanges() const
{
  return this->Internals->Changes;
}

//------------------------------------------------------------------------------
void vtkHybridScene::SetHeadlightShadows(bool on)
{
  this->Internals->Settings.headlightShadows = on;
}

//------------------------------------------------------------------------------
bool vtkHybridScene::GetHeadlightShadows() const
{
  return this->Internals->Settings.headlightShadows;
}

//------------------------------------------------------------------------------
vtkProp* vtkHybridScene::GetProp(std::size_t prop) const
{
  const auto& props = this->Internals->Current.props;
  return prop < props.size() ? props[prop].GetPointer() : nullptr;
}

//------------------------------------------------------------------------------
std::vector<vtkActor*> vtkHybridScene::GetHostedActors() const
{
  const Frame& frame = this->Internals->Current;
  std::vector<vtkActor*> actors;
  for (const HostedActor& hosted : frame.hosted)
  {
    if (frame.verdicts.at(hosted.owner).drawn)
    {
      actors.push_back(hosted.actor);
    }
  }
  return actors;
}

//------------------------------------------------------------------------------
bool vtkHybridScene::IsDrawnByTracer(vtkProp* prop) const
{
  const auto& verdicts = this->Internals->Current.verdicts;
  const auto found = verdicts.find(prop);
  return found != verdicts.end() && found->second.drawn;
}

//------------------------------------------------------------------------------
const char* vtkHybridScene::GetReasonLeftToVTK(vtkProp* prop) const
{
  const auto& verdicts = this->Internals->Current.verdicts;
  const auto found = verdicts.find(prop);
  return describe(found == verdicts.end() ? LeftToVTK::No : found->second.reason);
}

//------------------------------------------------------------------------------
bool vtkHybridScene::IsHosted(vtkProp* prop) const
{
  const auto& verdicts = this->Internals->Current.verdicts;
  const auto found = verdicts.find(prop);
  return found != verdicts.end() && isHosted(found->second.reason);
}

//------------------------------------------------------------------------------
void vtkHybridScene::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const hrt::Snapshot& snapshot = *this->Internals->Current.snapshot;
  os << indent << "Parts: " << snapshot.parts.size() << "\n";
  os << indent << "Triangles: " << snapshot.triangleCount << "\n";
  os << indent << "Lights: " << snapshot.lights.size() << "\n";
  os << indent << "Refusals: " << snapshot.refusals.total() << "\n";
}

VTK_ABI_NAMESPACE_END
