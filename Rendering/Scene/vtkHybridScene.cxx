// Puts together what the helpers of this folder extract, and holds what must live from one frame to
// the next: the cached triangles, the last snapshot to compare with, and which warnings the user
// has seen already. A frame is built aside and replaces the last one only when it is complete.

#include "vtkHybridScene.h"

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/ActorClassification.h"
#include "Rendering/Scene/ActorPaths.h"
#include "Rendering/Scene/AssemblyKeys.h"
#include "Rendering/Scene/CameraExtraction.h"
#include "Rendering/Scene/Complaints.h"
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
#include <limits>
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

// The box around all parts.
struct SceneBox
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  // False, and nothing included, for a box that is not finite or too large for the engines.
  bool include(const glm::dvec3& from, const glm::dvec3& to)
  {
    if (!hrt::isAdmissible(from) || !hrt::isAdmissible(to))
    {
      return false;
    }
    this->lower = glm::min(this->lower, from);
    this->upper = glm::max(this->upper, to);
    return true;
  }
};

//------------------------------------------------------------------------------
// The box of all parts and, in its centre, the origin that rays are traced relative to.
void placeOrigin(const SceneBox& box, hrt::Snapshot& snapshot)
{
  if (!snapshot.parts.empty())
  {
    snapshot.boundsMin = box.lower;
    snapshot.boundsMax = box.upper;
    snapshot.origin = 0.5 * box.lower + 0.5 * box.upper;
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
  SceneBox box;
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
  void Tell();

  vtkHybridScene* Self;
  vtkWeakPointer<vtkRenderer> LastRenderer;
  GeometryCache Geometries;
  AssemblyKeys Keys;
  Complaints Warnings;
  Complaints Errors;
};

//------------------------------------------------------------------------------
void vtkHybridScene::vtkInternals::Tell()
{
  const std::string warnings = this->Warnings.endUpdate();
  if (!warnings.empty())
  {
    vtkWarningWithObjectMacro(this->Self, << warnings);
  }
  const std::string errors = this->Errors.endUpdate();
  if (!errors.empty())
  {
    vtkErrorWithObjectMacro(this->Self, << errors);
  }
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
    this->Warnings.addState(
      path.key, nameOf(path.actor) + ": the mapper has no input; nothing is drawn");
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
  this->Warnings.addState(path.key,
    part.name + ": its matrix is not finite or cannot be inverted; left out of ray tracing");
  return LeftToVTK::SingularMatrix;
}

//------------------------------------------------------------------------------
LeftToVTK vtkHybridScene::vtkInternals::AddPart(
  const ActorPath& path, const hrt::Part& part, Frame& frame)
{
  glm::dvec3 lower, upper;
  hrt::worldBounds(part, lower, upper);
  if (!frame.box.include(lower, upper))
  {
    ++frame.snapshot->refusals.outOfRangeParts;
    this->Errors.addState(path.key,
      part.name + ": its bounds in the world are beyond 1.844e18; left out of ray tracing");
    return LeftToVTK::OutOfRange;
  }
  hrt::Part numbered = part;
  if (!frame.numbers.take(part.geometry->triangleCount(), numbered.firstTriangle))
  {
    this->Errors.addState(path.key,
      part.name +
        ": the scene has more than 2^32 - 1 triangles with this part's; left out of ray tracing");
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
    this->Warnings.addEvent(part.name + ": " + describeProblems(*extraction));
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
    this->Warnings.addState(issue.key, issue.text);
  }
  snapshot.lights = std::move(rig.lights);
  snapshot.singleHeadlight = rig.singleHeadlight;
}

//------------------------------------------------------------------------------
void vtkHybridScene::vtkInternals::Update(vtkRenderer* renderer, int width, int height)
{
  Frame frame;
  hrt::Snapshot& snapshot = *frame.snapshot;
  this->Warnings.abandonUpdate(); // one that an exception has ended
  this->Errors.abandonUpdate();
  for (const ActorPath& path : actorPaths(renderer))
  {
    this->AddPath(path, frame);
  }
  keepAssembliesTogether(frame);
  snapshot.triangleCount = frame.numbers.taken();
  snapshot.camera = extractCamera(renderer, width, height);
  snapshot.background = extractBackground(renderer, snapshot.camera);
  this->AddLights(renderer, snapshot);
  placeOrigin(frame.box, snapshot);

  const bool sameRenderer = this->LastRenderer == renderer;
  this->Changes =
    hrt::compareSnapshots(sameRenderer ? this->Current.snapshot.get() : nullptr, snapshot);
  this->Current = std::move(frame);
  this->LastRenderer = renderer;
  this->Geometries.endFrame();
  this->Keys.endFrame();
  this->Tell();
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
