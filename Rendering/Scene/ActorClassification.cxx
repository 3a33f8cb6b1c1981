// The rules of ActorClassification.h, in the order in which they are reported.

#include "Rendering/Scene/ActorClassification.h"

#include "vtkActor.h"
#include "vtkProp.h"
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

// Subclasses of vtkActor that place their triangles by rules of their own.
const char* const kOtherActors[] = { "vtkSkybox" };

template <std::size_t N>
bool isAnyOf(vtkObject* object, const char* const (&names)[N])
{
  return std::any_of(
    std::begin(names), std::end(names), [object](const char* name) { return object->IsA(name); });
}

bool hasOwnShaders(vtkActor* actor)
{
  vtkShaderProperty* shaders = actor->GetShaderProperty();
  return shaders &&
    (shaders->GetNumberOfShaderReplacements() > 0 || shaders->HasVertexShaderCode() ||
      shaders->HasFragmentShaderCode() || shaders->HasGeometryShaderCode());
}

bool hasPhysicalTextures(vtkActor* actor)
{
  const auto& textures = actor->GetProperty()->GetAllTextures();
  return std::any_of(textures.begin(), textures.end(),
    [](const auto& entry) { return entry.second && isPhysicalTexture(entry.first); });
}

} // anonymous namespace

//------------------------------------------------------------------------------
const char* describe(LeftToVTK reason)
{
  switch (reason)
  {
    case LeftToVTK::No:
      return "";
    case LeftToVTK::NotAnActor:
      return "not an actor";
    case LeftToVTK::Volume:
      return "a volume";
    case LeftToVTK::NoMapper:
      return "the actor has no mapper and draws itself";
    case LeftToVTK::NoSurface:
      return "only vertex or line cells";
    case LeftToVTK::Wireframe:
      return "drawn as wireframe";
    case LeftToVTK::Points:
      return "drawn as points";
    case LeftToVTK::Translucent:
      return "translucent";
    case LeftToVTK::OtherActor:
      return "the actor's class places its surface itself";
    case LeftToVTK::OtherMapper:
      return "the mapper draws something other than its input's surface";
    case LeftToVTK::OtherData:
      return "the mapper's input is of a kind that has no surface";
    case LeftToVTK::SubPieces:
      return "the mapper streams its input in pieces";
    case LeftToVTK::GlyphLines:
      return "glyphs with vertex or line cells beside their surface";
    case LeftToVTK::ClippedGlyphs:
      return "glyphs clipped by the mapper's planes";
    case LeftToVTK::TexturedGlyphs:
      return "textured glyphs";
    case LeftToVTK::ProjectiveMatrix:
      return "the matrix is projective";
    case LeftToVTK::SingularMatrix:
      return "the matrix cannot be inverted or is not finite";
    case LeftToVTK::OutOfRange:
      return "its points or its bounds in the world are too large";
    case LeftToVTK::TooManyTriangles:
      return "the scene has too many triangles";
    case LeftToVTK::MipMappedTexture:
      return "its texture has mip maps";
    case LeftToVTK::OtherTexture:
      return "its texture is not an image that can be read";
    case LeftToVTK::LitByImage:
      return "physically based and lit by an environment image";
    case LeftToVTK::PhysicallyBased:
      return "physically based with textures or anisotropy";
    case LeftToVTK::ShaderReplacements:
      return "shader replacements";
  }
  return "";
}

//------------------------------------------------------------------------------
bool isHosted(LeftToVTK reason)
{
  switch (reason)
  {
    case LeftToVTK::NotAnActor:
    case LeftToVTK::Volume:
    case LeftToVTK::NoMapper:
    case LeftToVTK::NoSurface:
    case LeftToVTK::Wireframe:
    case LeftToVTK::Points:
    case LeftToVTK::Translucent:
      return true;
    default:
      return false;
  }
}

//------------------------------------------------------------------------------
bool seenByRays(LeftToVTK reason)
{
  switch (reason)
  {
    case LeftToVTK::No:
    case LeftToVTK::Translucent:
    case LeftToVTK::MipMappedTexture:
    case LeftToVTK::OtherTexture:
    case LeftToVTK::LitByImage:
    case LeftToVTK::PhysicallyBased:
    case LeftToVTK::ShaderReplacements:
      return true;
    default:
      return false;
  }
}

//------------------------------------------------------------------------------
LeftToVTK classifyProp(vtkProp* prop)
{
  return prop->IsA("vtkVolume") ? LeftToVTK::Volume : LeftToVTK::NotAnActor;
}

//------------------------------------------------------------------------------
LeftToVTK classifyActor(vtkActor* actor)
{
  if (!actor->GetMapper())
  {
    return LeftToVTK::NoMapper;
  }
  if (isAnyOf(actor, kOtherActors))
  {
    return LeftToVTK::OtherActor;
  }
  switch (actor->GetProperty()->GetRepresentation())
  {
    case VTK_POINTS:
      return LeftToVTK::Points;
    case VTK_WIREFRAME:
      return LeftToVTK::Wireframe;
    default:
      return LeftToVTK::No;
  }
}

//------------------------------------------------------------------------------
LeftToVTK classifySurface(vtkActor* actor, bool isGlass, bool litByImage)
{
  if (isPhysicallyBased(actor))
  {
    if (litByImage)
    {
      return LeftToVTK::LitByImage;
    }
    if (actor->GetProperty()->GetAnisotropy() > 0.0 || hasPhysicalTextures(actor))
    {
      return LeftToVTK::PhysicallyBased;
    }
  }
  if (hasOwnShaders(actor))
  {
    return LeftToVTK::ShaderReplacements;
  }
  // Glass lets light through by refraction; its opacity is not asked.
  if (!isGlass && isTranslucent(actor))
  {
    return LeftToVTK::Translucent;
  }
  return LeftToVTK::No;
}

//------------------------------------------------------------------------------
bool isPhysicallyBased(vtkActor* actor)
{
  vtkProperty* property = actor->GetProperty();
  return property->GetInterpolation() == VTK_PBR && property->GetLighting();
}

//------------------------------------------------------------------------------
bool isPhysicalTexture(const std::string& name)
{
  static const char* const kNames[] = { "albedoTex", "normalTex", "materialTex", "brdfTex",
    "emissiveTex", "anisotropyTex", "coatNormalTex", "colortexture" };
  return std::any_of(
    std::begin(kNames), std::end(kNames), [&name](const char* other) { return name == other; });
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
