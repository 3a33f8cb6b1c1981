// Implements both shapes as surfaces of revolution: rings of points around an axis, joined by
// triangles; a ring of radius 0 is a single point.
#include "IO/BART/RoundShapes.h"

#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <vector>

namespace hrt
{
namespace bart
{
namespace
{

// With these the surface stays within 1 - cos(pi / 64) = 0.12 % of the radius from the true one.
constexpr int kSectors = 64;
constexpr int kSphereRings = 33; // its poles included

// A ring: its distance along the axis, its radius, and its normals' parts away from and along the
// axis.
struct Ring
{
  double height, radius, outward, along;
};

// The axis with two directions across it, right-handed.
struct Frame
{
  glm::dvec3 origin, axis, across, third;
};

//------------------------------------------------------------------------------
Frame frameAlong(const glm::dvec3& origin, const glm::dvec3& direction)
{
  const glm::dvec3 axis = glm::normalize(direction);
  const glm::dvec3 away = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(away, axis));
  return { origin, axis, across, glm::cross(axis, across) };
}

//------------------------------------------------------------------------------
class Revolution
{
public:
  // inside: the front faces and normals look to the axis.
  Revolution(const Frame& frame, bool inside)
    : Place(frame)
    , Inside(inside)
  {
    this->Normals->SetName("Normals");
    this->Normals->SetNumberOfComponents(3);
  }

  vtkSmartPointer<vtkPolyData> surfaceOf(const std::vector<Ring>& rings)
  {
    for (std::size_t i = 0; i < rings.size(); ++i)
    {
      this->First.push_back(this->Points->GetNumberOfPoints());
      this->addPoints(rings[i]);
      if (i > 0)
      {
        this->join(rings[i - 1], rings[i]);
      }
    }
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    surface->SetPoints(this->Points);
    surface->SetPolys(this->Faces);
    surface->GetPointData()->SetNormals(this->Normals);
    return surface;
  }

private:
  void addPoints(const Ring& ring)
  {
    // The tip of a cone has as many normals as sectors, hence as many points; a pole has one.
    const int points = ring.radius == 0.0 && ring.outward == 0.0 ? 1 : kSectors;
    for (int i = 0; i < points; ++i)
    {
      const double angle = glm::two_pi<double>() * i / kSectors;
      const glm::dvec3 radial =
        std::cos(angle) * this->Place.across + std::sin(angle) * this->Place.third;
      const glm::dvec3 point =
        this->Place.origin + ring.height * this->Place.axis + ring.radius * radial;
      const glm::dvec3 normal =
        (this->Inside ? -1.0 : 1.0) * (ring.outward * radial + ring.along * this->Place.axis);
      this->Points->InsertNextPoint(point.x, point.y, point.z);
      this->Normals->InsertNextTuple3(normal.x, normal.y, normal.z);
    }
  }

  // The quads between the last two rings, of which the lower one comes first; at a tip, triangles.
  void join(const Ring& lower, const Ring& upper)
  {
    for (int i = 0; i < kSectors; ++i)
    {
      const vtkIdType a = this->pointAt(1, i), b = this->pointAt(1, i + 1);
      const vtkIdType c = this->pointAt(0, i + 1), d = this->pointAt(0, i);
      if (lower.radius > 0.0)
      {
        this->addTriangle(a, b, upper.radius > 0.0 ? c : d);
      }
      if (upper.radius > 0.0)
      {
        this->addTriangle(a, c, d);
      }
    }
  }

  // Point i of the last ring (back = 0) or of the one before it.
  vtkIdType pointAt(std::size_t back, int i) const
  {
    const std::size_t ring = this->First.size() - 1 - back;
    const vtkIdType end = back == 0 ? this->Points->GetNumberOfPoints() : this->First[ring + 1];
    return this->First[ring] + i % (end - this->First[ring]);
  }

  void addTriangle(vtkIdType a, vtkIdType b, vtkIdType c)
  {
    this->Faces->InsertNextCell({ a, this->Inside ? c : b, this->Inside ? b : c });
  }

  const Frame Place;
  const bool Inside;
  std::vector<vtkIdType> First; // point of each ring
  vtkNew<vtkPoints> Points;
  vtkNew<vtkFloatArray> Normals;
  vtkNew<vtkCellArray> Faces;
};

} // anonymous namespace

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> toPolyData(const Sphere& sphere)
{
  const double radius = std::abs(sphere.radius);
  std::vector<Ring> rings;
  for (int i = 0; i < kSphereRings; ++i)
  {
    const double angle = glm::pi<double>() * i / (kSphereRings - 1);
    // Exactly 0 at both poles, which the sine of pi is not.
    const bool pole = i == 0 || i == kSphereRings - 1;
    const double outward = pole ? 0.0 : std::sin(angle), along = -std::cos(angle);
    rings.push_back({ radius * along, radius * outward, outward, along });
  }
  const Frame frame = frameAlong(sphere.center, glm::dvec3(0.0, 0.0, 1.0));
  return Revolution(frame, sphere.radius < 0.0).surfaceOf(rings);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> toPolyData(const Cone& cone)
{
  const bool inside = cone.baseRadius < 0.0 || cone.apexRadius < 0.0;
  const double base = std::abs(cone.baseRadius), apex = std::abs(cone.apexRadius);
  const double height = glm::length(cone.apex - cone.base);
  // Across the slope, which falls by base - apex over the height.
  const double slope = std::hypot(height, base - apex);
  const double outward = height / slope, along = (base - apex) / slope;
  const Frame frame = frameAlong(cone.base, cone.apex - cone.base);
  return Revolution(frame, inside)
    .surfaceOf({ { 0.0, base, outward, along }, { height, apex, outward, along } });
}

} // namespace bart
} // namespace hrt
