// Implements blocks of surface points.
#include "Rendering/Core/Tracing/SurfaceBlock.h"

namespace hrt
{

SurfaceBlock::SurfaceBlock(const Surfaces& surfaces, const SurfaceKernels& kernels)
  : Points(surfaces)
  , Kernels(kernels)
{
}

void SurfaceBlock::pixelRays(const PixelRays& camera, unsigned int count)
{
  for (unsigned int lane = count; lane < kLanes; ++lane)
  {
    this->Lanes.pixel[lane] = this->Lanes.pixel[0];
  }
  this->Kernels.pixelRays(camera, this->Lanes);
}

Ray SurfaceBlock::ray(unsigned int lane) const
{
  Ray ray;
  ray.origin = vectorOf(this->Lanes.origin, lane);
  ray.direction = vectorOf(this->Lanes.direction, lane);
  return ray;
}

void SurfaceBlock::setDirection(unsigned int lane, const glm::dvec3& direction)
{
  setVector(this->Lanes.direction, lane, direction);
}

void SurfaceBlock::set(unsigned int lane, TriangleId triangle)
{
  Surfaces::Site& site = this->Sites[lane];
  this->Points.find(triangle, site);
  const Geometry& mesh = *site.part->geometry;
  const std::array<glm::vec3, 3> corners = mesh.cornerPositions(site.triangle);
  const std::array<glm::vec3, 3> normals = mesh.normals.empty()
    ? std::array<glm::vec3, 3>{ glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f) }
    : mesh.cornersOf(mesh.normals, site.triangle);
  for (std::size_t k = 0; k < 3; ++k)
  {
    setVector(this->Lanes.corner[k], lane, corners[k]);
    setVector(this->Lanes.normal[k], lane, normals[k]);
  }
  this->Lanes.toScene[lane] = &site.placement->toScene[0][0];
  this->Lanes.normalsToScene[lane] = &site.placement->normalsToScene[0][0];
}

void SurfaceBlock::setHit(unsigned int lane, const Hit& hit)
{
  this->Lanes.t[lane] = hit.t;
  this->Lanes.u[lane] = hit.u;
  this->Lanes.v[lane] = hit.v;
}

Hit SurfaceBlock::hit(unsigned int lane) const
{
  return { this->Sites[lane].id, this->Lanes.t[lane], this->Lanes.u[lane], this->Lanes.v[lane] };
}

void SurfaceBlock::repeat(unsigned int lane, unsigned int of)
{
  SurfaceLanes& l = this->Lanes;
  for (int axis = 0; axis < 3; ++axis)
  {
    l.origin[axis][lane] = l.origin[axis][of];
    l.direction[axis][lane] = l.direction[axis][of];
    for (int k = 0; k < 3; ++k)
    {
      l.corner[k][axis][lane] = l.corner[k][axis][of];
      l.normal[k][axis][lane] = l.normal[k][axis][of];
    }
  }
  l.toScene[lane] = l.toScene[of];
  l.normalsToScene[lane] = l.normalsToScene[of];
  l.t[lane] = l.t[of];
  l.u[lane] = l.u[of];
  l.v[lane] = l.v[of];
}

unsigned int SurfaceBlock::meet(unsigned int count, bool exactly)
{
  for (unsigned int lane = count; lane < kLanes; ++lane)
  {
    this->repeat(lane, 0);
  }
  return (exactly ? this->Kernels.meetExactly : this->Kernels.meet)(this->Lanes) &
    ((1u << count) - 1u);
}

void SurfaceBlock::evaluate(unsigned int count, unsigned int bits, const glm::dvec3* eye)
{
  const auto first = static_cast<unsigned int>(__builtin_ctz(bits));
  for (unsigned int lane = 0; lane < kLanes; ++lane)
  {
    if (((bits >> lane) & 1u) == 0)
    {
      this->repeat(lane, first);
    }
  }
  this->Lanes.seenFromEye = eye != nullptr;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Lanes.eye[axis] = eye ? (*eye)[axis] : 0.0;
  }
  this->Kernels.surface(this->Lanes);
  for (unsigned int lane = 0; lane < count; ++lane)
  {
    if (((bits >> lane) & 1u) == 0)
    {
      continue;
    }
    const Surfaces::Site& site = this->Sites[lane];
    if (((this->Lanes.border >> lane) & 1u) != 0)
    {
      setVector(this->Lanes.start, lane,
        Surfaces::startOnBorder(site, this->hit(lane), this->Lanes.positionError[lane]));
    }
    this->Points.color(site, static_cast<float>(this->Lanes.u[lane]),
      static_cast<float>(this->Lanes.v[lane]), this->isFront(lane), this->Colorings[lane]);
  }
}

SurfacePoint SurfaceBlock::point(unsigned int lane) const
{
  const Surfaces::Site& site = this->Sites[lane];
  SurfacePoint point;
  point.triangle = site.id;
  point.part = site.index;
  point.material = &site.part->material;
  point.position = this->position(lane);
  point.geometricNormal = this->geometricNormal(lane);
  point.normal = vectorOf(this->Lanes.shadingNormal, lane);
  point.frontSide = this->isFront(lane);
  point.outside = point.frontSide != site.placement->mirrored;
  // hrtSmoothNormal of the other side is the same vector turned, but for a triangle's own.
  const bool smooth = ((this->Lanes.smooth >> lane) & 1u) != 0;
  point.opticalNormal =
    point.outside == point.frontSide || !smooth ? point.normal : -point.normal;
  const SurfaceColoring& coloring = this->Colorings[lane];
  point.colors = coloring.colors;
  point.edgeShare = 0.0f;
  point.textureColor = coloring.textureColor;
  point.diffuseColor = coloring.diffuseColor;
  point.opacity = coloring.opacity;
  point.start = vectorOf(this->Lanes.start, lane);
  point.arrival = vectorOf(this->Lanes.direction, lane);
  point.positionError = this->Lanes.positionError[lane];
  point.twinReach = this->Points.coincidence().twinReach(site.index);
  return point;
}

} // namespace hrt
