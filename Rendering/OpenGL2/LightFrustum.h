// Fits the shadow maps' projections to the scene: which faces a light needs, what each face sees and
// how large a texel is there. Plain arithmetic in double precision, without GL.
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
  // Largest distance of a caster from the light or, for a directional light, depth of the map.
  double reach = 1.0;
};

// The faces of a light's map of the given resolution: one for a directional light (orthographic) and
// for a spot light, six (a cube) for a point light and for a spot wider than kWidestSpot. Empty when
// the light cannot cast or nothing casts.
std::vector<LightFace> fitLightFaces(const Snapshot& snapshot, const Light& light, int resolution);

// Half angle in degrees up to which one perspective face serves a spot light; beyond, texels at its
// border would cover more than four times those at its centre (1 / cos^2 of 60 degrees).
inline constexpr double kWidestSpot = 60.0;

} // namespace gl
} // namespace hrt
