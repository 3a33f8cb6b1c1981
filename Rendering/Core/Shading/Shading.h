// Compiles the shared sources (Shading.glsl, Sides.glsl, Surface.glsl) as C++: hrt::shading in single precision, as
// the GPU evaluates them, and hrt::shading64 in double, for geometry and references. Nothing is written
// twice.
#pragma once

#include "Rendering/Core/Math/Power.h"
#include "Rendering/Core/Snapshot.h"

#include <glm/glm.hpp>

#define HRT_FUNCTION inline
#define HRT_DIRECTION(v) ((v) / length(v))
#define HRT_SELECT(condition, a, b) ((condition) ? (a) : (b))
#define HRT_ANY(condition) (condition)
#define HRT_BOOL bool

namespace hrt
{
namespace shading
{
using glm::ivec2;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using real = float;
using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::floor;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::reflect;
using glm::sign;
using glm::sqrt;
inline float pow(float x, float y)
{
  return power(x, y);
}
inline vec3 pow(const vec3& x, const vec3& y)
{
  return { power(x.x, y.x), power(x.y, y.y), power(x.z, y.z) };
}
#include "Rendering/Core/Shading/Shading.glsl"
#include "Rendering/Core/Surface/Sides.glsl"
#include "Rendering/Core/Surface/Pbr.glsl"
#include "Rendering/Core/Surface/Surface.glsl"
}

namespace shading64
{
using glm::ivec2;
using glm::ivec4;
using glm::lessThanEqual;
using glm::sqrt;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using real = double;
using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::floor;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::reflect;
using glm::sign;
#include "Rendering/Core/Shading/Shading.glsl"
#include "Rendering/Core/Surface/Sides.glsl"
#include "Rendering/Core/Surface/Pbr.glsl"
#include "Rendering/Core/Surface/Surface.glsl"
}
} // namespace hrt

#undef HRT_FUNCTION
#undef HRT_DIRECTION
#undef HRT_SELECT
#undef HRT_ANY
#undef HRT_BOOL
