// Keeps the triangles of every part from frame to frame, so that a frame extracts only what
// changed. A Geometry is replaced only when its content differs; a pipeline that ran again with the
// same result, or a look-up table that was merely touched, costs no upload and no rebuild below.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Scene/TriangleExtraction.h"

#include "vtkActor.h"
#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <map>
#include <memory>
#include <tuple>
#include <unordered_map>

class vtkDataArray;
class vtkMapper;
class vtkPolyData;

namespace hrt
{
namespace scene
{

// What became of one mapper's input.
struct Extraction
{
  std::shared_ptr<const Geometry> geometry; // never null, may have no triangle
  TriangleReport report;
  bool colorsComplete = true; // else the mapper's colours did not cover the input

};
using ExtractionPointer = std::shared_ptr<const Extraction>;

// Everything that triangles and colours depend on. Modification times are unique in the process, so
// that new data at an old address are not taken for the old ones.
struct GeometrySource
{
  vtkActor* actor = nullptr;
  vtkPolyData* input = nullptr;
  vtkMapper* mapper = nullptr;           // whose settings colour it
  vtkDataArray* originalCells = nullptr; // see SurfacePiece; comes and goes with the input
  bool flat = false;  // vtkProperty's interpolation, which selects the normals
  bool plain = false; // scalars do not count
  bool textured = false; // texture coordinates are wanted
  bool edges = false;    // its edges are shown
};

// For a geometry that is made outside of the cache: unique among all.
std::uint64_t nextGeometryVersion();

class GeometryCache
{
public:
  // The part's triangles. `fresh` tells that they differ from the part's last ones.
  ExtractionPointer get(std::uint64_t part, const GeometrySource& source, bool& fresh);

  // Keeps the part's triangles although it is not drawn in this frame.
  void keep(std::uint64_t part);

  // Forgets the parts that were neither asked for nor kept since the last call.
  void endFrame();

private:
  using Signature = std::tuple<const void*, vtkMTimeType, const void*, vtkMTimeType, bool, bool, bool, bool>;
  struct Record
  {
    vtkWeakPointer<vtkActor> actor; // another one may come to live at its address
    Signature signature;
    ExtractionPointer extraction;
    bool used = false;
  };

  static Signature signatureOf(const GeometrySource& source);
  ExtractionPointer extract(const GeometrySource& source, const Extraction* before);

  std::unordered_map<std::uint64_t, Record> Records; // by part
  std::map<Signature, ExtractionPointer> Shared;     // actors with the same mapper share triangles
};

} // namespace scene
} // namespace hrt
