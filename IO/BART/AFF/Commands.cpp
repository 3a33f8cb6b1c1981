// Implements the short commands of AFF: view, materials, lights, spheres, cones, transforms.
#include "IO/BART/AFF/Commands.h"

#include <glm/geometric.hpp>

namespace hrt
{
namespace bart
{
namespace
{

// The angle of a view must leave a picture plane; the picture must fit an int of bytes many times
// over.
constexpr double kNarrowestView = 1e-3;
constexpr double kWidestView = 179.0;
constexpr int kLargestPicture = 65536;
// BART's own reader takes a nearer plane for a missing one.
constexpr double kNearestHither = 1e-4;
constexpr double kDefaultHither = 1.0;

} // anonymous namespace

//------------------------------------------------------------------------------
Viewpoint readViewpoint(Lexer& lexer)
{
  Viewpoint view;
  lexer.keyword("from");
  view.from = lexer.vector("the eye's place");
  lexer.keyword("at");
  view.at = lexer.vector("the place looked at");
  lexer.keyword("up");
  view.up = lexer.vector("the upward direction");
  if (glm::length(glm::cross(view.at - view.from, view.up)) == 0.0)
  {
    lexer.fail("expected 'from', 'at' and 'up' that give a direction of view and one that is up");
  }
  lexer.keyword("angle");
  view.angle = lexer.numberBetween(kNarrowestView, kWidestView, "the angle of view in degrees");
  lexer.keyword("hither");
  view.hither = lexer.numberBetween(0.0, kLargestNumber, "the distance of the hither plane");
  view.hither = view.hither < kNearestHither ? kDefaultHither : view.hither;
  lexer.keyword("resolution");
  view.width = lexer.integer(1, kLargestPicture, "the picture's width");
  view.height = lexer.integer(1, kLargestPicture, "the picture's height");
  return view;
}

//------------------------------------------------------------------------------
Material readMaterial(Lexer& lexer)
{
  Material material;
  material.ambient = lexer.vector("the ambient colour");
  material.diffuse = lexer.vector("the diffuse colour");
  material.specular = lexer.vector("the specular colour");
  material.shininess = lexer.number("the shininess");
  material.transmittance = lexer.number("the transmittance");
  material.indexOfRefraction = lexer.number("the index of refraction");
  return material;
}

//------------------------------------------------------------------------------
// NFF has one colour, its diffuse share and a colourless specular share, and no ambient term.
Material readSimpleMaterial(Lexer& lexer)
{
  Material material;
  const glm::dvec3 color = lexer.vector("the colour");
  material.diffuse = color * lexer.number("the diffuse share");
  material.specular = glm::dvec3(lexer.number("the specular share"));
  material.shininess = lexer.number("the shininess");
  material.transmittance = lexer.number("the transmittance");
  material.indexOfRefraction = lexer.number("the index of refraction");
  return material;
}

//------------------------------------------------------------------------------
PointLight readLight(Lexer& lexer)
{
  PointLight light;
  light.position = lexer.vector("the light's place");
  if (lexer.numberFollows())
  {
    light.color = lexer.vector("the light's colour");
  }
  return light;
}

//------------------------------------------------------------------------------
Sphere readSphere(Lexer& lexer)
{
  Sphere sphere;
  sphere.center = lexer.vector("the sphere's centre");
  sphere.radius = lexer.number("the sphere's radius");
  if (sphere.radius == 0.0)
  {
    lexer.failExpecting("a sphere's radius other than 0");
  }
  return sphere;
}

//------------------------------------------------------------------------------
Cone readCone(Lexer& lexer)
{
  Cone cone;
  cone.base = lexer.vector("the cone's base");
  cone.baseRadius = lexer.number("the base's radius");
  cone.apex = lexer.vector("the cone's apex");
  cone.apexRadius = lexer.number("the apex's radius");
  // Products would underflow for tiny radii.
  const bool outside = cone.baseRadius >= 0.0 && cone.apexRadius >= 0.0;
  const bool inside = cone.baseRadius <= 0.0 && cone.apexRadius <= 0.0;
  if (outside == inside)
  {
    lexer.fail("expected a cone's radii, not both 0, and either both negative or none");
  }
  if (glm::length(cone.apex - cone.base) == 0.0)
  {
    lexer.fail("expected a cone's apex away from its base");
  }
  return cone;
}

//------------------------------------------------------------------------------
glm::dquat readRotation(Lexer& lexer)
{
  const glm::dvec3 axis = lexer.vector("the axis of a rotation");
  const double degrees = lexer.number("the angle of a rotation in degrees");
  if (glm::length(axis) == 0.0 && degrees != 0.0)
  {
    lexer.fail("expected an axis other than 0 0 0 for a rotation by an angle other than 0");
  }
  return rotationAbout(axis, degrees);
}

//------------------------------------------------------------------------------
glm::dmat4 readStaticTransform(Lexer& lexer)
{
  const glm::dvec3 scale = lexer.vector("the scale of a transform");
  const glm::dquat rotation = readRotation(lexer);
  return composeMatrix(lexer.vector("the translation of a transform"), rotation, scale);
}

} // namespace bart
} // namespace hrt
