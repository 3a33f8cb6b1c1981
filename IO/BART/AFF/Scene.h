// What an AFF scene says, as plain data: the parser fills it, the importer turns it into VTK's
// objects. It stands between the two so that the parser can be tested and fuzzed without VTK.
//
// The transforms are a flat list in which a parent stands before its children, so that a deep
// hierarchy is evaluated by a loop, never by recursion. Geometry is stored once however often its
// file is included; an Instance places it.
#pragma once

#include "IO/BART/AFF/Spline.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hrt
{
namespace bart
{

// "None" for the indices below.
constexpr int kNone = -1;

// Where something stands in the text, for messages that come after parsing.
struct Location
{
  std::string file;
  std::size_t line = 0;
};

// "v": the view from which nothing moves yet.
struct Viewpoint
{
  glm::dvec3 from{ 0.0, 0.0, 1.0 };
  glm::dvec3 at{ 0.0 };
  glm::dvec3 up{ 0.0, 1.0, 0.0 };
  double angle = 30.0; // degrees, from the top of the picture to its bottom
  double hither = 1.0; // nothing nearer than this is seen
  int width = 800;
  int height = 600;
};

// "fm", or "f" brought to the same terms. Before the first of them a surface is white and matt.
struct Material
{
  glm::dvec3 ambient{ 0.0 };
  glm::dvec3 diffuse{ 1.0 };
  glm::dvec3 specular{ 0.0 };
  double shininess = 1.0;
  double transmittance = 0.0;
  double indexOfRefraction = 1.0;
};

// "l" and "la". A light inside a transform moves with it; the translation keys of a named one are
// its position.
struct PointLight
{
  glm::dvec3 position{ 0.0 };
  glm::dvec3 color{ 1.0 };
  int node = kNone;
  std::string name; // empty: it cannot be animated
  int animation = kNone;
};

// "k NAME { ... }".
struct Animation
{
  std::string name;
  std::optional<VectorSpline> translation;
  std::optional<RotationSpline> rotation;
  std::optional<VectorSpline> scale;
  std::optional<VisibilityTrack> visibility;
};

// "xs" and "x". An animated one without keys stays the identity.
struct Node
{
  int parent = kNone;
  bool animated = false;
  int animation = kNone;    // of an animated one
  glm::dmat4 matrix{ 1.0 }; // of a static one
  std::string name;         // of an animated one
};

struct Texture
{
  std::string name;  // as written
  std::string path;  // of the file that names it, to look for the texture beside it
  Location location; // of its first use
};

// One corner of a face: indices into the mesh's lists, normal and coordinate kNone where absent.
struct Corner
{
  int vertex = kNone;
  int normal = kNone;
  int coordinate = kNone;
};

// "m", or loose faces ("p", "pp", "tt", "ttp") that follow each other under one transform and
// material.
struct Mesh
{
  std::vector<glm::vec3> vertices;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> coordinates;
  std::vector<Corner> corners;
  std::vector<std::size_t> faceEnds; // end of each face in corners; empty: all are triangles
  int texture = kNone;
};

// "tpa": a triangle with one set of corners for each of its times.
struct AnimatedTriangle
{
  struct Corners
  {
    std::array<glm::vec3, 3> positions;
    std::array<glm::vec3, 3> normals;
  };
  std::vector<double> times; // not descending
  std::vector<Corners> corners;
};

using AnimatedTriangles = std::vector<AnimatedTriangle>;

// "s". A negative radius: seen from inside.
struct Sphere
{
  glm::dvec3 center{ 0.0 };
  double radius = 1.0;
};

// "c": a cone or cylinder without caps. Negative radii: seen from inside.
struct Cone
{
  glm::dvec3 base{ 0.0 };
  double baseRadius = 1.0;
  glm::dvec3 apex{ 0.0 };
  double apexRadius = 0.0;
};

struct Instance
{
  enum class Shape
  {
    Mesh,
    AnimatedTriangles,
    Sphere,
    Cone
  };
  Shape shape = Shape::Mesh;
  int index = kNone; // in the scene's list of that shape
  int node = kNone;  // kNone: in world coordinates
  int material = kNone;
};

struct Scene
{
  std::optional<Viewpoint> viewpoint;
  glm::dvec3 background{ 0.0 };
  glm::dvec3 ambient{ 1.0 };
  double startTime = 0.0;
  double endTime = 0.0;
  int frames = 1;

  std::vector<Node> nodes;
  std::vector<Animation> animations;
  int camera = kNone; // the animation of the viewpoint
  std::vector<PointLight> lights;
  std::vector<Material> materials;
  std::vector<Texture> textures;

  std::vector<Mesh> meshes;
  std::vector<AnimatedTriangles> animatedTriangles;
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
  std::vector<Instance> instances;
};

// Triangles of a mesh; a polygon of n corners counts as n - 2.
std::size_t countTriangles(const Mesh& mesh);

// Triangles of all instances of meshes and animated triangles, in all and of the textured ones.
// Spheres and cones are not made of triangles here.
struct TriangleCount
{
  std::size_t all = 0;
  std::size_t textured = 0;
};
TriangleCount countTriangles(const Scene& scene);

// The scene at one moment.
struct Pose
{
  std::vector<glm::dmat4> toWorld; // of each node
  std::vector<char> visible;       // of each node, its ancestors considered
};
Pose poseAt(const Scene& scene, double time);

// The translation, rotation and scale of an animation, M = T R S; what has no keys leaves all in
// place.
glm::dmat4 matrixAt(const Animation& animation, double time);
// M = T R S of "xs".
glm::dmat4 composeMatrix(
  const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale);

// In world coordinates.
glm::dvec3 lightPositionAt(
  const Scene& scene, const Pose& pose, const PointLight& light, double time);
// The viewpoint, moved by the keys named "camera": translation keys are its place; rotation keys
// turn a camera that looks along -z with +y up.
Viewpoint viewpointAt(const Scene& scene, double time);
// Linear between the triangle's times, constant outside.
AnimatedTriangle::Corners cornersAt(const AnimatedTriangle& triangle, double time);

} // namespace bart
} // namespace hrt
