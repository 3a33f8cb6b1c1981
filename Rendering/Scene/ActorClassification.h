// Decides, per actor, whether the tracer draws it or VTK does. The tracer draws plain opaque
// surfaces, mirrors and glass; whatever else an actor can be - lines, points, textures, physically
// based materials, translucency - VTK draws better than we could, against our depth buffer. One
// table of rules holds the whole decision, so that statistics can say why.
#pragma once

class vtkActor;
class vtkMapper;
class vtkPolyData;

namespace hrt
{
namespace scene
{

enum class LeftToVTK
{
  No, // the tracer draws it

  // The actor has no surface that rays could meet, or none that is known.
  NoActor, // within an assembly: a volume, an image, axes, ...
  NoMapper,
  OtherActor,
  OtherMapper,
  OtherData,
  SubPieces,
  Wireframe,
  Points,
  ClippingPlanes,
  ProjectiveMatrix,
  SingularMatrix,
  OutOfRange, // its bounds in the world
  TooManyTriangles,

  // Its triangles are known, and seen in mirrors, but its picture is more than shaded triangles.
  Texture,
  EdgeVisibility,
  VertexVisibility,
  PhysicallyBased,
  ShaderReplacements,
  VertsOrLines,
  Translucent
};

// A short English phrase; empty for LeftToVTK::No.
const char* describe(LeftToVTK reason);

// Whether reflection and refraction rays see the actor's triangles.
bool seenByRays(LeftToVTK reason);

// Whether the actor's mapper is one whose picture is the surface of its input. Asked before the
// pipeline is updated.
LeftToVTK classifyMapper(vtkActor* actor);

// The rest of the rules, for an actor whose mapper passed and whose pipeline is up to date.
LeftToVTK classifySurface(vtkActor* actor, vtkMapper* mapper, vtkPolyData* input, bool isGlass);

// Some light passes, by opacity of either side, of scalars, or by force.
bool isTranslucent(vtkActor* actor);

} // namespace scene
} // namespace hrt
