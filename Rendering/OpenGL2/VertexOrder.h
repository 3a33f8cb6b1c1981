// The order in which a mesh's vertices are drawn. A triangle's number must reach the fragments, and
// gl_PrimitiveID is broken in several drivers; gl_VertexID is not, and of a flat output all fragments
// get the value of the triangle's last corner. So vertex i is the last corner of triangle i; behind
// these come the vertices that are nobody's last corner. A vertex that is the last corner of several
// triangles is there as often; the other corners name one copy of theirs. A closed mesh has half as
// many vertices as triangles: a rasteriser thus shades about one vertex a triangle instead of three.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hrt
{
namespace gl
{

class VertexOrder
{
public:
  explicit VertexOrder(const Geometry& mesh);

  // How many vertices are drawn, copies counted: without and with an order.
  static std::size_t sizeFor(const Geometry& mesh);
  std::size_t size() const { return this->Mesh.triangleCount() + this->Others.size(); }

  // The mesh's vertex in a place of the order.
  std::uint32_t vertexAt(std::size_t place) const
  {
    const std::size_t triangles = this->Mesh.triangleCount();
    return place < triangles ? this->Mesh.triangles[place][2] : this->Others[place - triangles];
  }

  // Calls visit(corners) for each triangle in turn, with the places of its corners. Of several copies
  // the other corners name the one last passed, which a vertex cache still holds, else the first one.
  template <class Visit>
  void forEachTriangle(Visit visit) const
  {
    std::vector<std::uint32_t> place = this->FirstPlaces;
    for (std::size_t i = 0; i < this->Mesh.triangleCount(); ++i)
    {
      const std::array<std::uint32_t, 3>& t = this->Mesh.triangles[i];
      place[t[2]] = static_cast<std::uint32_t>(i);
      visit(std::array<std::uint32_t, 3>{ place[t[0]], place[t[1]], place[t[2]] });
    }
  }

private:
  const Geometry& Mesh;
  std::vector<std::uint32_t> Others;      // vertices that are no last corner
  std::vector<std::uint32_t> FirstPlaces; // of each vertex
};

} // namespace gl
} // namespace hrt
