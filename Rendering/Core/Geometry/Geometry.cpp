// What a mesh knows about itself.
#include "Rendering/Core/Geometry/Geometry.h"

#include <algorithm>
#include <cmath>

namespace hrt
{

bool isFlat(const Geometry& geometry)
{
  glm::dvec3 normal(0.0), point(0.0);
  double reach = 0.0;
  for (const glm::vec3& p : geometry.positions)
  {
    reach = std::max({ reach, double(std::abs(p.x)), double(std::abs(p.y)), double(std::abs(p.z)) });
  }
  // Each coordinate of a position is rounded by at most reach * 2^-24; three of them, and the plane's
  // own three points, move a distance by less than eight of these.
  const double tolerance = 8.0 * 0x1p-24 * reach;
  for (std::size_t i = 0; i < geometry.triangleCount(); ++i)
  {
    const std::array<glm::vec3, 3> corners = geometry.cornerPositions(i);
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    if (normal == glm::dvec3(0.0))
    {
      const glm::dvec3 wound = glm::cross(b - a, c - a);
      normal = glm::dot(wound, wound) > 0.0 ? glm::normalize(wound) : glm::dvec3(0.0);
      point = a;
    }
    for (const glm::dvec3& corner : { a, b, c })
    {
      if (std::abs(glm::dot(corner - point, normal)) > tolerance)
      {
        return false;
      }
    }
  }
  return true;
}

} // namespace hrt
