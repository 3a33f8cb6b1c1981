// THE RULE for surfaces that lie in one place, as everything that meets surfaces keeps it: the raster
// engine, the ray structures, the tracer and first hits.
//
// VTK draws actors one after the other with a depth test that equal depths pass. Two actors on the same
// surface, a decal, a glass cube on its floor, a mesh baked by a filter beside the same mesh placed by a
// matrix: their corners are the same but for rounding, and which of them a ray meets first is noise.
// Hits that rounding alone can have parted are therefore one set, of which
//   - camera rays take the member that is drawn last: that of the largest number. Rasterised triangles
//     pass the depth test where depths are equal. Polygon offsets count for camera rays alone.
//   - all other rays meet the members one after the other, in an order of their own (Meeting.h), as if
//     the gaps between them were small but not zero.
//   - rays that leave a surface pass over its twins, so that neither of two twins shadows, or is mirrored
//     in, the other: Ray::twinEnd.
// Of hits at one depth, to the last bit, that of the largest number is the nearest, whatever the
// surfaces.
//
// When are two triangles in one place at a point? Each has a rounding, the distance along its normal by
// which its plane may be elsewhere than the numbers say:
//   - Coordinates are given as floats, or rounded to floats relative to the mesh' own origin, which
//     is half an ulp, 2^-24 of the coordinate's size; a filter that computed them from others has
//     rounded once more. So a coordinate is off by 2^-23 of its size. Through the matrix M a corner x is
//     off by |M| 2^-23 |x| along the scene's axes, |.| taken number by number, and along the unit
//     normal n by |n| . that. A copy's matrix is made of floats itself: that is as much again, and 2^-23
//     of its translation. A plane through three such corners is off, within the triangle, by no more
//     than the worst of them. For a floor in a plane of coordinates only its height counts, however far
//     it stretches.
//   - What is computed from corners of size R in double is off by a few roundings, 8 R e with e = 2^-53,
//     and the depth at which the exact kernel then meets a neighbour in the same plane is uncertain by
//     about as much times the neighbour's length over its height. 2^-43 R = 1024 R e covers slivers a
//     hundred times longer than high, and still is only a tenth of a picometre in a metre.
// Of two surfaces of one part, the same copy of it, the coordinates are taken as they are given: VTK's
// depth test keeps the two sides of a thin sheet apart by them, and what is meant to be in one place there
// has the same corners. Only what is computed counts then.
// They are in one place where the point, on the one, is no farther from the other's plane than both
// roundings together, and where rounding also explains that they are not parallel: a rounding r at one
// corner tilts a triangle whose smallest height is h by r / h, and at the others by as much again. Walls
// that meet in a corner are never in one place, however near the corner.
//
// A ray that leaves from next to an edge may begin on the wrong side of a twin of the neighbour, which is
// not parallel. It passes over that too: over all that the point is on, within both roundings, and whose
// outside looks the same way, within 60 degrees, where it leaves both to the same side. A wall that it
// would truly run into it leaves to the other side.
#pragma once

#include "Rendering/Core/Geometry/TriangleIntersection.h"
#include "Rendering/Core/Snapshot.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hrt
{

// Of a coordinate of a mesh, relative to its size: see above. Of what is computed: kComputedRounding.
inline constexpr double kCoordinateRounding = 0x1p-23;

// Surfaces that are met at a smaller angle than one of this sine, less than a degree, may be kept apart
// though they are in one place: along the ray their hits are as much farther apart. What is seen so is
// foreshortened to next to nothing, and a structure searches only so far behind a hit for others.
inline constexpr double kGrazing = 1.0 / 64.0;

// Sets are gathered with roundings so much larger than those of the surfaces that a leaving ray passes
// over: what is passed over was in the set, also where the two are measured at points a rounding apart.
inline constexpr double kSetMargin = 1.25;

// How far behind a hit others may be in one place with it, along a ray.
struct HitWindow
{
  double fixed = 0.0; // in units of the ray's parameter
  double end(double t) const { return t + (this->fixed + t * kComputedRounding); }
  bool holds(double first, double second) const { return second <= this->end(first); }
};

// The surfaces of one snapshot, by their triangles' numbers.
class Coincidence
{
public:
  Coincidence() = default;
  // Keeps the geometries alive.
  explicit Coincidence(const Snapshot& snapshot);

  // Whether both triangles' surfaces lie in one place at the point, relative to Snapshot::origin, of
  // the first. `margin`: for both roundings together.
  bool inOnePlace(
    TriangleId a, TriangleId b, const glm::dvec3& point, double margin = 1.0) const;

  // Whether a ray that leaves the one triangle passes over the other.
  bool passesOver(TriangleId left, TriangleId met, const glm::dvec3& origin,
    const glm::dvec3& direction) const;

  // No twin of a triangle of the snapshot's part is farther away, along the normal.
  double twinReach(std::size_t part) const
  {
    return this->Parts[part].rounding + this->LargestRounding;
  }

  // Of rays in that direction, of any length but zero.
  HitWindow windowOf(const glm::dvec3& direction) const
  {
    const double longest = std::max(
      std::max(std::fabs(direction.x), std::fabs(direction.y)), std::fabs(direction.z));
    return { this->Reach / longest };
  }
  // HitWindow::fixed of rays whose directions' longest component is 1.
  double reach() const { return this->Reach; }

  // No less than the rounding of any triangle of the part, whichever of its copies.
  static double roundingOf(const Part& part, const glm::dvec3& sceneOrigin);

private:
  struct PlacedPart
  {
    Part part; // its triangles and where they are; no more is filled in
    double rounding;
  };
  // Where a triangle is.
  struct Place
  {
    const PlacedPart* part;
    std::size_t copy;
    bool operator==(const Place& o) const { return part == o.part && copy == o.copy; }
  };
  struct Facet;
  Place placeOf(TriangleId triangle) const;
  // `given`: whether the rounding of what was given counts.
  Facet facetOf(TriangleId triangle, const Place& place, bool given) const;
  std::pair<Facet, Facet> facetsOf(TriangleId a, TriangleId b) const;

  std::vector<PlacedPart> Parts; // the snapshot's
  glm::dvec3 Origin{ 0.0 };
  double LargestRounding = 0.0;
  double Reach = 0.0; // along a ray of unit length, of any two hits in one place
};

} // namespace hrt
