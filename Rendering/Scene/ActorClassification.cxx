// The rules of ActorClassification.h, in the order in which they are reported.

#include "Rendering/Scene/ActorClassification.h"

#include "vtkActor.h"
#include "vtkDataSetMapper.h"
#include "vtkPlaneCollection.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkShaderProperty.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace hrt
{
namespace scene
{
namespace
{

// Subclasses of vtkPolyDataMapper whose picture is not the surface of their input. Named by text:
// they live in modules that we do not link, and some exist in a few VTK releases only.
const char* const kOtherMappers[] = { "vtkCompositePolyDataMapper", "vtkCompositePolyDataMapper2",
  "vtkCompositeMapperHelper2", "vtkOpenGLBatchedPolyDataMapper", "vtkOpenGLGlyph3DHelper",
  "vtkPointGaussianMapper", "vtkOpenGLSphereMapper", "vtkOpenGLStickMapper", "vtkSurfaceLICMapper",
  "vtkOpenGLSurfaceProbeVolumeMapper" };

// Subclasses of vtkActor that place their triangles by rules of their own.
const char* const kOtherActors[] = { "vtkSkybox" };

template <std::size_t N>
bool isAnyOf(vtkObject* object, const char* const (&names)[N])
{
  return std::any_of(
    std::begin(names), std::end(names), [object](const char* name) { return object->IsA(name); });
}

bool hasClippingPlanes(vtkMapper* mapper)
{
  vtkPlaneCollection* planes = mapper->GetClippingPlanes();
  return planes && planes->GetNumberOfItems() > 0;
}

bool hasOwnShaders(vtkActor* actor)
{
  vtkShaderProperty* shaders = actor->GetShaderProperty();
  return shaders &&
    (shaders->GetNumberOfShaderReplacements() > 0 || shaders->HasVertexShaderCode() ||
      shaders->HasFragmentShaderCode() || shaders->HasGeometryShaderCode());
}

bool hasVertsOrLines(vtkPolyData* input)
{
  return input->GetNumberOfVerts() > 0 || input->GetNumberOfLines() > 0;
}

} // anonymous namespace

//------------------------------------------------------------------------------
const char* describe(LeftToVTK reason)
{
  switch (reason)
  {
    case LeftToVTK::No:
      return "";
    case LeftToVTK::NoActor:
      return "it holds a prop that is not an actor";
    case LeftToVTK::NoMapper:
      return "the actor has no mapper and draws itself";
    case LeftToVTK::OtherActor:
      return "the actor's class places its surface itself";
    case LeftToVTK::OtherMapper:
      return "the mapper draws something other than its input's surface";
    case LeftToVTK::OtherData:
      return "the mapper's input is not vtkPolyData";
    case LeftToVTK::SubPieces:
      return "the mapper streams its input in pieces";
    case LeftToVTK::Wireframe:
      return "drawn as wireframe";
    case LeftToVTK::Points:
      return "drawn as points";
    case LeftToVTK::ClippingPlanes:
      return "clipped by the mapper's planes";
    case LeftToVTK::ProjectiveMatrix:
      return "the matrix is projective";
    case LeftToVTK::SingularMatrix:
      return "the matrix cannot be inverted or is not finite";
    case LeftToVTK::OutOfRange:
      return "its bounds in the world are too large";
    case LeftToVTK::TooManyTriangles:
      return "the scene has too many triangles";
    case LeftToVTK::Texture:
      return "textured";
    case LeftToVTK::EdgeVisibility:
      return "edges are shown";
    case LeftToVTK::VertexVisibility:
      return "vertices are shown";
    case LeftToVTK::PhysicallyBased:
      return "physically based material";
    case LeftToVTK::ShaderReplacements:
      return "shader replacements";
    case LeftToVTK::VertsOrLines:
      return "the input has vertex or line cells";
    case LeftToVTK::Translucent:
      return "translucent";
  }
  return "";
}

//------------------------------------------------------------------------------
bool seenByRays(LeftToVTK reason)
{
  switch (reason)
  {
    case LeftToVTK::No:
    case LeftToVTK::Texture:
    case LeftToVTK::EdgeVisibility:
    case LeftToVTK::VertexVisibility:
    case LeftToVTK::PhysicallyBased:
    case LeftToVTK::ShaderReplacements:
    case LeftToVTK::VertsOrLines:
    case LeftToVTK::Translucent:
      return true;
    default:
      return false;
  }
}

//------------------------------------------------------------------------------
LeftToVTK classifyMapper(vtkActor* actor)
{
  vtkMapper* mapper = actor->GetMapper();
  if (!mapper)
  {
    return LeftToVTK::NoMapper;
  }
  if (isAnyOf(actor, kOtherActors))
  {
    return LeftToVTK::OtherActor;
  }
  // vtkDataSetMapper hands vtkPolyData unchanged to a vtkPolyDataMapper with its own settings.
  vtkPolyDataMapper* surface = vtkPolyDataMapper::SafeDownCast(mapper);
  if ((!surface && !vtkDataSetMapper::SafeDownCast(mapper)) || isAnyOf(mapper, kOtherMappers))
  {
    return LeftToVTK::OtherMapper;
  }
  // The whole input never exists at one time then.
  if (surface && surface->GetNumberOfSubPieces() > 1)
  {
    return LeftToVTK::SubPieces;
  }
  return LeftToVTK::No;
}

//------------------------------------------------------------------------------
LeftToVTK classifySurface(vtkActor* actor, vtkMapper* mapper, vtkPolyData* input, bool isGlass)
{
  vtkProperty* property = actor->GetProperty();
  if (property->GetRepresentation() != VTK_SURFACE)
  {
    return property->GetRepresentation() == VTK_POINTS ? LeftToVTK::Points : LeftToVTK::Wireframe;
  }
  if (hasClippingPlanes(mapper))
  {
    return LeftToVTK::ClippingPlanes;
  }
  if (actor->GetTexture() || property->GetNumberOfTextures() > 0)
  {
    return LeftToVTK::Texture;
  }
  if (property->GetEdgeVisibility())
  {
    return LeftToVTK::EdgeVisibility;
  }
  if (property->GetVertexVisibility())
  {
    return LeftToVTK::VertexVisibility;
  }
  if (property->GetInterpolation() == VTK_PBR)
  {
    return LeftToVTK::PhysicallyBased;
  }
  if (hasOwnShaders(actor))
  {
    return LeftToVTK::ShaderReplacements;
  }
  if (hasVertsOrLines(input))
  {
    return LeftToVTK::VertsOrLines;
  }
  // Glass lets light through by refraction; its opacity is not asked.
  if (!isGlass && isTranslucent(actor))
  {
    return LeftToVTK::Translucent;
  }
  return LeftToVTK::No;
}

//------------------------------------------------------------------------------
bool isTranslucent(vtkActor* actor)
{
  // vtkActor asks neither for the backface property nor, when ForceOpaque is on, for any opacity;
  // blending happens all the same.
  vtkProperty* backface = actor->GetBackfaceProperty();
  return actor->HasTranslucentPolygonalGeometry() || actor->GetProperty()->GetOpacity() < 1.0 ||
    (backface && backface->GetOpacity() < 1.0);
}

} // namespace scene
} // namespace hrt
