// See SceneReader.h.
#include "Rendering/Scene/SceneReader.h"

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Scene/CameraExtraction.h"
#include "Rendering/Scene/LightExtraction.h"
#include "Rendering/Scene/MaterialExtraction.h"
#include "Rendering/Scene/ObjectName.h"
#include "Rendering/Scene/PlacedParts.h"

#include "vtkActor.h"
#include "vtkDataArray.h"
#include "vtkMapper.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

#include <iterator>
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

//------------------------------------------------------------------------------
LeftToVTK leftByTextures(TextureReading::State state)
{
  switch (state)
  {
    case TextureReading::State::MipMapped:
      return LeftToVTK::MipMappedTexture;
    case TextureReading::State::Unreadable:
      return LeftToVTK::OtherTexture;
    default:
      return LeftToVTK::No;
  }
}

//------------------------------------------------------------------------------
// Coordinates of one component are those of the lowest row, whatever the transform.
Textures texturesOf(const Textures& textures, vtkPolyData* data)
{
  Textures result = textures;
  vtkDataArray* coordinates = data->GetPointData()->GetTCoords();
  if (coordinates && coordinates->GetNumberOfComponents() == 1)
  {
    result.transformY = glm::vec3(0.0f);
  }
  return result;
}

//------------------------------------------------------------------------------
// What the range of float cannot hold is VTK's, which draws it without a word.
LeftToVTK leaveOutOfRange(Snapshot& snapshot)
{
  ++snapshot.refusals.outOfRangeParts;
  return LeftToVTK::OutOfRange;
}

//------------------------------------------------------------------------------
// What of the light passes a part whose material is known.
void letLightThrough(Part& part, const RayKeys& keys, bool translucent)
{
  const Texture::Alpha alpha = part.material.textures.alpha;
  const bool glass = part.material.isGlass();
  const bool solid = !translucent && alpha == Texture::Alpha::Opaque;
  part.perforated = !glass && !translucent && alpha == Texture::Alpha::Holes;
  part.castsShadow = keys.castsShadow && !glass && solid;
  part.tintsShadow = keys.castsShadow && !glass && !solid;
}

} // namespace

struct SceneReader::Draft
{
  Frame frame;
  std::vector<const vtkProp*> viewProps; // of the parts: what the renderer holds
  bool litByImage = false; // the renderer's environment lights physically based surfaces
  TriangleNumbers numbers;
  SceneBox box;
  std::uint64_t lastPath = 0; // that was given a number

  // A part with its prop among the renderer's. Those with copies come last in the snapshot: for all
  // others a triangle's number is its place in the GPU's buffers too.
  struct Placed
  {
    Part part;
    const vtkProp* viewProp;
  };
  std::vector<Placed> copied;

  void add(const ActorPath& path, const Part& part)
  {
    Part own = part;
    own.source.prop = this->numberOf(path);
    if (part.copies)
    {
      this->copied.push_back({ own, path.props.front() });
      return;
    }
    this->frame.snapshot->parts.push_back(own);
    this->viewProps.push_back(path.props.front());
  }

  void numberTriangles()
  {
    std::vector<Part>& parts = this->frame.snapshot->parts;
    for (const Placed& last : this->copied)
    {
      parts.push_back(last.part);
      this->viewProps.push_back(last.viewProp);
    }
    std::uint64_t next = 0;
    for (Part& part : parts)
    {
      part.firstTriangle = static_cast<TriangleId>(next);
      next += part.triangleCount();
    }
    this->frame.snapshot->triangleCount = static_cast<TriangleId>(next);
  }

  // Of a path that has parts. Those of one path follow each other.
  std::uint32_t numberOf(const ActorPath& path)
  {
    std::vector<vtkWeakPointer<vtkProp>>& props = this->frame.props;
    if (props.empty() || this->lastPath != path.key)
    {
      props.emplace_back(path.actor);
      this->lastPath = path.key;
    }
    return static_cast<std::uint32_t>(props.size() - 1);
  }

  void judge(const ActorPath& path, LeftToVTK left)
  {
    for (vtkProp* prop : path.props)
    {
      Verdict& verdict = this->frame.verdicts[prop];
      verdict.drawn = verdict.drawn && left == LeftToVTK::No;
      verdict.reason = verdict.reason == LeftToVTK::No ? left : verdict.reason;
    }
  }

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
SceneReader::PathMemory& SceneReader::memoryOf(const ActorPath& path)
{
  PathMemory& memory = this->Paths[path.key];
  if (memory.actor != path.actor)
  {
    memory = PathMemory();
    memory.actor = path.actor;
  }
  memory.used = true;
  return memory;
}

//------------------------------------------------------------------------------
// What the path showed last stays known although it is not traced in this frame.
void SceneReader::keep(const ActorPath& path)
{
  const auto memory = this->Paths.find(path.key);
  if (memory == this->Paths.end())
  {
    return;
  }
  memory->second.used = true;
  for (const std::uint64_t piece : memory->second.pieces)
  {
    this->Geometries.keep(piece);
  }
}

//------------------------------------------------------------------------------
LeftToVTK SceneReader::checkMatrix(
  const ActorPath& path, Snapshot& snapshot, glm::dmat4& localToWorld)
{
  switch (normaliseMatrix(localToWorld))
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
    nameOf(path.actor) +
      ": its matrix is not finite or cannot be inverted; left out of ray tracing");
  return LeftToVTK::SingularMatrix;
}

//------------------------------------------------------------------------------
LeftToVTK SceneReader::addPart(const ActorPath& path, const Part& part, Draft& draft)
{
  glm::dvec3 lower, upper;
  worldBounds(part, lower, upper);
  if (!draft.box.include(lower, upper))
  {
    return leaveOutOfRange(*draft.frame.snapshot);
  }
  if (!draft.numbers.take(part.triangleCount()))
  {
    this->Errors.addState(path.key,
      nameOf(path.actor) +
        ": the scene has more than 2^32 - 1 triangles with this part's; left out of ray tracing");
    return LeftToVTK::TooManyTriangles;
  }
  draft.add(path, part);
  return LeftToVTK::No;
}

//------------------------------------------------------------------------------
ExtractionPointer SceneReader::extract(const ActorPath& path, const SurfacePiece& piece,
  std::uint64_t key, bool textured, Refusals& refusals)
{
  GeometrySource source;
  source.actor = path.actor;
  source.input = piece.data;
  source.mapper = piece.colors;
  source.originalCells = piece.originalCells;
  source.flat = path.actor->GetProperty()->GetInterpolation() == VTK_FLAT;
  source.plain = piece.overrides.color;
  source.textured = textured;
  source.edges = path.actor->GetProperty()->GetEdgeVisibility() != 0;
  bool fresh = false;
  ExtractionPointer extraction = this->Geometries.get(key, source, fresh);
  add(extraction->report, refusals);
  const std::string problems = fresh ? describeProblems(*extraction) : std::string();
  if (!problems.empty())
  {
    this->Warnings.addEvent(nameOf(path.actor) + ": " + problems);
  }
  return extraction;
}

//------------------------------------------------------------------------------
// In place for the first mesh, so that a million copies are there once; for another, which has taken the
// mesh's place or shares the copies, aside: the tracer may still read them.
const std::shared_ptr<const Copies>& SceneReader::BoundedCopies::of(
  const Geometry& mesh, const std::shared_ptr<Copies>& given)
{
  if (!this->bounded || this->geometry != mesh.version || this->copies != given->version)
  {
    const bool unbounded = given->boundsMin.x > given->boundsMax.x;
    const std::shared_ptr<Copies> own = unbounded ? given : std::make_shared<Copies>(*given);
    boundCopies(mesh, *own);
    this->bounded = own;
    this->geometry = mesh.version;
    this->copies = given->version;
  }
  return this->bounded;
}

//------------------------------------------------------------------------------
LeftToVTK SceneReader::addPieces(const ActorPath& path, const MapperReading& reading,
  const RayKeys& keys, PathMemory& memory, Draft& draft)
{
  Snapshot& snapshot = *draft.frame.snapshot;
  const bool isGlass = keys.indexOfRefraction > 0.0;
  LeftToVTK left = classifySurface(path.actor, isGlass, draft.litByImage);
  if (!seenByRays(left))
  {
    this->keep(path);
    return left;
  }
  Part part;
  part.localToWorld = path.localToWorld;
  const LeftToVTK byMatrix = this->checkMatrix(path, snapshot, part.localToWorld);
  if (byMatrix != LeftToVTK::No)
  {
    this->keep(path);
    return byMatrix;
  }
  const TextureReading images = this->Images.read(path.actor);
  if (left == LeftToVTK::No)
  {
    left = leftByTextures(images.state);
  }
  const bool translucent = isTranslucent(path.actor);

  const std::vector<ClippingPlane> planes =
    clippingPlanesOf(path.actor->GetMapper(), part.localToWorld);
  const bool glyphs = !reading.pieces.empty() && reading.pieces.front().copies;
  if (glyphs && !planes.empty())
  {
    this->keep(path);
    return LeftToVTK::ClippedGlyphs; // no two would be cut alike
  }
  if (glyphs && !images.textures.layers.empty())
  {
    this->keep(path);
    return LeftToVTK::TexturedGlyphs;
  }

  memory.pieces.clear();
  std::size_t surfaces = 0, otherCells = 0, emptied = 0; // by planes
  for (const SurfacePiece& piece : reading.pieces)
  {
    part.key = keyOfPiece(path.key, piece.key);
    memory.pieces.push_back(part.key);
    if (!piece.copies && HostedCells::neededFor(piece, path.actor))
    {
      ++otherCells;
      for (vtkActor* shown :
        memory.hosted[part.key].update(piece, path.actor, path.localToWorld))
      {
        draft.frame.hosted.push_back({ shown, path.props.front() });
      }
    }
    const ExtractionPointer extraction = this->extract(
      path, piece, part.key, !images.textures.layers.empty(), snapshot.refusals);
    if (extraction->report.distantPoints > 0)
    {
      ++surfaces;
      left = leaveOutOfRange(snapshot);
      continue;
    }
    part.geometry = planes.empty() ? extraction->geometry
                                   : memory.clipped.get(part.key, extraction->geometry, planes);
    if (part.geometry->triangleCount() == 0)
    {
      emptied += extraction->geometry->triangleCount() > 0 ? 1 : 0;
      continue;
    }
    ++surfaces;
    part.copies = piece.copies ? memory.copies[part.key].of(*part.geometry, piece.copies)
                               : nullptr;
    part.source.block = piece.block;
    part.material =
      extractMaterial(path.actor, keys, part.geometry->colorSource, piece.overrides);
    if (!part.geometry->textureCoordinates.empty())
    {
      part.material.textures = texturesOf(images.textures, piece.data);
    }
    letLightThrough(part, keys, translucent);
    if (left == LeftToVTK::No && !isGlass && part.material.textures.alpha == Texture::Alpha::Mixed)
    {
      left = LeftToVTK::Translucent;
    }
    part.visibleToCamera = left == LeftToVTK::No;
    const LeftToVTK byNumber = this->addPart(path, part, draft);
    left = left != LeftToVTK::No ? left : byNumber;
  }
  if (surfaces == 0)
  {
    // Points and lines without a surface, and what planes cut away, are nothing that was refused.
    snapshot.refusals.emptyParts += otherCells + emptied > 0 ? 0 : 1;
    return otherCells > 0 ? LeftToVTK::NoSurface : left;
  }
  return left;
}

//------------------------------------------------------------------------------
LeftToVTK SceneReader::addActor(const ActorPath& path, PathMemory& memory, Draft& draft)
{
  vtkMapper* const mapper = path.actor->GetMapper();
  if (memory.mapper != mapper)
  {
    memory.mapper = mapper;
    memory.adapter = makeAdapter(mapper);
    memory.hosted.clear();
    memory.copies.clear();
  }
  if (!memory.adapter)
  {
    return LeftToVTK::OtherMapper;
  }
  const MapperReading reading = memory.adapter->read(mapper, path.actor);
  if (reading.left != LeftToVTK::No)
  {
    return reading.left;
  }
  if (!reading.problem.empty())
  {
    ++draft.frame.snapshot->refusals.emptyParts;
    this->Warnings.addState(path.key, nameOf(path.actor) + ": " + reading.problem);
    return LeftToVTK::No;
  }
  return this->addPieces(path, reading, readRayKeys(path.props), memory, draft);
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
    this->keep(path);
    return;
  }
  LeftToVTK left = path.actor ? classifyActor(path.actor) : classifyProp(path.props.back());
  if (left == LeftToVTK::No)
  {
    left = this->addActor(path, this->memoryOf(path), draft);
  }
  else
  {
    this->keep(path);
  }
  draft.judge(path, left);
  if (left != LeftToVTK::No && path.actor)
  {
    this->tellOfOptics(path, left);
  }
}

//------------------------------------------------------------------------------
// Who asks for a mirror or for glass and gets neither should know why.
void SceneReader::tellOfOptics(const ActorPath& path, LeftToVTK left)
{
  const RayKeys keys = readRayKeys(path.props);
  const bool isGlass = keys.indexOfRefraction > 0.0;
  if (isGlass || keys.reflectance > 0.0)
  {
    this->Warnings.addState(path.key,
      nameOf(path.actor) + " is meant to be " + (isGlass ? "glass" : "a mirror") +
        ", but VTK draws it: " + describe(left));
  }
}

//------------------------------------------------------------------------------
void SceneReader::addLights(
  vtkRenderer* renderer, const ReaderSettings& settings, Snapshot& snapshot)
{
  LightRig rig = extractLights(renderer, snapshot.camera, settings.headlightShadows);
  for (const LightRig::Issue& issue : rig.issues)
  {
    this->Warnings.addState(issue.key, issue.text);
  }
  snapshot.lights = std::move(rig.lights);
  snapshot.singleHeadlight = rig.singleHeadlight;
}

//------------------------------------------------------------------------------
Frame SceneReader::read(
  vtkRenderer* renderer, int width, int height, const ReaderSettings& settings)
{
  Draft draft;
  Snapshot& snapshot = *draft.frame.snapshot;
  draft.litByImage =
    renderer->GetUseImageBasedLighting() && renderer->GetEnvironmentTexture() != nullptr;
  this->Warnings.abandonUpdate(); // one that an exception has ended
  this->Errors.abandonUpdate();
  const std::vector<ActorPath> paths = actorPaths(renderer);
  draft.frame.verdicts.reserve(paths.size());
  snapshot.parts.reserve(paths.size());
  for (const ActorPath& path : paths)
  {
    this->addPath(path, draft);
  }
  draft.numberTriangles();
  draft.keepAssembliesTogether();
  snapshot.camera = extractCamera(renderer, width, height);
  snapshot.background = extractBackground(renderer, snapshot.camera);
  this->addLights(renderer, settings, snapshot);
  placeOrigin(draft.box, snapshot);
  return std::move(draft.frame);
}

//------------------------------------------------------------------------------
SceneReader::Messages SceneReader::endFrame()
{
  this->Geometries.endFrame();
  this->Images.endFrame();
  this->Keys.endFrame();
  for (auto it = this->Paths.begin(); it != this->Paths.end();)
  {
    const bool used = std::exchange(it->second.used, false);
    it = used ? std::next(it) : this->Paths.erase(it);
  }
  return { this->Warnings.endUpdate(), this->Errors.endUpdate() };
}

} // namespace scene
} // namespace hrt
