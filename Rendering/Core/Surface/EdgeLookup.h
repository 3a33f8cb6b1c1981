// The shared source of edges (Edges.glsl) compiled as C++, in double, over one part's mesh.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"
#include "Rendering/Core/Shading/Shading.h"

#include <glm/glm.hpp>

#include <cstddef>

namespace hrt
{
namespace shading64
{

// A view, as light as a pointer. Its functions are not const only because the source is GLSL too.
class EdgeLookup
{
public:
  // `toWindow` maps the mesh's positions to the window's homogeneous (x, y, z, w) about the pixel.
  EdgeLookup(const Geometry& mesh, const glm::dmat4& toWindow)
    : Mesh(mesh)
    , ToWindow(toWindow)
  {
  }

#define HRT_FUNCTION
#define HRT_SIDES(triangle) this->sides(triangle)
#define HRT_WINDOW_CORNER(triangle, k) this->corner(triangle, k)
#include "Rendering/Core/Surface/Edges.glsl"
#undef HRT_FUNCTION
#undef HRT_SIDES
#undef HRT_WINDOW_CORNER

  // The edge nearest to the pixel's centre, of that triangle alone.
  glm::dvec3 nearestOf(int triangle, double width)
  {
    return this->hrtNearestEdgeOf(this->corner(triangle, 0), this->corner(triangle, 1),
      this->corner(triangle, 2), this->sides(triangle).w, width);
  }

private:
  glm::ivec4 sides(int triangle) const
  {
    const TriangleSides& s = this->Mesh.sides[static_cast<std::size_t>(triangle)];
    return glm::ivec4(static_cast<int>(s.neighbours[0]), static_cast<int>(s.neighbours[1]),
      static_cast<int>(s.neighbours[2]), static_cast<int>(s.edges));
  }
  glm::dvec4 corner(int triangle, int k) const
  {
    const auto& corners = this->Mesh.triangles[static_cast<std::size_t>(triangle)];
    return this->ToWindow *
      glm::dvec4(glm::dvec3(this->Mesh.positions[corners[static_cast<std::size_t>(k)]]), 1.0);
  }

  const Geometry& Mesh;
  glm::dmat4 ToWindow;
};

} // namespace shading64
} // namespace hrt
