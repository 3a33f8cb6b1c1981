// See ClippedPieces.h.
#include "Rendering/Scene/ClippedPieces.h"

#include "Rendering/Scene/GeometryCache.h"

#include "vtkMapper.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"

#include <algorithm>

namespace hrt
{
namespace scene
{
namespace
{

constexpr int kMostPlanes = 6;

} // namespace

//------------------------------------------------------------------------------
std::vector<ClippingPlane> clippingPlanesOf(vtkMapper* mapper, const glm::dmat4& localToWorld)
{
  std::vector<ClippingPlane> planes;
  vtkPlaneCollection* const all = mapper->GetClippingPlanes();
  const int count = all ? std::min(all->GetNumberOfItems(), kMostPlanes) : 0;
  for (int i = 0; i < count; ++i)
  {
    double n[3], o[3];
    all->GetItem(i)->GetNormal(n);
    all->GetItem(i)->GetOrigin(o);
    const glm::dvec3 normal(n[0], n[1], n[2]);
    const glm::dvec4 inWorld(normal, -glm::dot(normal, glm::dvec3(o[0], o[1], o[2])));
    // n.(M p) + d = (transpose(M) (n, d)).(p, 1)
    planes.push_back(glm::transpose(localToWorld) * inWorld);
  }
  return planes;
}

//------------------------------------------------------------------------------
std::shared_ptr<const Geometry> ClippedPieces::get(std::uint64_t piece,
  const std::shared_ptr<const Geometry>& mesh, const std::vector<ClippingPlane>& planes)
{
  Record& record = this->Records[piece];
  if (!record.left || record.version != mesh->version || record.planes != planes)
  {
    auto left = std::make_shared<Geometry>(clipped(*mesh, planes));
    left->version = nextGeometryVersion();
    record = { mesh->version, planes, left };
  }
  return record.left;
}

} // namespace scene
} // namespace hrt
