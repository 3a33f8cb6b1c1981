// The picture that every mode of the pass is held against: Whitted's recursion written down as
// plainly as it can be, in double precision throughout, over a list of triangles (TriangleSoup.h).
// It shares with the product the scene snapshot, the camera's rays and the one shading source, which
// it compiles in double; intersection, surfaces, optics, shadows and recursion are its own.
//
// It also says where it may be contradicted: which triangles a pixel may show when its ray runs
// through an edge, and which pixels hang on a later ray that does.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <vector>

namespace hrt
{
namespace reference
{

// width x height pixels, row 0 at the bottom.
struct Picture
{
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> colors; // alpha 1 where something is hit, else all zero

  // The part of the colour that came by rays weighing less than 1/512 of their pixel. The product
  // does not trace those: it may lack this much.
  std::vector<glm::dvec3> omitted;

  // 1: a shadow, mirror or glass ray of this pixel passed an edge, or two surfaces at one depth,
  // within rounding: another answer is as right.
  std::vector<std::uint8_t> fragile;

  std::vector<TriangleId> triangles; // kNoTriangle: nothing
  std::vector<std::vector<TriangleId>> admissible; // see Sighting
};

Picture render(const Snapshot& snapshot, const TracerSettings& settings);

} // namespace reference
} // namespace hrt
