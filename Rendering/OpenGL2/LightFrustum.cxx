// See LightFrustum.h.
#include "Rendering/OpenGL2/LightFrustum.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hrt
{
namespace gl
{
namespace
{

// Room around the fitted box and cone, in texels: a texel whose centre lies just outside of a
// caster's outline still belongs to a bilinear footprint that straddles it.
constexpr double kBorderTexels = 2.0;

// Margin of the near and far planes, so that no caster lies on them.
constexpr double kDepthMargin = 1e-3;

struct Box
{
  glm::dvec3 lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 upper{ -std::numeric_limits<double>::infinity() };

  bool valid() const { return this->lower.x <= this->upper.x; }
  void add(const glm::dvec3& p)
  {
    this->lower = glm::min(this->lower, p);
    this->upper = glm::max(this->upper, p);
  }
  glm::dvec3 corner(int k) const
  {
    return { k & 1 ? this->upper.x : this->lower.x, k & 2 ? this->upper.y : this->lower.y,
      k & 4 ? this->upper.z : this->lower.z };
  }
};

Box boundsOf(const Part& part)
{
  Box box;
  worldBounds(part, box.lower, box.upper);
  return box;
}

Box casterBounds(const Snapshot& snapshot, const std::vector<bool>& casters)
{
  Box box;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    if (casters[i])
    {
      const Box part = boundsOf(snapshot.parts[i]);
      box.add(part.lower);
      box.add(part.upper);
    }
  }
  return box;
}

// The plane of a flat part, its normal towards the light; false when the light lies in it.
bool litPlane(const Part& part, const Light& light, glm::dvec3& normal, glm::dvec3& point)
{
  const glm::dmat4 toWorld = part.positionsToWorld();
  const auto world = [&](const glm::vec3& position) {
    return glm::dvec3(toWorld * glm::dvec4(glm::dvec3(position), 1.0));
  };
  // Without a triangle there is no plane: a zero normal has no lit side.
  normal = point = glm::dvec3(0.0);
  for (std::size_t i = 0; i < part.geometry->triangleCount(); ++i)
  {
    const std::array<glm::vec3, 3> corners = part.geometry->cornerPositions(i);
    point = world(corners[0]);
    normal = glm::cross(world(corners[1]) - point, world(corners[2]) - point);
    if (glm::dot(normal, normal) > 0.0)
    {
      break;
    }
  }
  const double side = light.kind == Light::Kind::Directional
    ? -glm::dot(normal, light.direction)
    : glm::dot(normal, light.position - point);
  normal = side < 0.0 ? -normal : normal;
  return side != 0.0;
}

// All that the camera sees, the part itself apart, lies on the lit side of the part's plane.
bool shadowsNothing(const Snapshot& snapshot, std::size_t index, const Light& light)
{
  const Part& part = snapshot.parts[index];
  glm::dvec3 normal, point;
  if (!part.isFlat() || !litPlane(part, light, normal, point))
  {
    return false;
  }
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    const Part& other = snapshot.parts[i];
    if (i == index || !other.visibleToCamera || other.triangleCount() == 0)
    {
      continue;
    }
    const Box box = boundsOf(other);
    // What stands on the floor touches its plane but for the rounding of its own corners.
    const glm::dvec3 size = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    const double tolerance = 8.0 * 0x1p-24 * glm::length(normal) * glm::length(size);
    for (int k = 0; k < 8; ++k)
    {
      if (glm::dot(box.corner(k) - point, normal) < -tolerance)
      {
        return false;
      }
    }
  }
  return true;
}

// A right-handed view frame that looks along a unit direction from a point. glm::lookAt asks for a second
// point, in which large coordinates would swallow the direction.
glm::dmat4 lookAlong(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& up)
{
  return glm::lookAt(glm::dvec3(0.0), direction, up) * glm::translate(glm::dmat4(1.0), -eye);
}

// Not nearly along the direction.
glm::dvec3 upwards(const glm::dvec3& direction)
{
  return std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
}

LightFace directionalFace(
  const Snapshot& snapshot, const Light& light, const Box& casters, int resolution)
{
  const glm::dvec3 centre = 0.5 * (casters.lower + casters.upper);
  const glm::dmat4 view = lookAlong(centre, light.direction, upwards(light.direction));
  Box box;
  for (int k = 0; k < 8; ++k)
  {
    box.add(glm::dvec3(view * glm::dvec4(casters.corner(k), 1.0)));
  }
  // One square texel size in both directions; an empty extent (one flat caster seen edge-on) still
  // needs a frustum.
  const double extent = glm::length(casters.upper - casters.lower);
  const glm::dvec2 middle = 0.5 * (glm::dvec2(box.lower) + glm::dvec2(box.upper));
  const double half = 0.5 * std::max({ box.upper.x - box.lower.x, box.upper.y - box.lower.y,
                              extent * kDepthMargin, std::numeric_limits<double>::min() });
  const double padded = half / (1.0 - 2.0 * kBorderTexels / resolution);

  LightFace face;
  const double margin = std::max(extent * kDepthMargin, std::numeric_limits<double>::min());
  face.near = -box.upper.z - margin;
  face.far = -box.lower.z + margin;
  if (light.isHeadlight && !snapshot.camera.parallel)
  {
    // A headlight shines from the plane through the viewer's eye on, not from behind.
    face.near = std::max(face.near, -(view * glm::dvec4(light.position, 1.0)).z);
    face.far = std::max(face.far, face.near + margin);
  }
  face.worldToClip = glm::ortho(middle.x - padded, middle.x + padded, middle.y - padded,
                       middle.y + padded, face.near, face.far) *
    view;
  face.texelConstant = 2.0 * padded / resolution;
  return face;
}

LightFace perspectiveFace(const Light& light, const glm::dvec3& direction, const glm::dvec3& up,
  double halfAngle, double near, double far, int resolution)
{
  const double tangent = std::tan(halfAngle) / (1.0 - 2.0 * kBorderTexels / resolution);
  LightFace face;
  face.perspective = true;
  face.near = near;
  face.far = far;
  face.worldToClip = glm::frustum(-near * tangent, near * tangent, -near * tangent,
                       near * tangent, near, far) *
    lookAlong(light.position, direction, up);
  face.texelLinear = 2.0 * tangent / resolution;
  return face;
}

// Distances of the casters' box from a point: nearest (0 inside) and farthest.
void distanceRange(const Box& box, const glm::dvec3& p, double& nearest, double& farthest)
{
  nearest = glm::length(glm::max(glm::max(box.lower - p, p - box.upper), glm::dvec3(0.0)));
  farthest = 0.0;
  for (int k = 0; k < 8; ++k)
  {
    farthest = std::max(farthest, glm::length(box.corner(k) - p));
  }
}

std::vector<LightFace> positionalFaces(
  const Light& light, const Box& casters, int resolution, double nearestRatio)
{
  double nearest = 0.0, farthest = 0.0;
  distanceRange(casters, light.position, nearest, farthest);
  if (!(farthest > 0.0))
  {
    return {};
  }
  const double far = farthest * (1.0 + kDepthMargin);
  std::vector<LightFace> faces;
  if (light.coneAngle <= kWidestSpot)
  {
    // Within the cone a caster at distance r lies at least r * cos(cone) ahead.
    const double half = glm::radians(std::max(double(light.coneAngle), kNarrowestSpot));
    const double near =
      std::max(nearest * std::cos(half) * (1.0 - kDepthMargin), far * nearestRatio);
    faces.push_back(perspectiveFace(
      light, light.direction, upwards(light.direction), half, near, far, resolution));
    return faces;
  }
  // On a cube face a caster at distance r lies at least r / sqrt(3) ahead.
  const double near =
    std::max(nearest / std::sqrt(3.0) * (1.0 - kDepthMargin), far * nearestRatio);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (double sign : { 1.0, -1.0 })
    {
      glm::dvec3 direction(0.0), up(0.0);
      direction[axis] = sign;
      up[(axis + 1) % 3] = 1.0;
      faces.push_back(perspectiveFace(
        light, direction, up, glm::radians(45.0), near, far, resolution));
    }
  }
  return faces;
}

} // namespace

//------------------------------------------------------------------------------
std::vector<bool> castersFor(const Snapshot& snapshot, const Light& light)
{
  std::vector<bool> casters;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    const Part& part = snapshot.parts[i];
    casters.push_back(part.castsShadowInMaps() && part.triangleCount() > 0 &&
      !shadowsNothing(snapshot, i, light));
  }
  return casters;
}

//------------------------------------------------------------------------------
std::vector<LightFace> fitLightFaces(const Snapshot& snapshot, const Light& light,
  const std::vector<bool>& casters, int resolution, double nearestRatio)
{
  const Box bounds = casterBounds(snapshot, casters);
  if (!bounds.valid())
  {
    return {};
  }
  if (light.kind == Light::Kind::Directional)
  {
    return { directionalFace(snapshot, light, bounds, resolution) };
  }
  return positionalFaces(light, bounds, resolution, nearestRatio);
}

} // namespace gl
} // namespace hrt
