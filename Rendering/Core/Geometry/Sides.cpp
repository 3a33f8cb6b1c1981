// Finds neighbours by the places of sides' ends.
#include "Rendering/Core/Geometry/Sides.h"

#include "Rendering/Core/Geometry/Geometry.h"

#include <cstring>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hrt
{

namespace
{

struct PlaceHash
{
  std::size_t operator()(const glm::vec3& p) const
  {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k)
    {
      const float value = p[k] + 0.0f; // minus zero is zero
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

// One number for all vertices at one place.
std::vector<std::uint32_t> placesOf(const Geometry& mesh)
{
  std::unordered_map<glm::vec3, std::uint32_t, PlaceHash> places;
  places.reserve(mesh.vertexCount());
  std::vector<std::uint32_t> placeOf;
  placeOf.reserve(mesh.vertexCount());
  for (const glm::vec3& p : mesh.positions)
  {
    placeOf.push_back(places.emplace(p, static_cast<std::uint32_t>(places.size())).first->second);
  }
  return placeOf;
}

} // namespace

void connectSides(Geometry& mesh)
{
  const std::vector<std::uint32_t> placeOf = placesOf(mesh);
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> open; // triangle, side
  open.reserve(mesh.triangleCount() * 3 / 2);
  for (std::uint32_t triangle = 0; triangle < mesh.triangleCount(); ++triangle)
  {
    for (std::uint32_t side = 0; side < 3; ++side)
    {
      std::uint32_t a = placeOf[mesh.triangles[triangle][side]];
      std::uint32_t b = placeOf[mesh.triangles[triangle][(side + 1) % 3]];
      if (b < a)
      {
        std::swap(a, b);
      }
      const auto added =
        open.emplace(std::uint64_t(a) << 32 | b, std::make_pair(triangle, side));
      if (!added.second)
      {
        const auto other = added.first->second;
        mesh.sides[triangle].neighbours[side] = other.first;
        mesh.sides[other.first].neighbours[other.second] = triangle;
        open.erase(added.first);
      }
    }
  }
}

} // namespace hrt
