// Decides, per actor, whether the tracer draws it or VTK does. The tracer draws opaque surfaces,
// mirrors and glass. Lines, points, volumes and what light passes through are VTK's by nature: it
// draws them against our depth buffer, and they are called hosted. A surface that should be traced
// and is not is left to VTK, with the reason. One table of rules holds the whole decision, so that
// statistics can say why.
#pragma once

#include <string>

class vtkActor;
class vtkProp;

namespace hrt
{
namespace scene
{

enum class LeftToVTK
{
  No, // the tracer draws it

  // Hosted: no surface, or one that light passes through.
  NotAnActor, // a volume, an image, axes, ...
  Volume,
  NoMapper,
  NoSurface, // lines and vertices only
  Wireframe,
  Points,
  Translucent, // seen by rays

  // A surface that rays cannot meet, or none that is known.
  OtherActor,
  OtherMapper,
  OtherData,
  SubPieces,
  GlyphLines,
  ClippedGlyphs,
  TexturedGlyphs,
  ProjectiveMatrix,
  SingularMatrix,
  OutOfRange, // its points, or its bounds in the world
  TooManyTriangles,

  // Its triangles are known, and seen in mirrors, but its picture is more than shaded triangles.
  MipMappedTexture,
  OtherTexture,
  LitByImage,
  PhysicallyBased,
  ShaderReplacements
};

// A short English phrase; empty for LeftToVTK::No.
const char* describe(LeftToVTK reason);

// Whether VTK draws it because it is no opaque surface, and not for want of something here.
bool isHosted(LeftToVTK reason);

// Whether reflection and refraction rays see the actor's triangles.
bool seenByRays(LeftToVTK reason);

// Of a prop that is no actor.
LeftToVTK classifyProp(vtkProp* prop);

// What can be said of an actor before its pipeline is updated.
LeftToVTK classifyActor(vtkActor* actor);

// The rest of the rules, for an actor that passed and whose pipeline is up to date.
// `litByImage`: the renderer lights physically based surfaces by its environment texture.
LeftToVTK classifySurface(vtkActor* actor, bool isGlass, bool litByImage);

// VTK lights it by its physically based equations: then it shows no textures but those that these use.
bool isPhysicallyBased(vtkActor* actor);

// Whether physically based shading knows a property's texture by that name; Phong's leaves it out.
bool isPhysicalTexture(const std::string& name);

// Some light passes, by opacity of either side, of scalars, or by force.
bool isTranslucent(vtkActor* actor);

} // namespace scene
} // namespace hrt
