// Fits the shadow maps' projections to the scene: who casts at all, which faces a light needs, what
// each face sees and how large a texel is there. Plain arithmetic in double precision, without GL.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <vector>

namespace hrt
{
namespace gl
{

// One face of a light's shadow map.
struct LightFace
{
  glm::dmat4 worldToClip{ 1.0 }; // OpenGL clip space, z from -w to w
  // Distance along the face's axis is near at clip depth -1 and far at +1.
  double near = 0.0, far = 1.0;
  bool perspective = false;
  // World size of a texel at distance d: texelConstant + texelLinear * d.
  double texelConstant = 0.0, texelLinear = 0.0;
};

// Which parts can shadow anything. A flat part, a floor say, cannot shadow itself, and nothing else
// when all that the camera sees lies on its lit side: without it the map need not cover it, however
// large it is.
std::vector<bool> castersFor(const Snapshot& snapshot, const Light& light);

// The faces of a light's map of the given resolution: one for a directional light (orthographic) and
// for a spot light, six (a cube) for a point light and for a spot wider than kWidestSpot. Empty when
// none of the parts casts. `nearestRatio`: see kNearestRatio.
std::vector<LightFace> fitLightFaces(const Snapshot& snapshot, const Light& light,
  const std::vector<bool>& casters, int resolution, double nearestRatio);

// Smallest ratio of a perspective face's near plane to its far plane. What lies nearer to the light is
// cut off. With reversed depth (DepthConvention.h) a float resolves distances equally well down to its
// own 2^-24; without, the error at the far plane is 2^-24 / ratio of the distance.
inline constexpr double kNearestRatioReversed = 1e-7;
inline constexpr double kNearestRatioPlain = 1e-4;

// Half angle in degrees below which a spot's face is not narrowed any more: a cone of no width has no
// projection.
inline constexpr double kNarrowestSpot = 0.01;

// Half angle in degrees up to which one perspective face serves a spot light; beyond, texels at its
// border would cover more than four times those at its centre (1 / cos^2 of 60 degrees).
inline constexpr double kWidestSpot = 60.0;

} // namespace gl
} // namespace hrt
