// The triangles of one part: an indexed mesh. What belongs to a vertex is stored once, however many
// triangles meet there, and what belongs to a triangle once a triangle. Nobody outside needs to
// know which is which: everything is asked for by a triangle and its corner.
#pragma once

#include "Rendering/Core/Geometry/CellIds.h"
#include "Rendering/Core/Geometry/Sides.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hrt
{

// Where a part's colour comes from, as vtkMapper decides it.
enum class ColorSource : std::uint8_t
{
  Property, // the material's own ambient and diffuse colours
  Corner,   // Geometry::colors, interpolated over the triangle (equal corners: a cell's colour)
  Lookup    // Geometry::coordinates, interpolated, then looked up in Geometry::lookup, nearest texel
};

// What the values of an attribute belong to.
enum class Attachment : std::uint8_t
{
  Vertices,
  Triangles // all three corners of a triangle have the same value
};

// One value a vertex or one a triangle; none at all where the geometry lacks the attribute.
template <class T>
struct Attribute
{
  std::vector<T> values;
  Attachment attachment = Attachment::Vertices;

  bool empty() const { return this->values.empty(); }
  bool operator==(const Attribute& o) const
  {
    return this->attachment == o.attachment && this->values == o.values;
  }
};

// Immutable once made: a changed mesh is a new Geometry with a new version, which is all that a
// cache needs to compare.
struct Geometry
{
  std::uint64_t version = 0; // unique over the process' life, never 0 for a real geometry

  // Added to every position to get the local (vtkPolyData) coordinate. Zero unless the data lie far
  // from their own origin; then a multiple of a power of two, so that the subtraction is exact for
  // float input.
  glm::dvec3 origin{ 0.0 };

  // What to add to a position for the coordinate that was given in single precision, as far as its
  // rounding is concerned: the origin where the data are floats, zero where they are not.
  glm::dvec3 givenFrom{ 0.0 };

  std::vector<glm::vec3> positions;                    // of the vertices, relative to origin
  std::vector<std::array<std::uint32_t, 3>> triangles; // the numbers of their vertices
  CellIds cellIds;                                     // the vtkPolyData cells that they came from
  Attribute<glm::vec3> normals;                        // not normalised; empty: the face's normal
  Attribute<glm::u8vec4> colors;                       // when colorSource == Corner, else empty
  Attribute<glm::vec2> coordinates;                    // when colorSource == Lookup, else empty
  Attribute<glm::vec2> textureCoordinates;             // empty: no texture is shown
  std::vector<TriangleSides> sides;                    // of the triangles; empty: no edges are shown
  ColorSource colorSource = ColorSource::Property;

  std::vector<glm::u8vec4> lookup; // lookupWidth x lookupHeight texels, row by row
  int lookupWidth = 0;
  int lookupHeight = 0;

  // All triangles lie in one plane: nothing of it can shadow the rest of it. See isFlat.
  bool flat = false;

  glm::vec3 boundsMin{ 0.0f }; // of positions; min > max when there is no triangle
  glm::vec3 boundsMax{ -1.0f };

  std::size_t vertexCount() const { return this->positions.size(); }
  std::size_t triangleCount() const { return this->triangles.size(); }

  // The values at a triangle's corners.
  std::array<glm::vec3, 3> cornerPositions(std::size_t triangle) const
  {
    const std::array<std::uint32_t, 3>& v = this->triangles[triangle];
    return { this->positions[v[0]], this->positions[v[1]], this->positions[v[2]] };
  }
  template <class T>
  std::array<T, 3> cornersOf(const Attribute<T>& attribute, std::size_t triangle) const
  {
    const std::vector<T>& values = attribute.values;
    if (attribute.attachment == Attachment::Triangles)
    {
      return { values[triangle], values[triangle], values[triangle] };
    }
    const std::array<std::uint32_t, 3>& v = this->triangles[triangle];
    return { values[v[0]], values[v[1]], values[v[2]] };
  }
};

// Whether every vertex lies in the plane of the first triangle that has an area, but for the
// rounding of the positions themselves.
bool isFlat(const Geometry& geometry);

} // namespace hrt
