// Shadow maps on the host, for the ray caster on the CPU (paper, section 3.1): the tables that the GPU
// ray caster reads too, and the shared look-up (ShadowLookup.glsl) compiled as C++.
//
// Bias, from stated bounds instead of scene-tuned constants. The look-up compares the stored depth at
// a texel's centre with the depth of the receiver's own plane on that line of sight, so a plane
// cannot shadow itself at any slope. What is left:
//  - snapping: rasterisers move vertices to a grid of 2^-s texels, s = GL_SUBPIXEL_BITS, and so a plane's
//    depth by half a cell times its slope along each axis of the map; interpolating that depth in single
//    precision moves it by some roundings of a coordinate of the texture, see kInterpolation;
//  - rounding: both depths come from float arithmetic, see kShadowRounding; no part that lies in one plane
//    needs more than these two;
//  - bend: between the point and the texel's centre, at most sqrt(2) texels away (bilinear taps), the
//    mesh may fold towards the light. A fold by the angle f rises by distance * tan(f) over the plane;
//    seen from the light at cosine c the distance is sqrt(2) * texel / c and the rise in depth another
//    1 / c. Folds up to kSmoothFold are forgiven; sharper concave creases may darken within a texel.
#pragma once

#include "Rendering/Core/Shading/Shading.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace hrt
{

// A face's entry in the table: 0-3 the frame (ShadingFrame.h) to (x, y, stored depth, w), 4-7 the matrix that
// maps planes likewise, 8 stored depth to distance, 9 (tile origin, tile size, snapping),
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
// sqrt(2) times its tangent.
inline constexpr float kBend = 0.37893738f;

// Error of a distance computed in float through two matrix products and one division, relative to
// the largest number involved - the distances from the eye and from the light: about 16 roundings of
// 2^-24 each.
inline constexpr float kShadowRounding = 16.0f / (1 << 24);

// What a rasteriser's rounding is worth as a move of a vertex, relative to the texture's size: depth at
// the texture's corner and two gradients times coordinates, each rounded, 2^-24 a time.
inline constexpr double kInterpolation = 0x1p-22;

// Where a light's shadow map lies among all faces; count 0: the light casts none.
struct ShadowSlot
{
  int firstFace = 0;
  int faceCount = 0;
};

// All lights' maps, for one camera.
struct ShadowMapTables
{
  std::vector<glm::vec4> faces;  // kFaceTexels a face
  std::vector<ShadowSlot> slots; // one a light of the snapshot
  std::shared_ptr<const std::vector<float>> depths; // the atlas, row by row from the bottom
  int width = 0;                                    // texels of its rows
  float clearDepth = 1.0f;       // where nothing was drawn
};

namespace shading
{

// A view of the tables, as light as a pointer. Its functions are not const only because the source
// is GLSL too.
class ShadowLookup
{
public:
  explicit ShadowLookup(const ShadowMapTables& tables)
    : Tables(&tables)
  {
  }

#define HRT_FUNCTION
#define HRT_SHADOW_FACE(i) this->face(i)
#define HRT_SHADOW_DEPTH(place) this->depth(place)
#define HRT_SHADOW_CLEAR this->Tables->clearDepth
#define FACE_TEXELS kFaceTexels
#define FACE_SEAM kFaceSeam
#define MINIMUM_COSINE2 kMinimumCosine2
#define BEND kBend
#define ROUNDING kShadowRounding
#include "Rendering/Core/Shading/ShadowLookup.glsl"
#undef HRT_FUNCTION
#undef HRT_SHADOW_FACE
#undef HRT_SHADOW_DEPTH
#undef HRT_SHADOW_CLEAR
#undef HRT_FAR_AWAY
#undef FACE_TEXELS
#undef FACE_SEAM
#undef MINIMUM_COSINE2
#undef BEND
#undef ROUNDING

private:
  const glm::vec4& face(int i) const
  {
    return this->Tables->faces[static_cast<std::size_t>(i)];
  }
  float depth(const glm::ivec2& place) const
  {
    return (*this->Tables->depths)[static_cast<std::size_t>(place.y) * this->Tables->width +
      static_cast<std::size_t>(place.x)];
  }

  const ShadowMapTables* Tables;
};

} // namespace shading
} // namespace hrt
