// The scene's triangles on the GPU, once, for all passes: the vertex buffer that the item buffer and
// the shadow maps draw from is the same memory as the texture buffer that direct rendering and the ray
// caster fetch from, and so are the indices. Triangles lie in the snapshot's order, so a triangle's
// number is its place, but for parts with copies: their meshes are there once and come last, and the
// rows of the copies' matrices follow the vertices. The vertices of a part lie in the order of
// VertexOrder.h. Depends on geometry only: parts' matrices and materials are in PartTables.
#pragma once

#include "Rendering/OpenGL2/DrawThrottle.h"
#include "Rendering/OpenGL2/ObjectPool.h"

#include "Rendering/Core/Snapshot.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hrt
{
namespace gl
{

// From what the buffers hold of a part to the world: its positions or, where it has copies, what their
// rows make of these.
glm::dmat4 bufferToWorld(const Part& part);

class GeometryBuffers
{
public:
  explicit GeometryBuffers(ObjectPool& pool);

  // Brings the buffers in line with the snapshot. Parts that kept their place and version are not
  // touched when the total size is unchanged. Returns false, with a reason, when the scene does not
  // fit into the context's texture buffers.
  bool update(const Snapshot& snapshot, std::string& error);

  // True when the buffers hold exactly this snapshot's triangles.
  bool holds(const Snapshot& snapshot) const;

  // Feeds the program's attribute `position`; draw() then rasterises the triangles of one part, of
  // which a last corner's gl_VertexID is vertexToTriangle() less than the triangle's number. Of a part
  // with copies each is an instance, and the number that of the first copy: before each call that draws
  // some of them, `copiesBefore` is told how many others were.
  void bindForDrawing(GLuint program) const;
  void draw(std::size_t part, DrawThrottle& throttle,
    const std::function<void(int)>& copiesBefore) const;
  int vertexToTriangle(std::size_t part) const;

  // Where the rows of a part's copies lie in the table of positions, and how many texels each takes:
  // three, and a fourth where copies have colours.
  struct CopyPlace
  {
    int first, texels, triangles; // triangles: of a copy
  };
  CopyPlace copies(std::size_t part) const;

  // The same without shared vertices, for a program that fetches them by itself from the tables.
  // A corner's gl_VertexID / 3 is cornerToTriangle() less than the triangle's number.
  void bindForFetching() const;
  void drawCorners(std::size_t part, DrawThrottle& throttle,
    const std::function<void(int)>& copiesBefore) const;
  int cornerToTriangle(std::size_t part) const;

  // Binds the tables from the given unit on, in the order of the PrimaryShader's samplers; returns the
  // number of units used.
  static constexpr int kUnits = 9;
  void bindTables(int firstUnit) const;

  std::uint64_t uploadedBytes() const { return this->UploadedBytes; }

private:
  // Where a part lies in each table. An attribute's place is counted in what it is attached to,
  // vertices or triangles; -1: the part lacks it.
  struct Slot
  {
    std::uint64_t version = 0;
    std::uint64_t key = 0;
    TriangleId firstTriangle = 0; // its number
    std::size_t place = 0;        // of its first triangle in the tables
    std::size_t triangles = 0;
    std::int32_t firstVertex = 0;
    std::size_t vertices = 0;
    std::int32_t normals = -1, colors = -1, coordinates = -1, lookup = -1;
    std::int32_t textureCoordinates = -1; // in the table of coordinates too
    std::int32_t sides = -1;
    std::uint64_t copiesVersion = 0;      // 0: none
    std::size_t copies = 1;
    std::int32_t firstCopy = 0, copyTexels = 0; // in the table of positions
    Attachment normalsOf = Attachment::Vertices, colorsOf = Attachment::Vertices;

    bool samePlace(const Slot& o) const;
  };
  // How much of each table is in use.
  struct Sizes
  {
    std::size_t triangles = 0, vertices = 0, normals = 0, colors = 0, coordinates = 0, lookups = 0,
                sides = 0;
    std::size_t copyTexels = 0;
  };

  std::vector<Slot> layOut(const Snapshot& snapshot, Sizes& sizes) const;
  bool fits(const Sizes& sizes, std::string& error) const;
  void allocate(const Sizes& sizes);
  void uploadPart(const Part& part, const Slot& slot);
  void uploadCopies(const Part& part, const Slot& slot);
  void uploadOwners(const Snapshot& snapshot);
  void uploadLayout(const Snapshot& snapshot);

  TextureBuffer Positions, Indices, Normals, Colors, Coordinates, Lookups;
  TextureBuffer TrianglePart, Layout, Sides;
  GLuint VertexArray, EmptyVertexArray;
  std::vector<Slot> Slots;
  bool Uploaded = false;
  std::uint64_t UploadedBytes = 0; // in the last update
};

} // namespace gl
} // namespace hrt
