// Shadow maps (paper, section 2.2): for each light one depth map, or the six faces of a cube for a
// point light, all tiles of one depth texture. A map is redrawn only when the frame plan says so;
// it does not depend on the camera.
// The CPU can have the depths read back; the look-up in them is that of the GPU (ShadowLookup.glsl).
#pragma once

#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/DepthPrograms.h"
#include "Rendering/OpenGL2/LightFrustum.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PartTables.h"
#include "Rendering/OpenGL2/PixelReadBack.h"

#include "Rendering/Core/Shading/ShadowLookup.h"
#include "Rendering/Core/Snapshot.h"

#include <cstdint>
#include <memory>
#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

// Memory for the depths of all lights' maps, in bytes. When their number asks for more, all maps get a
// lower resolution; statistics tell which.
inline constexpr double kAtlasBytes = 256.0 * (1 << 20);

class ShadowMaps
{
public:
  ShadowMaps(ObjectPool& pool, const DepthConvention& convention);

  // Prepares the slots for a snapshot's lights. Maps stay valid for lights that keep their key,
  // faces and resolution. `wanted`: lights that are to have a map at all.
  // Returns, per light, whether its map is still there.
  std::vector<bool> prepare(
    const Snapshot& snapshot, const std::vector<bool>& wanted, int resolution);

  // Draws the maps of the lights in `draw`. False after an error message.
  bool draw(vtkOpenGLRenderWindow* window, const Snapshot& snapshot,
    const DepthPrograms::Tables& tables, const std::vector<bool>& draw);

  // Where each light's faces lie in the table; refreshed for the current camera by updateTable.
  const std::vector<ShadowSlot>& slots() const { return this->Slots; }
  void updateTable(const Snapshot& snapshot);

  // Brings the maps that were drawn since the last call to host memory; the bytes that travelled.
  // False when the driver would not hand them over.
  bool readBack(vtkOpenGLRenderWindow* window, std::uint64_t& bytes);
  // The maps on the host, for the camera of a snapshot; after readBack.
  std::shared_ptr<const ShadowMapTables> hostTables(const Snapshot& snapshot) const;

  // face table, atlas
  static constexpr int kUnits = 2;
  void bindTables(int firstUnit) const;

  float clearDepth() const { return this->Convention.clearDepth(); }
  std::uint64_t trianglesDrawn() const { return this->TrianglesDrawn; }
  // Texels along a side of a tile; below the wish when the atlas would exceed kAtlasBytes or the
  // context's texture size.
  int resolution() const { return this->Resolution; }

private:
  struct Map
  {
    std::uint64_t key = 0;
    int firstFace = 0;
    int faceCount = 0;            // tiles kept for it
    bool drawn = false;
    bool onHost = false;
    std::vector<LightFace> faces; // none when no part can shadow anything
  };

  glm::ivec2 tile(int face) const;
  std::vector<glm::vec4> faceTable(const Snapshot& snapshot) const;
  double snapping() const;

  Image2D Atlas;
  TextureBuffer Faces;
  GLuint Framebuffer;
  DepthConvention Convention;
  int Resolution = 0;
  int Columns = 1;
  std::vector<Map> Maps;
  std::vector<ShadowSlot> Slots;
  PixelReadBack Transfer;
  // The atlas, where it was read back; never changed while somebody else holds it.
  std::shared_ptr<std::vector<float>> HostDepths;
  std::uint64_t TrianglesDrawn = 0;
};

} // namespace gl
} // namespace hrt
