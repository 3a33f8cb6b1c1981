// From a snapshot's light to the one the shared shading source takes, in any rigid frame: the GPU
// asks for its frame's, the tracer for world coordinates relative to the scene's origin.
#pragma once

#include "Rendering/Core/Shading/Shading.h"
#include "Rendering/Core/Snapshot.h"

#include <glm/gtc/matrix_inverse.hpp>

namespace hrt
{

// Cosine that no direction reaches: the light has no cone (see hrtAttenuation).
inline constexpr float kNoCone = -2.0f;

// `frame` maps world coordinates to those in which the surface will be shaded, where lengths are `scale` times
// as long as VTK's, by which light is attenuated.
inline shading::HrtLight shadingLight(
  const Light& light, bool singleHeadlight, const glm::dmat4& frame,
  double scale = 1.0)
{
  shading::HrtLight l;
  l.position = glm::vec3(frame * glm::dvec4(light.position, 1.0));
  // As VTK transforms it: like a normal, which differs only in views that are not rigid.
  l.direction =
    glm::vec3(glm::normalize(glm::inverseTranspose(glm::dmat3(frame)) * light.direction));
  l.color = light.color;
  l.attenuation =
    glm::vec3(glm::dvec3(light.attenuation) / glm::dvec3(1.0, scale, scale * scale));
  l.cosCone =
    light.isSpot() ? static_cast<float>(glm::cos(glm::radians(double(light.coneAngle)))) : kNoCone;
  l.exponent = light.exponent;
  l.kind = singleHeadlight ? HRT_LIGHT_SINGLE_HEADLIGHT
    : light.kind == Light::Kind::Positional ? HRT_LIGHT_POSITIONAL
                                            : HRT_LIGHT_DIRECTIONAL;
  return l;
}

} // namespace hrt
