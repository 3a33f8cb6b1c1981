// Implements AFF's meshes and loose faces. All of them become a Mesh, so that only this file knows
// the ways in which AFF writes a triangle.
#include "IO/BART/AFF/Commands.h"

namespace hrt
{
namespace bart
{
namespace
{

//------------------------------------------------------------------------------
std::vector<glm::vec3> readVectors(Lexer& lexer, const char* countOf, const char* each)
{
  std::vector<glm::vec3> vectors(lexer.count(1, 3, countOf));
  for (glm::vec3& vector : vectors)
  {
    vector = glm::vec3(lexer.vector(each));
  }
  return vectors;
}

//------------------------------------------------------------------------------
void readCoordinates(Lexer& lexer, NamedMesh& named)
{
  // The texture's name stands between the count and the pairs.
  named.mesh.coordinates.resize(lexer.count(1, 2, "the number of texture coordinates"));
  named.texture = lexer.word("the name of a texture");
  for (glm::vec2& coordinate : named.mesh.coordinates)
  {
    coordinate = glm::vec2(lexer.pair("a texture coordinate"));
  }
}

//------------------------------------------------------------------------------
// The three indices of one triangle into one of the mesh's lists.
void readIndices(
  Lexer& lexer, std::size_t size, int Corner::*member, Corner* corners, const char* expected)
{
  for (int i = 0; i < 3; ++i)
  {
    corners[i].*member = lexer.integer(0, static_cast<long long>(size) - 1, expected);
  }
}

//------------------------------------------------------------------------------
void readTriangles(Lexer& lexer, Mesh& mesh)
{
  const std::size_t lists = 1 + (mesh.normals.empty() ? 0 : 1) + (mesh.coordinates.empty() ? 0 : 1);
  mesh.corners.resize(3 * lexer.count(1, 3 * lists, "the number of triangles"));
  for (std::size_t first = 0; first < mesh.corners.size(); first += 3)
  {
    Corner* corners = mesh.corners.data() + first;
    readIndices(lexer, mesh.vertices.size(), &Corner::vertex, corners, "a vertex's index");
    if (!mesh.normals.empty())
    {
      readIndices(lexer, mesh.normals.size(), &Corner::normal, corners, "a normal's index");
    }
    if (!mesh.coordinates.empty())
    {
      readIndices(lexer, mesh.coordinates.size(), &Corner::coordinate, corners,
        "a texture coordinate's index");
    }
  }
}

//------------------------------------------------------------------------------
// Each corner of a loose face has a vertex of its own.
void addCorner(Lexer& lexer, Mesh& mesh, bool withNormals)
{
  Corner corner;
  corner.vertex = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(lexer.vector("a vertex"));
  if (withNormals)
  {
    corner.normal = static_cast<int>(mesh.normals.size());
    mesh.normals.emplace_back(lexer.vector("a normal"));
  }
  mesh.corners.push_back(corner);
}

} // anonymous namespace

//------------------------------------------------------------------------------
NamedMesh readMesh(Lexer& lexer)
{
  NamedMesh named;
  lexer.keyword("vertices");
  named.mesh.vertices = readVectors(lexer, "the number of vertices", "a vertex");
  if (lexer.peek() == "normals")
  {
    lexer.next();
    named.mesh.normals = readVectors(lexer, "the number of normals", "a normal");
  }
  if (lexer.peek() == "texturecoords")
  {
    lexer.next();
    readCoordinates(lexer, named);
  }
  if (lexer.next() != "triangles")
  {
    lexer.failExpecting("'normals', 'texturecoords' or 'triangles', in this order");
  }
  readTriangles(lexer, named.mesh);
  return named;
}

//------------------------------------------------------------------------------
NamedMesh readPolygon(Lexer& lexer, bool withNormals)
{
  NamedMesh named;
  const std::size_t corners = lexer.count(3, withNormals ? 6 : 3, "the number of corners");
  for (std::size_t i = 0; i < corners; ++i)
  {
    addCorner(lexer, named.mesh, withNormals);
  }
  named.mesh.faceEnds.push_back(corners);
  return named;
}

//------------------------------------------------------------------------------
NamedMesh readTexturedTriangle(Lexer& lexer, bool withNormals)
{
  NamedMesh named;
  named.texture = lexer.word("the name of a texture");
  for (int i = 0; i < 3; ++i)
  {
    addCorner(lexer, named.mesh, withNormals);
    named.mesh.corners.back().coordinate = i;
    named.mesh.coordinates.emplace_back(lexer.pair("a texture coordinate"));
  }
  named.mesh.faceEnds.push_back(3);
  return named;
}

} // namespace bart
} // namespace hrt
