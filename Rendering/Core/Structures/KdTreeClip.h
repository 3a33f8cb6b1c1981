// Perfect splits: the bounds of what is left of a triangle within a cell on either side of a plane.
// "Perfect" against the bounds of the whole triangle: Wald and Havran 2006, section 4.3.3, gain up to
// a third of the traversal by it.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"

namespace hrt
{

struct KdSplitBounds
{
  KdBox lower;
  KdBox upper;
};

// `corners`: three. The plane must cut the triangle's part within the cell. Bounds are computed in
// double and rounded outward, but never beyond their half of the cell; neither is ever empty.
KdSplitBounds splitTriangle(const glm::vec3* corners, const KdBox& cell, int axis, float plane);

} // namespace hrt
