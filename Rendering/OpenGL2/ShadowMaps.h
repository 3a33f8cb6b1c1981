// Shadow maps (paper, section 2.2): for each light one depth map, or the six faces of a cube for a
// point light, all tiles of one depth texture. A map is redrawn only when the frame plan says so;
// it does not depend on the camera.
//
// Bias, from stated bounds instead of scene-tuned constants. The ray caster compares the stored depth
// at a texel's centre with the depth of the receiver's own plane on that line of sight, so a plane
// cannot shadow itself at any slope. What is left:
//  - rounding: both depths come from float arithmetic, see kRounding; no part that lies in one plane
//    needs more than this;
//  - bend: between the point and the texel's centre, at most sqrt(2) texels away (bilinear taps), the
//    mesh may fold towards the light. A fold by the angle f rises by distance * tan(f) over the plane;
//    seen from the light at cosine c the distance is sqrt(2) * texel / c and the rise in depth another
//    1 / c. Folds up to kSmoothFold are forgiven; sharper concave creases may darken within a texel.
#pragma once

#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/GeometryBuffers.h"
#include "Rendering/OpenGL2/LightFrustum.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PartTables.h"

#include "Rendering/Core/Plan/FramePlan.h"
#include "Rendering/Core/Snapshot.h"

#include <cstdint>
#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

// A face's entry in the shader's table: 0-3 view to (x, y, stored depth, w), 4-7 the matrix that
// maps planes likewise, 8 stored depth to distance, 9 (tile origin, tile size, bend factor),
// 10 (texel size: constant, linear; depth of the near plane; rounding: quadratic).
inline constexpr int kFaceTexels = 11;

// Share by which a point may lie outside of every cube face through rounding (float, 2^-24 per
// operation, some ten operations) and still be looked up.
inline constexpr float kFaceSeam = 1.0f + 1e-5f;

// Smallest squared cosine to the light that the bias is scaled with: at a more grazing angle the
// diffuse term is below 0.18 of its peak and a wrong sample is faint, while the bias has no bound.
inline constexpr float kMinimumCosine2 = 0.03f;

// Fold between neighbouring facets, in degrees, up to which a smooth mesh does not shadow itself
// within a texel; a sphere of 30 facets around its equator folds by 12.
inline constexpr double kSmoothFold = 15.0;

// Error of a distance computed in float through two matrix products and one division, relative to
// the largest number involved - the distances from the eye and from the light: about 16 roundings of
// 2^-24 each.
inline constexpr float kRounding = 16.0f / (1 << 24);

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
    const GeometryBuffers& geometry, const std::vector<bool>& draw);

  // Where each light's faces lie in the table; refreshed for the current camera by updateTable.
  const std::vector<ShadowSlot>& slots() const { return this->Slots; }
  void updateTable(const Snapshot& snapshot);

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
    std::vector<LightFace> faces; // none when no part can shadow anything
  };

  glm::ivec2 tile(int face) const;

  Image2D Atlas;
  TextureBuffer Faces;
  GLuint Framebuffer;
  DepthConvention Convention;
  int Resolution = 0;
  int Columns = 1;
  std::vector<Map> Maps;
  std::vector<ShadowSlot> Slots;
  std::uint64_t TrianglesDrawn = 0;
};

} // namespace gl
} // namespace hrt
