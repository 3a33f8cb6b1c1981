// Reads what one AFF command says, after the command's own word. Functions of the text alone: what
// a command does to the scene stands in Parser.cpp.
#pragma once

#include "IO/BART/AFF/Lexer.h"
#include "IO/BART/AFF/Scene.h"

#include <string>

namespace hrt
{
namespace bart
{

Viewpoint readViewpoint(Lexer& lexer);        // v
Material readMaterial(Lexer& lexer);          // fm
Material readSimpleMaterial(Lexer& lexer);    // f
PointLight readLight(Lexer& lexer);           // l, and la after its name
Sphere readSphere(Lexer& lexer);              // s
Cone readCone(Lexer& lexer);                  // c
glm::dmat4 readStaticTransform(Lexer& lexer); // xs

Animation readKeys(Lexer& lexer);                    // k
AnimatedTriangle readAnimatedTriangle(Lexer& lexer); // tpa

// A mesh and the name of its texture, empty without one.
struct NamedMesh
{
  Mesh mesh;
  std::string texture;
};
NamedMesh readMesh(Lexer& lexer);                               // m
NamedMesh readPolygon(Lexer& lexer, bool withNormals);          // p, pp
NamedMesh readTexturedTriangle(Lexer& lexer, bool withNormals); // tt, ttp

// An axis and an angle in degrees.
glm::dquat readRotation(Lexer& lexer);

} // namespace bart
} // namespace hrt
