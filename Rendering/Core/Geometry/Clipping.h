// A mesh cut by planes, as mappers with clipping planes show it: what lies behind a plane is not there,
// for the camera, for rays and for light.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"

#include <glm/glm.hpp>

#include <vector>

namespace hrt
{

// (n, d): the half space n.p + d >= 0 is kept, in the local coordinates of the mesh (Geometry::origin
// added to the positions).
using ClippingPlane = glm::dvec4;

// What is left of the mesh; its version is not set. A cut triangle becomes one or two, of the same cell.
// Where an edge is cut, its triangles share the new vertex: what was closed has one hole a plane, and
// none beside. Attributes of vertices are interpolated, in double, and rounded once.
Geometry clipped(const Geometry& mesh, const std::vector<ClippingPlane>& planes);

} // namespace hrt
