// See VertexOrder.h.
#include "Rendering/OpenGL2/VertexOrder.h"

#include <algorithm>
#include <limits>

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
VertexOrder::VertexOrder(const Geometry& mesh)
  : Mesh(mesh)
{
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  this->FirstPlaces.assign(mesh.vertexCount(), kNone);
  for (std::size_t i = mesh.triangleCount(); i-- > 0;)
  {
    this->FirstPlaces[mesh.triangles[i][2]] = static_cast<std::uint32_t>(i);
  }
  for (std::uint32_t vertex = 0; vertex < this->FirstPlaces.size(); ++vertex)
  {
    if (this->FirstPlaces[vertex] == kNone)
    {
      this->FirstPlaces[vertex] = static_cast<std::uint32_t>(this->size());
      this->Others.push_back(vertex);
    }
  }
}

//------------------------------------------------------------------------------
std::size_t VertexOrder::sizeFor(const Geometry& mesh)
{
  std::vector<bool> isLast(mesh.vertexCount(), false);
  for (const auto& triangle : mesh.triangles)
  {
    isLast[triangle[2]] = true;
  }
  return mesh.triangleCount() +
    static_cast<std::size_t>(std::count(isLast.begin(), isLast.end(), false));
}

} // namespace gl
} // namespace hrt
