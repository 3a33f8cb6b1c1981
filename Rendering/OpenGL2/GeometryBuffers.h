// The scene's triangles on the GPU, once, for all passes: the vertex buffer that the object
// intersection buffer and the shadow maps rasterise is the same memory as the texture buffer the
// ray caster fetches corners from. Triangles lie in the snapshot's order, so a triangle's number is
// its place. Depends on geometry only: matrices and materials are in PartTables.
#pragma once

#include "Rendering/OpenGL2/ObjectPool.h"

#include "Rendering/Core/Snapshot.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hrt
{
namespace gl
{

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

  // Feeds the program's attribute `position`; draw() then rasterises the triangles of one part.
  void bindForDrawing(GLuint program) const;
  void draw(const Part& part) const;

  // Binds the tables from the given unit on, in the order of the RayCaster's samplers; returns the
  // number of units used.
  static constexpr int kUnits = 7;
  void bindTables(int firstUnit) const;

  std::uint64_t uploadedBytes() const { return this->UploadedBytes; }

private:
  // Where a part's optional attributes lie, in triangles from the start of each table; -1: none.
  struct Slot
  {
    std::uint64_t version = 0;
    std::uint64_t key = 0;
    TriangleId firstTriangle = 0;
    std::size_t triangles = 0;
    std::int32_t normals = -1, colors = -1, coordinates = -1, lookup = -1;
    std::int32_t textureCoordinates = -1; // in the table of coordinates too

    bool samePlace(const Slot& o) const
    {
      return this->firstTriangle == o.firstTriangle && this->triangles == o.triangles &&
        this->normals == o.normals && this->colors == o.colors &&
        this->coordinates == o.coordinates && this->lookup == o.lookup &&
        this->textureCoordinates == o.textureCoordinates;
    }
  };

  std::vector<Slot> layOut(const Snapshot& snapshot) const;
  bool fits(const Snapshot& snapshot, std::string& error) const;
  void allocate(const Snapshot& snapshot);
  void uploadPart(const Part& part, const Slot& slot);
  void uploadLayout(const Snapshot& snapshot);

  TextureBuffer Positions, Normals, Colors, Coordinates, Lookups;
  TextureBuffer TrianglePart, Layout;
  GLuint VertexArray;
  std::vector<Slot> Slots;
  bool Uploaded = false;
  std::uint64_t UploadedBytes = 0; // in the last update
};

} // namespace gl
} // namespace hrt
