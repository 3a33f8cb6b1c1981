// The sides of a mesh's triangles, for surfaces whose edges are shown: which of them are edges of the
// cell that the triangle is a part of, and which triangle lies beyond.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace hrt
{

struct Geometry;

inline constexpr std::uint32_t kNoNeighbour = std::numeric_limits<std::uint32_t>::max();

// Side k runs from corner k to the next one. Four numbers, as the shaders fetch them.
struct TriangleSides
{
  std::array<std::uint32_t, 3> neighbours{ { kNoNeighbour, kNoNeighbour, kNoNeighbour } };
  std::uint32_t edges = 0; // bit k: side k is an edge of the cell

  bool isEdge(int side) const { return ((this->edges >> side) & 1u) != 0; }
  bool operator==(const TriangleSides& o) const
  {
    return this->neighbours == o.neighbours && this->edges == o.edges;
  }
};
static_assert(sizeof(TriangleSides) == 16, "uploaded as it is");

// Fills the neighbours in the mesh's sides. Sides belong together when their ends are at the same
// places, whether or not they are the same vertices: meshes with creases repeat points. Where three
// triangles or more meet, they pair off as they come.
void connectSides(Geometry& mesh);

} // namespace hrt
