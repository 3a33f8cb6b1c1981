// Reads one frame of a renderer: goes through its actors, sorts them out, and puts together what
// the other parts of this folder extract. It holds what must live from one frame to the next - the
// cached triangles and which warnings the user has seen already - and knows nothing of the frame
// before: a frame is built aside, so that one that cannot be completed leaves no trace.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/ActorClassification.h"
#include "Rendering/Scene/ActorPaths.h"
#include "Rendering/Scene/Adapters/MapperAdapter.h"
#include "Rendering/Scene/AssemblyKeys.h"
#include "Rendering/Scene/ClippedPieces.h"
#include "Rendering/Scene/Diagnostics.h"
#include "Rendering/Scene/GeometryCache.h"
#include "Rendering/Scene/HostedCells.h"
#include "Rendering/Scene/MaterialExtraction.h"
#include "Rendering/Scene/TextureExtraction.h"

#include "vtkActor.h"
#include "vtkMapper.h"
#include "vtkProp.h"
#include "vtkWeakPointer.h"

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

class vtkRenderer;

namespace hrt
{
namespace scene
{

// What the tracer does with a prop, summed over its visible paths.
struct Verdict
{
  bool drawn = true;
  LeftToVTK reason = LeftToVTK::No; // the first reason met
};

// What VTK draws over the surface of a prop that is traced.
struct HostedActor
{
  vtkSmartPointer<vtkActor> actor;
  const vtkProp* owner; // the renderer's prop
};

// One snapshot and what VTK objects its parts came from.
struct Frame
{
  std::shared_ptr<Snapshot> snapshot = std::make_shared<Snapshot>();
  std::vector<vtkWeakPointer<vtkProp>> props; // by Source::prop
  std::unordered_map<const vtkProp*, Verdict> verdicts;
  std::vector<HostedActor> hosted;
};

// What the user decides about reading.
struct ReaderSettings
{
  bool headlightShadows = false; // lights of VTK's kind headlight cast shadows
};

class SceneReader
{
public:
  // Pipelines are brought up to date. May throw what memory or a pipeline does.
  Frame read(vtkRenderer* renderer, int width, int height, const ReaderSettings& settings);

  // What there is to tell of the frame, a line each; empty where there is nothing new.
  struct Messages
  {
    std::string warnings;
    std::string errors;
  };
  // The frame that was read is taken: forgets what it did not need.
  Messages endFrame();

private:
  struct Draft; // a frame that is being put together

  // A piece's copies, with the bounds that the geometry gives them.
  struct BoundedCopies
  {
    std::uint64_t geometry = 0, copies = 0; // versions
    std::shared_ptr<const Copies> bounded;

    const std::shared_ptr<const Copies>& of(
      const Geometry& mesh, const std::shared_ptr<Copies>& given);
  };

  // What is kept of a path from frame to frame.
  struct PathMemory
  {
    vtkWeakPointer<vtkActor> actor; // another one may come to live at its address
    vtkWeakPointer<vtkMapper> mapper;
    std::unique_ptr<MapperAdapter> adapter; // null: no kind reads the mapper
    std::vector<std::uint64_t> pieces;      // keys of the last frame's
    std::unordered_map<std::uint64_t, HostedCells> hosted; // by piece
    std::unordered_map<std::uint64_t, BoundedCopies> copies; // likewise
    ClippedPieces clipped;
    bool used = false;
  };
  PathMemory& memoryOf(const ActorPath& path);
  void keep(const ActorPath& path);

  LeftToVTK addActor(const ActorPath& path, PathMemory& memory, Draft& draft);
  LeftToVTK addPieces(const ActorPath& path, const MapperReading& reading, const RayKeys& keys,
    PathMemory& memory, Draft& draft);
  LeftToVTK addPart(const ActorPath& path, const Part& part, Draft& draft);
  LeftToVTK checkMatrix(const ActorPath& path, Snapshot& snapshot, glm::dmat4& localToWorld);
  ExtractionPointer extract(const ActorPath& path, const SurfacePiece& piece, std::uint64_t key,
    bool textured, Refusals& refusals);
  void addPath(const ActorPath& path, Draft& draft);
  void tellOfOptics(const ActorPath& path, LeftToVTK left);
  void addLights(vtkRenderer* renderer, const ReaderSettings& settings, Snapshot& snapshot);

  std::unordered_map<std::uint64_t, PathMemory> Paths;
  GeometryCache Geometries;
  TextureCache Images;
  AssemblyKeys Keys;
  Diagnostics Warnings;
  Diagnostics Errors;
};

} // namespace scene
} // namespace hrt
