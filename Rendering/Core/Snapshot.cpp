// What a snapshot knows about itself: rays from its matrices, boxes, whose triangle an id is, and
// what is new in it since the last frame.
#include "Rendering/Core/Snapshot.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace hrt
{

namespace
{

glm::dvec4 row(const glm::dmat4& m, int i)
{
  return { m[0][i], m[1][i], m[2][i], m[3][i] };
}

// Solves r0.p = b.x, r1.p = b.y, r2.p = b.z by Cramer's rule. A singular system (a projection that
// sees nothing) gives non-finite values, which every engine takes for rays that miss.
glm::dvec3 solve(
  const glm::dvec3& r0, const glm::dvec3& r1, const glm::dvec3& r2, const glm::dvec3& b)
{
  const glm::dvec3 n0 = glm::cross(r1, r2);
  const glm::dvec3 n1 = glm::cross(r2, r0);
  const glm::dvec3 n2 = glm::cross(r0, r1);
  return (b.x * n0 + b.y * n1 + b.z * n2) / glm::dot(r0, n0);
}

// The rays of any projection. With the matrix's rows rx, ry, rz, rw a pixel (x, y) sees the points
// p with (rx - x rw).p = 0 and (ry - y rw).p = 0: a line along
//   cross(rx - x rw, ry - y rw) = cross(rx, ry) - y cross(rx, rw) - x cross(rw, ry),
// which is affine in x and y. No field of view, no near plane, no case for an off-centre window.
CameraRays raysOf(const glm::dmat4& toClip)
{
  const glm::dvec4 rx = row(toClip, 0), ry = row(toClip, 1), rz = row(toClip, 2),
                   rw = row(toClip, 3);
  const glm::dvec3 nx(rx), ny(ry), nz(rz), nw(rw);
  const bool parallel = nw == glm::dvec3(0.0);

  CameraRays rays;
  rays.direction0 = glm::cross(nx, ny);
  rays.directionX = -glm::cross(nw, ny);
  rays.directionY = -glm::cross(nx, nw);
  // Away from the viewer w grows (perspective; the same rate for every pixel, because both affine
  // terms are normal to nw) or z/w does (parallel).
  const double outward =
    parallel ? glm::dot(rays.direction0, nz) * rw.w : glm::dot(rays.direction0, nw);
  if (outward < 0.0)
  {
    rays.direction0 = -rays.direction0;
    rays.directionX = -rays.directionX;
    rays.directionY = -rays.directionY;
  }

  if (parallel)
  {
    // From the near plane, z = -w, where w = rw.w everywhere.
    rays.origin0 = solve(nx, ny, nz, { -rx.w, -ry.w, -rw.w - rz.w });
    rays.originX = solve(nx, ny, nz, { rw.w, 0.0, 0.0 });
    rays.originY = solve(nx, ny, nz, { 0.0, rw.w, 0.0 });
    rays.directionX = rays.directionY = glm::dvec3(0.0); // already zero, but not minus zero
  }
  else
  {
    // From the eye, where x, y and w vanish together.
    rays.origin0 = solve(nx, ny, nw, { -rx.w, -ry.w, -rw.w });
  }
  return rays;
}

glm::dmat4 translation(const glm::dvec3& by)
{
  glm::dmat4 m(1.0);
  m[3] = glm::dvec4(by, 1.0);
  return m;
}

bool sameShape(const Light& a, const Light& b)
{
  return a.kind == b.kind && a.isHeadlight == b.isHeadlight &&
    a.castsShadows == b.castsShadows && a.position == b.position &&
    a.direction == b.direction && a.coneAngle == b.coneAngle;
}

bool sameColors(const Light& a, const Light& b)
{
  return a.color == b.color && a.attenuation == b.attenuation && a.exponent == b.exponent;
}

bool sameCopies(const Part& a, const Part& b)
{
  return (a.copies ? a.copies->version : 0) == (b.copies ? b.copies->version : 0);
}

// Holes are a matter of what is seen where, as triangles are.
bool sameHoles(const Part& a, const Part& b)
{
  return a.perforated == b.perforated &&
    (!a.perforated || a.material.textures == b.material.textures);
}

bool sameTriangles(const Part& a, const Part& b)
{
  return a.key == b.key && a.geometry->version == b.geometry->version && sameCopies(a, b) &&
    a.firstTriangle == b.firstTriangle && a.visibleToCamera == b.visibleToCamera &&
    a.visibleToRays == b.visibleToRays && a.castsShadow == b.castsShadow &&
    a.tintsShadow == b.tintsShadow && sameHoles(a, b);
}

bool sameCulling(const Material& a, const Material& b)
{
  return a.cullFront == b.cullFront && a.cullBack == b.cullBack && a.depthOffset == b.depthOffset;
}

template <class Item>
std::unordered_map<std::uint64_t, const Item*> byKey(const std::vector<Item>& items)
{
  std::unordered_map<std::uint64_t, const Item*> found;
  found.reserve(items.size());
  for (const Item& item : items)
  {
    found.emplace(item.key, &item);
  }
  return found;
}

void compareParts(const Snapshot& before, const Snapshot& now, Changes& changes)
{
  changes.geometry = !std::equal(before.parts.begin(), before.parts.end(), now.parts.begin(),
    now.parts.end(), sameTriangles);
  // A new origin moves every part in the coordinates that the engines work in.
  changes.transforms = before.origin != now.origin;
  const auto earlier = byKey(before.parts);
  for (const Part& part : now.parts)
  {
    const auto match = earlier.find(part.key);
    if (match == earlier.end())
    {
      continue; // a new part: that is `geometry`
    }
    const Part& old = *match->second;
    changes.transforms = changes.transforms || old.localToWorld != part.localToWorld;
    changes.materials = changes.materials || old.material != part.material;
    changes.culling = changes.culling || !sameCulling(old.material, part.material);
  }
}

void compareLights(const Snapshot& before, const Snapshot& now, Changes& changes)
{
  changes.lightColors = before.singleHeadlight != now.singleHeadlight;
  // Maps are cached by a light's place in the list, so that another order is another set of lights.
  changes.lightCount = !std::equal(before.lights.begin(), before.lights.end(), now.lights.begin(),
    now.lights.end(), [](const Light& a, const Light& b) { return a.key == b.key; });
  const auto earlier = byKey(before.lights);
  for (std::size_t i = 0; i < now.lights.size(); ++i)
  {
    const Light& light = now.lights[i];
    const auto match = earlier.find(light.key);
    // A directional headlight shines from the eye's plane on, which a parallel camera has not.
    const bool fromElsewhere =
      light.isHeadlight && before.camera.parallel != now.camera.parallel;
    changes.lightMoved[i] =
      match == earlier.end() || !sameShape(*match->second, light) || fromElsewhere;
    changes.lightColors =
      changes.lightColors || (match != earlier.end() && !sameColors(*match->second, light));
  }
}

} // namespace

glm::dmat4 Camera::clipToWindow() const
{
  glm::dmat4 m(1.0);
  m[0][0] = m[3][0] = 0.5 * this->width;
  m[1][1] = m[3][1] = 0.5 * this->height;
  return m;
}

CameraRays Camera::viewRays() const
{
  return raysOf(this->viewToClip);
}

CameraRays Camera::worldRays(const glm::dvec3& sceneOrigin) const
{
  // The large numbers cancel in the matrix that takes scene-relative points to the view, before
  // they meet the projection; a view matrix need not even be affine.
  return raysOf(this->viewToClip * (this->worldToView * translation(sceneOrigin)));
}

std::size_t Snapshot::partOf(TriangleId id) const
{
  // The last part that starts at or before the id. An empty part shares its start with the part
  // that follows it, and those at the very end start behind the last id: the last one that fits is
  // never empty.
  const auto next = std::upper_bound(this->parts.begin(), this->parts.end(), id,
    [](TriangleId value, const Part& candidate) { return value < candidate.firstTriangle; });
  return static_cast<std::size_t>(next - this->parts.begin()) - 1;
}

bool Snapshot::drawnAfter(TriangleId one, TriangleId other) const
{
  const std::uint32_t prop = this->parts[this->partOf(one)].source.prop;
  const std::uint32_t otherProp = this->parts[this->partOf(other)].source.prop;
  return prop != otherProp ? prop > otherProp : one > other;
}

Changes compareSnapshots(const Snapshot* before, const Snapshot& now)
{
  Changes changes;
  changes.lightMoved.assign(now.lights.size(), true);
  if (!before)
  {
    return changes;
  }
  changes.first = false;
  changes.camera = !(before->camera == now.camera);
  changes.background = !(before->background == now.background);
  changes.materials = false;
  changes.culling = false;
  compareParts(*before, now, changes);
  compareLights(*before, now, changes);
  return changes;
}

namespace
{

// Includes the box as the matrix places it.
void includeBox(const glm::dmat4& matrix, const glm::dvec3& from, const glm::dvec3& to,
  glm::dvec3& lower, glm::dvec3& upper)
{
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 local((corner & 1) ? to.x : from.x, (corner & 2) ? to.y : from.y,
      (corner & 4) ? to.z : from.z, 1.0);
    const glm::dvec3 placed(matrix * local);
    lower = glm::min(lower, placed);
    upper = glm::max(upper, placed);
  }
}

const glm::dvec3 kNowhere(std::numeric_limits<double>::infinity());

} // namespace

void worldBounds(const Part& part, glm::dvec3& lower, glm::dvec3& upper)
{
  const Geometry& geometry = *part.geometry;
  if (part.triangleCount() == 0)
  {
    lower = glm::dvec3(0.0);
    upper = glm::dvec3(-1.0);
    return;
  }
  lower = kNowhere;
  upper = -kNowhere;
  if (part.copies)
  {
    includeBox(part.localToWorld, part.copies->boundsMin, part.copies->boundsMax, lower, upper);
    return;
  }
  includeBox(part.positionsToWorld(), glm::dvec3(geometry.boundsMin),
    glm::dvec3(geometry.boundsMax), lower, upper);
}

void boundCopies(const Geometry& geometry, Copies& copies)
{
  copies.boundsMin = kNowhere;
  copies.boundsMax = -kNowhere;
  copies.largest = glm::dmat4(0.0);
  for (std::size_t i = 0; i < copies.count(); ++i)
  {
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 4; ++column)
      {
        const double size = std::abs(double(copies.rows[i][static_cast<std::size_t>(row)][column]));
        copies.largest[column][row] = std::max(copies.largest[column][row], size);
      }
    }
    includeBox(copies.matrix(i), geometry.origin + glm::dvec3(geometry.boundsMin),
      geometry.origin + glm::dvec3(geometry.boundsMax), copies.boundsMin, copies.boundsMax);
  }
}

} // namespace hrt
