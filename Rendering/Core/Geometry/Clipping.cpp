// Cuts a mesh plane by plane: each plane sees a mesh that the one before has left.
#include "Rendering/Core/Geometry/Clipping.h"

#include <cmath>
#include <unordered_map>

namespace hrt
{

namespace
{

glm::vec3 between(const glm::vec3& a, const glm::vec3& b, double t)
{
  return glm::vec3(glm::mix(glm::dvec3(a), glm::dvec3(b), t));
}
glm::vec2 between(const glm::vec2& a, const glm::vec2& b, double t)
{
  return glm::vec2(glm::mix(glm::dvec2(a), glm::dvec2(b), t));
}
glm::u8vec4 between(const glm::u8vec4& a, const glm::u8vec4& b, double t)
{
  return glm::u8vec4(glm::round(glm::mix(glm::dvec4(a), glm::dvec4(b), t)));
}

template <class T>
void appendBetween(std::vector<T>& values, std::uint32_t a, std::uint32_t b, double t)
{
  values.push_back(between(values[a], values[b], t));
}
template <class T>
void appendBetween(Attribute<T>& attribute, std::uint32_t a, std::uint32_t b, double t)
{
  if (!attribute.empty() && attribute.attachment == Attachment::Vertices)
  {
    appendBetween(attribute.values, a, b, t);
  }
}

// One plane's cut through a mesh.
class Cut
{
public:
  Cut(const Geometry& mesh, const ClippingPlane& plane)
    : From(mesh)
    , Left(withoutTriangles(mesh))
  {
    this->Distances.reserve(mesh.vertexCount());
    for (const glm::vec3& p : mesh.positions)
    {
      this->Distances.push_back(glm::dot(plane, glm::dvec4(glm::dvec3(p) + mesh.origin, 1.0)));
    }
  }

  Geometry take()
  {
    for (std::size_t i = 0; i < this->From.triangleCount(); ++i)
    {
      this->cutTriangle(i);
    }
    return std::move(this->Left);
  }

private:
  static Geometry withoutTriangles(const Geometry& mesh)
  {
    Geometry left = mesh;
    left.triangles.clear();
    left.cellIds = CellIds();
    left.sides.clear();
    dropTriangleValues(left.normals);
    dropTriangleValues(left.colors);
    dropTriangleValues(left.coordinates);
    dropTriangleValues(left.textureCoordinates);
    return left;
  }
  template <class T>
  static void dropTriangleValues(Attribute<T>& attribute)
  {
    if (attribute.attachment == Attachment::Triangles)
    {
      attribute.values.clear();
    }
  }

  // The vertex where the plane meets the edge. Computed from the edge's lower number on, so that both
  // of its triangles get the same one.
  std::uint32_t onEdge(std::uint32_t a, std::uint32_t b)
  {
    if (b < a)
    {
      std::swap(a, b);
    }
    const auto added = this->Edges.emplace(
      std::uint64_t(a) << 32 | b, static_cast<std::uint32_t>(this->Left.vertexCount()));
    if (added.second)
    {
      const double t = this->Distances[a] / (this->Distances[a] - this->Distances[b]);
      appendBetween(this->Left.positions, a, b, t);
      appendBetween(this->Left.normals, a, b, t);
      appendBetween(this->Left.colors, a, b, t);
      appendBetween(this->Left.coordinates, a, b, t);
      appendBetween(this->Left.textureCoordinates, a, b, t);
    }
    return added.first->second;
  }

  void cutTriangle(std::size_t triangle)
  {
    const std::array<std::uint32_t, 3>& corners = this->From.triangles[triangle];
    std::array<std::uint32_t, 4> border{};
    std::array<bool, 4> edge{}; // whether the border from there to the next is an edge of the cell
    std::size_t count = 0;
    const auto add = [&](std::uint32_t vertex, bool isEdge) {
      edge[count] = isEdge;
      border[count++] = vertex;
    };
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      const double from = this->Distances[a], to = this->Distances[b];
      const bool isEdge =
        !this->From.sides.empty() && this->From.sides[triangle].isEdge(static_cast<int>(k));
      if (from >= 0.0)
      {
        add(a, isEdge && (from > 0.0 || to >= 0.0)); // else the plane's own side begins
      }
      if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0))
      {
        add(this->onEdge(a, b), isEdge && to > 0.0);
      }
    }
    for (std::size_t k = 1; k + 1 < count; ++k)
    {
      TriangleSides sides;
      sides.edges = (k == 1 && edge[0] ? 1u : 0u) | (edge[k] ? 2u : 0u) |
        (k + 2 == count && edge[k + 1] ? 4u : 0u);
      this->append({ border[0], border[k], border[k + 1] }, triangle, sides);
    }
  }

  void append(
    const std::array<std::uint32_t, 3>& corners, std::size_t of, const TriangleSides& sides)
  {
    const auto at = [&](std::size_t k) {
      return glm::dvec3(this->Left.positions[corners[k]]);
    };
    if (glm::cross(at(1) - at(0), at(2) - at(0)) == glm::dvec3(0.0))
    {
      return; // the plane goes through its last corner, or so near that rounding leaves no area
    }
    this->Left.triangles.push_back(corners);
    this->Left.cellIds.push_back(this->From.cellIds[of]);
    if (!this->From.sides.empty())
    {
      this->Left.sides.push_back(sides);
    }
    this->appendTriangleValue(this->Left.normals, this->From.normals, of);
    this->appendTriangleValue(this->Left.colors, this->From.colors, of);
    this->appendTriangleValue(this->Left.coordinates, this->From.coordinates, of);
    this->appendTriangleValue(
      this->Left.textureCoordinates, this->From.textureCoordinates, of);
  }
  template <class T>
  static void appendTriangleValue(Attribute<T>& left, const Attribute<T>& from, std::size_t of)
  {
    if (!from.empty() && from.attachment == Attachment::Triangles)
    {
      left.values.push_back(from.values[of]);
    }
  }

  const Geometry& From;
  Geometry Left;
  std::vector<double> Distances; // of the vertices to the plane, times the normal's length
  std::unordered_map<std::uint64_t, std::uint32_t> Edges; // the vertices that cut them
};

template <class T>
void keepVertices(const std::vector<std::uint32_t>& kept, std::vector<T>& values)
{
  std::vector<T> left;
  left.reserve(kept.size());
  for (const std::uint32_t vertex : kept)
  {
    left.push_back(values[vertex]);
  }
  values.swap(left);
}
template <class T>
void keepVertices(const std::vector<std::uint32_t>& kept, Attribute<T>& attribute)
{
  if (!attribute.empty() && attribute.attachment == Attachment::Vertices)
  {
    keepVertices(kept, attribute.values);
  }
}

// Forgets the vertices that no triangle is left of, and sets the bounds.
void tidy(Geometry& mesh)
{
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.vertexCount(), kUnused), kept;
  for (std::array<std::uint32_t, 3>& triangle : mesh.triangles)
  {
    for (std::uint32_t& vertex : triangle)
    {
      if (number[vertex] == kUnused)
      {
        number[vertex] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(vertex);
      }
      vertex = number[vertex];
    }
  }
  keepVertices(kept, mesh.positions);
  keepVertices(kept, mesh.normals);
  keepVertices(kept, mesh.colors);
  keepVertices(kept, mesh.coordinates);
  keepVertices(kept, mesh.textureCoordinates);
  mesh.boundsMin = glm::vec3(0.0f);
  mesh.boundsMax = glm::vec3(-1.0f);
  if (!mesh.positions.empty())
  {
    mesh.boundsMin = mesh.boundsMax = mesh.positions.front();
  }
  for (const glm::vec3& p : mesh.positions)
  {
    mesh.boundsMin = glm::min(mesh.boundsMin, p);
    mesh.boundsMax = glm::max(mesh.boundsMax, p);
  }
}

} // namespace

Geometry clipped(const Geometry& mesh, const std::vector<ClippingPlane>& planes)
{
  Geometry left = mesh;
  for (const ClippingPlane& plane : planes)
  {
    left = Cut(left, plane).take();
  }
  tidy(left);
  if (!left.sides.empty())
  {
    connectSides(left);
  }
  return left;
}

} // namespace hrt
