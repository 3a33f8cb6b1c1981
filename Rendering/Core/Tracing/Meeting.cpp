// Implements the sets.
#include "Rendering/Core/Tracing/Meeting.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hrt
{

// Leaves those that lie in one place with the hit.
void Meetings::keepThoseAt(const Hit& hit, std::vector<Hit>& members) const
{
  const glm::dvec3 position = this->Points.positionOf(hit);
  const Coincidence& surfaces = this->Points.coincidence();
  const auto elsewhere = [&](const Hit& other) {
    return other.triangle != hit.triangle &&
      !surfaces.inOnePlace(hit.triangle, other.triangle, position, kSetMargin);
  };
  members.erase(std::remove_if(members.begin(), members.end(), elsewhere), members.end());
}

void Meetings::gather(const Ray& ray, const Hit& nearest, std::vector<Hit>& members) const
{
  Ray upToThere = ray;
  const double end = this->Points.coincidence().windowOf(ray.direction).end(nearest.t);
  upToThere.tMaximum =
    std::min(ray.tMaximum, std::nextafter(end, std::numeric_limits<double>::infinity()));
  this->Rays.intersectAll(upToThere, members);
  this->keepThoseAt(nearest, members);
}

void Meetings::gatherAround(const Ray& ray, const Hit& hit, std::vector<Hit>& members) const
{
  // A short ray across the surface: it begins a window before the hit.
  const HitWindow window = this->Points.coincidence().windowOf(ray.direction);
  const double before = window.end(hit.t) - hit.t;
  Ray across = ray;
  across.origin = ray.origin + (hit.t - before) * ray.direction;
  across.tMaximum = 2.0 * before;
  this->Rays.intersectAll(across, members);
  this->keepThoseAt(hit, members);
  const auto itself = [&hit](const Hit& other) { return other.triangle == hit.triangle; };
  if (std::none_of(members.begin(), members.end(), itself))
  {
    members.push_back(hit); // the ray passes next to the triangle that the rasteriser has named
  }
}

void Meetings::order(const glm::dvec3& direction, TriangleId from, std::vector<Hit>& members,
  TriangleId first) const
{
  if (members.size() < 2)
  {
    return;
  }
  const std::size_t last =
    from == kNoTriangle ? this->Scene.parts.size() : this->Scene.partOf(from);
  const auto rank = [&](const Hit& hit, const SurfacePoint& point) {
    if (hit.triangle == first)
    {
      return -1;
    }
    if (this->GlassRefracts && point.material->isGlass())
    {
      return point.outside ? 3 : (point.part == last ? 0 : 1);
    }
    return point.opacity < 1.0f ? 2 : 3;
  };
  struct Member
  {
    int rank;
    std::size_t part, copy;
    bool outside;
    Hit hit;

    bool isOneWith(const Member& o) const
    {
      return part == o.part && copy == o.copy && outside == o.outside;
    }
  };
  std::vector<Member> ranked;
  for (const Hit& hit : members)
  {
    const SurfacePoint point = this->Points.at(hit, direction);
    ranked.push_back({ rank(hit, point), point.part,
      this->Scene.parts[point.part].copyOf(hit.triangle), point.outside, hit });
  }
  std::sort(ranked.begin(), ranked.end(), [this](const Member& a, const Member& b) {
    return a.rank != b.rank ? a.rank < b.rank
                            : this->Scene.drawnAfter(a.hit.triangle, b.hit.triangle);
  });
  members.clear();
  for (auto member = ranked.begin(); member != ranked.end(); ++member)
  {
    const auto same = [member](const Member& o) { return member->isOneWith(o); };
    if (std::none_of(ranked.begin(), member, same))
    {
      members.push_back(member->hit);
    }
  }
}

} // namespace hrt
