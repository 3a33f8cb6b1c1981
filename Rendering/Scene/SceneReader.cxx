// See SceneReader.h.
#include "Rendering/Scene/SceneReader.h"

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Scene/CameraExtraction.h"
#include "Rendering/Scene/LightExtraction.h"
#include "Rendering/Scene/MaterialExtraction.h"
#include "Rendering/Scene/ObjectName.h"
#include "Rendering/Scene/PlacedParts.h"

#include "vtkActor.h"
#include "vtkMapper.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

#include <limits>
#include <utility>

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
void add(const TriangleReport& report, Refusals& sum)
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
    if (!isAdmissible(from) || !isAdmissible(to))
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
void placeOrigin(const SceneBox& box, Snapshot& snapshot)
{
  if (!snapshot.parts.empty())
  {
    snapshot.boundsMin = box.lower;
    snapshot.boundsMax = box.upper;
    snapshot.origin = 0.5 * box.lower + 0.5 * box.upper;
  }
}

} // namespace

struct SceneReader::Draft
{
  Frame frame;
  std::vector<const vtkProp*> viewProps; // of the parts: what the renderer holds
  TriangleNumbers numbers;
  SceneBox box;

  // VTK draws an assembly as a whole. Where one part of it is left to VTK the others come along, so
  // that nothing is drawn twice.
  void keepAssembliesTogether()
  {
    for (std::size_t i = 0; i < this->viewProps.size(); ++i)
    {
      Part& part = this->frame.snapshot->parts[i];
      part.visibleToCamera =
        part.visibleToCamera && this->frame.verdicts[this->viewProps[i]].drawn;
    }
  }
};

//------------------------------------------------------------------------------
// Brings the mapper's input up to date. Null when there is none, with the reason if VTK draws it.
vtkPolyData* SceneReader::updateInput(
  vtkMapper* mapper, const ActorPath& path, Snapshot& snapshot, LeftToVTK& left)
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
    ++snapshot.refusals.emptyParts;
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
LeftToVTK SceneReader::checkMatrix(const ActorPath& path, Part& part, Snapshot& snapshot)
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
  ++snapshot.refusals.singularMatrices;
  this->Warnings.addState(path.key,
    part.name + ": its matrix is not finite or cannot be inverted; left out of ray tracing");
  return LeftToVTK::SingularMatrix;
}

//------------------------------------------------------------------------------
LeftToVTK SceneReader::addPart(const ActorPath& path, const Part& part, Draft& draft)
{
  glm::dvec3 lower, upper;
  worldBounds(part, lower, upper);
  if (!draft.box.include(lower, upper))
  {
    ++draft.frame.snapshot->refusals.outOfRangeParts;
    this->Errors.addState(path.key,
      part.name + ": its bounds in the world are beyond 1.844e18; left out of ray tracing");
    return LeftToVTK::OutOfRange;
  }
  Part numbered = part;
  if (!draft.numbers.take(part.geometry->triangleCount(), numbered.firstTriangle))
  {
    this->Errors.addState(path.key,
      part.name +
        ": the scene has more than 2^32 - 1 triangles with this part's; left out of ray tracing");
    return LeftToVTK::TooManyTriangles;
  }
  draft.frame.snapshot->parts.push_back(std::move(numbered));
  draft.frame.props.emplace_back(path.actor);
  draft.viewProps.push_back(path.props.front());
  return LeftToVTK::No;
}

//------------------------------------------------------------------------------
LeftToVTK SceneReader::addSurface(
  const ActorPath& path, vtkMapper* mapper, vtkPolyData* input, Draft& draft)
{
  const RayKeys keys = readRayKeys(path.props);
  const bool isGlass = keys.indexOfRefraction > 0.0;
  const LeftToVTK left = classifySurface(path.actor, mapper, input, isGlass);
  if (!seenByRays(left))
  {
    this->Geometries.keep(path.key);
    return left;
  }
  Part part;
  part.key = path.key;
  part.name = nameOf(path.actor);
  const LeftToVTK byMatrix = this->checkMatrix(path, part, *draft.frame.snapshot);
  if (byMatrix != LeftToVTK::No)
  {
    this->Geometries.keep(path.key);
    return byMatrix;
  }

  bool fresh = false;
  const bool flat = path.actor->GetProperty()->GetInterpolation() == VTK_FLAT;
  const ExtractionPointer extraction =
    this->Geometries.get(path.key, { path.actor, input, mapper, flat }, fresh);
  add(extraction->report, draft.frame.snapshot->refusals);
  if (fresh && !extraction->clean())
  {
    this->Warnings.addEvent(part.name + ": " + describeProblems(*extraction));
  }
  part.geometry = extraction->geometry;
  if (part.geometry->triangleCount() == 0)
  {
    // Points and lines without a surface are nothing that was refused.
    draft.frame.snapshot->refusals.emptyParts += hasOtherCells(input) ? 0 : 1;
    return left;
  }

  part.material = extractMaterial(path.actor, keys, part.geometry->colorSource);
  part.visibleToCamera = left == LeftToVTK::No;
  part.visibleToRays = true;
  part.castsShadow = !isGlass && !isTranslucent(path.actor);
  const LeftToVTK byNumber = this->addPart(path, part, draft);
  return left != LeftToVTK::No ? left : byNumber;
}

//------------------------------------------------------------------------------
void SceneReader::addPath(const ActorPath& path, Draft& draft)
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
    if (vtkPolyData* input = this->updateInput(mapper, path, *draft.frame.snapshot, left))
    {
      left = this->addSurface(path, mapper, input, draft);
    }
  }
  for (vtkProp* prop : path.props)
  {
    Verdict& verdict = draft.frame.verdicts[prop];
    verdict.drawn = verdict.drawn && left == LeftToVTK::No;
    verdict.reason = verdict.reason == LeftToVTK::No ? left : verdict.reason;
  }
}

//------------------------------------------------------------------------------
void SceneReader::addLights(vtkRenderer* renderer, Snapshot& snapshot)
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
Frame SceneReader::read(vtkRenderer* renderer, int width, int height)
{
  Draft draft;
  Snapshot& snapshot = *draft.frame.snapshot;
  this->Warnings.abandonUpdate(); // one that an exception has ended
  this->Errors.abandonUpdate();
  for (const ActorPath& path : actorPaths(renderer))
  {
    this->addPath(path, draft);
  }
  draft.keepAssembliesTogether();
  snapshot.triangleCount = draft.numbers.taken();
  snapshot.camera = extractCamera(renderer, width, height);
  snapshot.background = extractBackground(renderer, snapshot.camera);
  this->addLights(renderer, snapshot);
  placeOrigin(draft.box, snapshot);
  return std::move(draft.frame);
}

//------------------------------------------------------------------------------
SceneReader::Messages SceneReader::endFrame()
{
  this->Geometries.endFrame();
  this->Keys.endFrame();
  return { this->Warnings.endUpdate(), this->Errors.endUpdate() };
}

} // namespace scene
} // namespace hrt
