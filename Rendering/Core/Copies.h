// Many placements of one geometry, as glyphs have them. A part with copies is one mesh, one material
// and one hierarchy, however many glyphs there are: a copy costs its matrix, and its colour where it
// has one.
//
// Numbers. The copies of a part follow each other: copy k has the triangles k n to (k + 1) n - 1 of the
// part's, where n is the geometry's count.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hrt
{

struct Copies
{
  std::uint64_t version = 0; // unique over the process' life, never 0

  // The rows of each copy's matrix, from the geometry's local coordinates to those of its part. In
  // single precision, as VTK's glyph mapper has them; translations are relative to an origin.
  using Rows = std::array<glm::vec4, 3>;
  std::vector<Rows> rows;
  glm::dvec3 origin{ 0.0 };

  std::vector<glm::u8vec4> colors; // one a copy, or none: the part's own
  std::vector<std::int64_t> ids;   // the user's number of each copy; empty: its place

  // The largest size of each number of the stored matrices.
  glm::dmat4 largest{ 0.0 };
  // Of all copies of the geometry they were made for, in the part's coordinates.
  glm::dvec3 boundsMin{ 0.0 };
  glm::dvec3 boundsMax{ -1.0 };

  std::size_t count() const { return this->rows.size(); }
  std::int64_t id(std::size_t copy) const
  {
    return this->ids.empty() ? static_cast<std::int64_t>(copy) : this->ids[copy];
  }

  glm::dmat4 matrix(std::size_t copy) const
  {
    const Rows& r = this->rows[copy];
    glm::dmat4 m(1.0);
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 4; ++column)
      {
        m[column][row] = r[static_cast<std::size_t>(row)][column];
      }
      m[3][row] += this->origin[row];
    }
    return m;
  }
};

} // namespace hrt
