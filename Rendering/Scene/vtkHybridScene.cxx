// Puts together what the helpers of this folder extract, and holds what must live from one frame to
// the next: the cached triangles, the last snapshot to compare with, and which warnings the user
// has seen already. A frame is built aside and replaces the last one only when it is complete.

#include "vtkHybridScene.h"

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/ActorClassification.h"
#include "Rendering/Scene/ActorPaths.h"
#include "Rendering/Scene/AssemblyKeys.h"
#include "Rendering/Scene/CameraExtraction.h"
#include "Rendering/Scene/GeometryCache.h"
#include "Rendering/Scene/LightExtraction.h"
#include "Rendering/Scene/MaterialExtraction.h"
#include "Rendering/Scene/ObjectName.h"
#include "Rendering/Scene/PlacedParts.h"

#include "vtkActor.h"
#include "vtkMapper.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkWeakPointer.h"

#include <exception>
#include <set>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkHybridScene);

using namespace hrt::scene;

namespace
{

//------------------------------------------------------------------------------
// Adds ", 3 triangles with ..." to a list of complaints.
void complain(std::ostream& text, std::uint64_t count, const char* what)
{
  if (count > 0)
  {
    text << (text.tellp() > 0 ? ", " : "") << count << (count == 1 ? " triangle " : " triangles ")
         << what;
  }
}

//------------------------------------------------------------------------------
std::string describeProblems(const Extraction& extraction)
{
  std::ostringstream refused;
  const TriangleReport& report = extraction.report;
  complain(refused, report.nonFinitePoints, "with points that are not finite or beyond 1.844e18");
  complain(refused, report.invalidIndices, "that name points that do not exist");
  complain(refused, report.degenerateTriangles, "without area");

  std::ostringstream text;
  const char* separator = "";
  if (refused.tellp() > 0)
  {
    text << "refused " << refused.str();
    separator = "; ";
  }
  if (report.replacedNormals > 0)
  {
    text << separator << "normals that are zero or not finite were replaced by the face's in "
         << report.replacedNormals << (report.replacedNormals == 1 ? " triangle" : " triangles");
    separator = "; ";
  }
  if (!extraction.colorsComplete)
  {
    text << separator << "its scalars do not cover the data, coloured by its property";
  }
  return text.str();
}

//------------------------------------------------------------------------------
void add(const TriangleReport& report, hrt::Refusals& sum)
{
  sum.nonFinitePoints += report.nonFinitePoints;
  sum.invalidIndices += report.invalidIndices;
  sum.degenerateTriangles += report.degenerateTriangles;
}

//------------------------------------------------------------------------------
bool hasOtherCells(vtkPolyData* input)
{
  return input->GetNumberOfVerts() > 0 || input->GetNumberOfLines() > 0;
}

//------------------------------------------------------------------------------
// The box of all parts and, in its centre, the origin that rays are traced relative to.
void placeOrigin(hrt::Snapshot& snapshot)
{
  bool first = true;
  for (const hrt::Part& part : snapshot.parts)
  {
    glm::dvec3 lower, upper;
    hrt::worldBounds(part, lower, upper);
    snapshot.boundsMin = first ? lower : glm::min(snapshot.boundsMin, lower);
    snapshot.boundsMax = first ? upper : glm::max(snapshot.boundsMax, upper);
    first = false;
  }
  if (!first)
  {
    // Halved before they are added, so that the sum cannot overflow.
    snapshot.origin = 0.5 * snapshot.boundsMin + 0.5 * snapshot.boundsMax;
  }
}

// What the tracer does with a prop, summed over its visible paths.
struct Verdict
{
  bool drawn = true;
  LeftToVTK reason = LeftToVTK::No; // the first reason met
};

// One snapshot and what VTK objects its parts came from.
struct Frame
{
  std::shared_ptr<hrt::Snapshot> snapshot = std::make_shared<hrt::Snapshot>();
  std::vector<vtkWeakPointer<vtkProp>> props; // of the parts
  std::vector<const vtkProp*> viewProps;      // of the parts: what the renderer holds
  std::unordered_map<const vtkProp*, Verdict> verdicts;
  TriangleNumbers numbers;
};

//------------------------------------------------------------------------------
// VTK draws an assembly as a whole. Where one part of it is left to VTK the others come along, so that
// nothing is drawn twice.
void keepAssembliesTogether(Frame& frame)
{
  for (std::size_t i = 0; i < frame.viewProps.size(); ++i)
  {
    hrt::Part& part = frame.snapshot->parts[i];
    part.visibleToCamera = part.visibleToCamera && frame.verdicts[frame.viewProps[i]].drawn;
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
class vtkHybridScene::vtkInternals
{
public:
  explicit vtkInternals(vtkHybridScene* self)
    : Self(self)
  {
  }

  void Update(vtkRenderer* renderer, int width, int height);

  Frame Current;
  hrt::Changes Changes;

private:
  void AddPath(const ActorPath& path, Frame& frame);
  LeftToVTK AddSurface(const ActorPath& path, vtkMapper* mapper, vtkPolyData* input, Frame& frame);
  LeftToVTK AddPart(const ActorPath& path, const hrt::Part& part, Frame& frame);
  LeftToVTK CheckMatrix(const ActorPath& path, hrt::Part& part, Frame& frame);
  vtkPolyData* UpdateInput(vtkMapper* mapper, const ActorPath& path, Frame& frame, LeftToVTK& left);
  void AddLights(vtkRenderer* renderer, hrt::Snapshot& snapshot);
  bool IsNews(std::uint64_t key, const std::string& text);

  vtkHybridScene* Self;
  vtkWeakPointer<vtkRenderer> LastRenderer;
  GeometryCache Geometries;
  AssemblyKeys Keys;

  // Messages about states that last: given when the state begins, again when it comes back.
  using Messages = std::set<std::pair<std::uint64_t, std::string>>;
  Messages Told;
  Messages Telling;
};

//------------------------------------------------------------------------------
bool vtkHybridScene::vtkInternals::IsNews(std::uint64_t key, const std::string& text)
{
  this->Telling.emplace(key, text);
  return this->Told.count({ key, text }) == 0;
}

//------------------------------------------------------------------------------
// Brings the mapper's input up to date. Null when there is none, with the reason if VTK draws it.
vtkPolyData* vtkHybridScene::vtkInternals::UpdateInput(
  vtkMapper* mapper, const ActorPath& path, Frame& frame, LeftToVTK& left)
{
  left = LeftToVTK::No;
  if (mapper->GetNumberOfInputConnections(0) > 0 && !mapper->GetStatic())
  {
    mapper->Update();
  }
  vtkDataObject* data =
    mapper->GetNumberOfInputConnections(0) > 0 ? mapper->GetInputDataObject(0, 0) : nullptr;
  if (!data)
  {
    ++frame.snapshot->refusals.emptyParts;
    const std::string text = nameOf(path.actor) + ": the mapper has no input; nothing is drawn";
    if (this->IsNews(path.key, text))
    {
      vtkWarningWithObjectMacro(this->Self, << text);
    }
    return nullptr;
  }
  vtkPolyData* input = vtkPolyData::SafeDownCast(data);
  if (!input)
  {
    left = LeftToVTK::OtherData;
  }
  return input;
}

//------------------------------------------------------------------------------
LeftToVTK vtkHybridScene::vtkInternals::CheckMatrix(
  const ActorPath& path, hrt::Part& part, Frame& frame)
{
  part.localToWorld = path.localToWorld;
  switch (normaliseMatrix(part.localToWorld))
  {
    case MatrixState::Good:
      return LeftToVTK::No;
    case MatrixState::Projective:
      return LeftToVTK::ProjectiveMatrix;
    case MatrixState::Singular:
      break;
  }
  ++frame.snapshot->refusals.singularMatrices;
  const std::string text =
    part.name + ": its matrix is not finite or cannot be inverted; left out of ray tracing";
  if (this->IsNews(path.key, text))
  {
    vtkWarningWithObjectMacro(this->Self, << text);
  }
  return LeftToVTK::SingularMatrix;
}

//------------------------------------------------------------------------------
LeftToVTK vtkHybridScene::vtkInternals::AddPart(
  const ActorPath& path, const hrt::Part& part, Frame& frame)
{
  hrt::Part numbered = part;
  if (!frame.numbers.take(part.geometry->triangleCount(), numbered.firstTriangle))
  {
    const std::string text = part.name +
      ": the scene has more than 2^32 - 1 triangles with this "
      "part's; left out of ray tracing";
    if (this->IsNews(path.key, text))
    {
      vtkErrorWithObjectMacro(this->Self, << text);
    }
    return LeftToVTK::TooManyTriangles;
  }
  frame.snapshot->parts.push_back(std::move(numbered));
  frame.props.emplace_back(path.actor);
  frame.viewProps.push_back(path.props.front());
  return LeftToVTK::No;
}

//------------------------------------------------------------------------------
LeftToVTK vtkHybridScene::vtkInternals::AddSurface(
  const ActorPath& path, vtkMapper* mapper, vtkPolyData* input, Frame& frame)
{
  const RayKeys keys = readRayKeys(path.props);
  const bool isGlass = keys.indexOfRefraction > 0.0;
  const LeftToVTK left = classifySurface(path.actor, mapper, input, isGlass);
  if (!seenByRays(left))
  {
    this->Geometries.keep(path.key);
    return left;
  }
  hrt::Part part;
  part.key = path.key;
  part.name = nameOf(path.actor);
  const LeftToVTK byMatrix = this->CheckMatrix(path, part, frame);
  if (byMatrix != LeftToVTK::No)
  {
    this->Geometries.keep(path.key);
    return byMatrix;
  }

  bool fresh = false;
  const bool flat = path.actor->GetProperty()->GetInterpolation() == VTK_FLAT;
  const ExtractionPointer extraction =
    this->Geometries.get(path.key, { path.actor, input, mapper, flat }, fresh);
  add(extraction->report, frame.snapshot->refusals);
  if (fresh && !extraction->clean())
  {
    vtkWarningWithObjectMacro(this->Self, << part.name << ": " << describeProblems(*extraction));
  }
  part.geometry = extraction->geometry;
  if (part.geometry->triangleCount() == 0)
  {
    // Points and lines without a surface are nothing that was refused.
    frame.snapshot->refusals.emptyParts += hasOtherCells(input) ? 0 : 1;
    return left;
  }

  part.material = extractMaterial(path.actor, keys, part.geometry->colorSource);
  part.visibleToCamera = left == LeftToVTK::No;
  part.visibleToRays = true;
  part.castsShadow = !isGlass && !isTranslucent(path.actor);
  const LeftToVTK byNumber = this->AddPart(path, part, frame);
  return left != LeftToVTK::No ? left : byNumber;
}

//------------------------------------------------------------------------------
void vtkHybridScene::vtkInternals::AddPath(const ActorPath& path, Frame& frame)
{
  if (path.actor)
  {
    this->Keys.restore(path);
  }
  if (!path.visible)
  {
    this->Geometries.keep(path.key);
    return;
  }
  LeftToVTK left = path.actor ? classifyMapper(path.actor) : LeftToVTK::NoActor;
  if (left == LeftToVTK::No)
  {
    vtkMapper* mapper = path.actor->GetMapper();
    if (vtkPolyData* input = this->UpdateInput(mapper, path, frame, left))
    {
      left = this->AddSurface(path, mapper, input, frame);
    }
  }
  for (vtkProp* prop : path.props)
  {
    Verdict& verdict = frame.verdicts[prop];
    verdict.drawn = verdict.drawn && left == LeftToVTK::No;
    verdict.reason = verdict.reason == LeftToVTK::No ? left : verdict.reason;
  }
}

//------------------------------------------------------------------------------
void vtkHybridScene::vtkInternals::AddLights(vtkRenderer* renderer, hrt::Snapshot& snapshot)
{
  LightRig rig = extractLights(renderer, snapshot.camera);
  for (const LightRig::Issue& issue : rig.issues)
  {
    if (this->IsNews(issue.key, issue.text))
    {
      vtkWarningWithObjectMacro(this->Self, << issue.text);
    }
  }
  snapshot.lights = std::move(rig.lights);
  snapshot.singleHeadlight = rig.singleHeadlight;
}

//------------------------------------------------------------------------------
void vtkHybridScene::vtkInternals::Update(vtkRenderer* renderer, int width, int height)
{
  Frame frame;
  hrt::Snapshot& snapshot = *frame.snapshot;
  this->Telling.clear();
  for (const ActorPath& path : actorPaths(renderer))
  {
    this->AddPath(path, frame);
  }
  keepAssembliesTogether(frame);
  snapshot.triangleCount = frame.numbers.taken();
  snapshot.camera = extractCamera(renderer, width, height);
  snapshot.background = extractBackground(renderer, snapshot.camera);
  this->AddLights(renderer, snapshot);
  placeOrigin(snapshot);

  const bool sameRenderer = this->LastRenderer == renderer;
  this->Changes =
    hrt::compareSnapshots(sameRenderer ? this->Current.snapshot.get() : nullptr, snapshot);
  this->Current = std::move(frame);
  this->LastRenderer = renderer;
  this->Geometries.endFrame();
  this->Keys.endFrame();
  this->Told.swap(this->Telling);
}

//------------------------------------------------------------------------------
vtkHybridScene::vtkHybridScene()
  : Internals(new vtkInternals(this))
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
    this->Internals->Update(renderer, width, height);
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
vtkProp* vtkHybridScene::GetProp(std::size_t part) const
{
  const auto& props = this->Internals->Current.props;
  return part < props.size() ? props[part].GetPointer() : nullptr;
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
