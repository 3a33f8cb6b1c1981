// The meshes of a mapper with clipping planes, cut by them. Planes are in the world: where the actor
// moves, another part of its mesh is left.
#pragma once

#include "Rendering/Core/Geometry/Clipping.h"
#include "Rendering/Core/Snapshot.h"

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

class vtkMapper;

namespace hrt
{
namespace scene
{

// The mapper's planes in the local coordinates of what it draws. VTK's mappers take the first six.
std::vector<ClippingPlane> clippingPlanesOf(vtkMapper* mapper, const glm::dmat4& localToWorld);

class ClippedPieces
{
public:
  // The piece's mesh, cut; the one of the last call where neither mesh nor planes have changed.
  std::shared_ptr<const Geometry> get(std::uint64_t piece,
    const std::shared_ptr<const Geometry>& mesh, const std::vector<ClippingPlane>& planes);

private:
  struct Record
  {
    std::uint64_t version = 0; // of the whole mesh
    std::vector<ClippingPlane> planes;
    std::shared_ptr<const Geometry> left;
  };
  std::unordered_map<std::uint64_t, Record> Records;
};

} // namespace scene
} // namespace hrt
