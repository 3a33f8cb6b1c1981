// Meshes written down as tests write them, by the corners of their triangles, and read back
// likewise.
#pragma once

#include "Rendering/Core/Geometry/Geometry.h"

#include <cstring>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace hrt
{
namespace meshes
{

// A mesh from three corners a triangle, with as many normals or none. Corners with the same bits
// are one vertex.
inline std::shared_ptr<Geometry> fromCorners(
  const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals = {})
{
  static std::uint64_t version = 0;
  auto mesh = std::make_shared<Geometry>();
  mesh->version = ++version;
  std::unordered_map<std::string, std::uint32_t> vertices;
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    std::string bits(reinterpret_cast<const char*>(&positions[i]), sizeof(glm::vec3));
    if (!normals.empty())
    {
      bits.append(reinterpret_cast<const char*>(&normals[i]), sizeof(glm::vec3));
    }
    const auto [vertex, added] =
      vertices.emplace(bits, static_cast<std::uint32_t>(mesh->positions.size()));
    if (added)
    {
      mesh->positions.push_back(positions[i]);
      if (!normals.empty())
      {
        mesh->normals.values.push_back(normals[i]);
      }
    }
    if (i % 3 == 0)
    {
      mesh->triangles.emplace_back();
      mesh->cellIds.push_back(static_cast<std::int64_t>(i / 3));
    }
    mesh->triangles.back()[i % 3] = vertex->second;
  }
  if (!mesh->positions.empty())
  {
    mesh->boundsMin = mesh->boundsMax = mesh->positions.front();
    for (const glm::vec3& p : mesh->positions)
    {
      mesh->boundsMin = glm::min(mesh->boundsMin, p);
      mesh->boundsMax = glm::max(mesh->boundsMax, p);
    }
  }
  return mesh;
}

// Three positions a triangle.
inline std::vector<glm::vec3> cornersOf(const Geometry& mesh)
{
  std::vector<glm::vec3> corners;
  for (std::size_t i = 0; i < mesh.triangleCount(); ++i)
  {
    const auto positions = mesh.cornerPositions(i);
    corners.insert(corners.end(), positions.begin(), positions.end());
  }
  return corners;
}

// Three values of an attribute a triangle; nothing where the mesh lacks it.
template <class T>
std::vector<T> atCorners(const Geometry& mesh, const Attribute<T>& attribute)
{
  std::vector<T> corners;
  for (std::size_t i = 0; i < mesh.triangleCount() && !attribute.empty(); ++i)
  {
    const auto values = mesh.cornersOf(attribute, i);
    corners.insert(corners.end(), values.begin(), values.end());
  }
  return corners;
}

} // namespace meshes
} // namespace hrt
