// One triangle of a snapshot as the shared source of colours (SurfaceColors.glsl) asks for it, compiled
// as C++.
#pragma once

#include "Rendering/Core/Shading/Shading.h"
#include "Rendering/Core/Snapshot.h"

#include <cstddef>

namespace hrt
{
namespace shading
{

inline HrtTerms termsOf(const PhongTerms& terms)
{
  HrtTerms t;
  t.ambientColor = terms.ambientColor;
  t.diffuseColor = terms.diffuseColor;
  t.specular = terms.specularColor * terms.specular;
  t.ambient = terms.ambient;
  t.diffuse = terms.diffuse;
  t.power = terms.specularPower;
  t.opacity = terms.opacity;
  return t;
}

// A view, as light as a pointer. Its functions are not const only because the source is GLSL too.
class SurfaceColors
{
public:
  // `triangle`: within the part's geometry; `copy`: which of its copies.
  SurfaceColors(const Part& part, std::size_t triangle, std::size_t copy)
    : ThePart(part)
    , Mesh(*part.geometry)
    , Triangle(triangle)
    , Copy(copy)
  {
  }

#define HRT_FUNCTION
#define HRT_COLOR_SOURCE this->colorSource()
#define HRT_TERMS(side) this->terms(side)
#define HRT_CORNER_COLOR(k) glm::vec4(this->Mesh.cornersOf(this->Mesh.colors, this->Triangle)[k])
#define HRT_CORNER_COORDINATES(k) this->Mesh.cornersOf(this->Mesh.coordinates, this->Triangle)[k]
#define HRT_LOOKUP(i) glm::vec4(this->Mesh.lookup[static_cast<std::size_t>(i)])
#define HRT_LOOKUP_SIZE glm::ivec2(this->Mesh.lookupWidth, this->Mesh.lookupHeight)
#define HRT_COPY_COLOR glm::vec4(this->ThePart.copies->colors[this->Copy])
#define HRT_COLOR_ONE 255.0f
#define HRT_TEXTURE_COUNT this->textureCount()
#define HRT_TEXTURE(k) this->texture(k)
#define HRT_TEXEL(image, i) this->texel((image).first, i)
#define HRT_TEXTURE_COORDINATES(k) \
  this->Mesh.cornersOf(this->Mesh.textureCoordinates, this->Triangle)[static_cast<std::size_t>(k)]
#define HRT_TEXTURE_TRANSFORMED this->ThePart.material.textures.transformed
#define HRT_TEXTURE_X this->ThePart.material.textures.transformX
#define HRT_TEXTURE_Y this->ThePart.material.textures.transformY
#define HRT_TEXTURE_W this->ThePart.material.textures.transformW
#include "Rendering/Core/Surface/SurfaceColors.glsl"
#include "Rendering/Core/Surface/TextureLookup.glsl"
#undef HRT_FUNCTION
#undef HRT_COLOR_SOURCE
#undef HRT_TERMS
#undef HRT_CORNER_COLOR
#undef HRT_CORNER_COORDINATES
#undef HRT_LOOKUP
#undef HRT_LOOKUP_SIZE
#undef HRT_COPY_COLOR
#undef HRT_COLOR_ONE
#undef HRT_TEXTURE_COUNT
#undef HRT_TEXTURE
#undef HRT_TEXEL
#undef HRT_TEXTURE_COORDINATES
#undef HRT_TEXTURE_TRANSFORMED
#undef HRT_TEXTURE_X
#undef HRT_TEXTURE_Y
#undef HRT_TEXTURE_W

  // 1 where the side that is seen shows no texture.
  glm::vec4 textureColor(float u, float v, bool front)
  {
    return front || this->ThePart.material.textures.onBack ? this->hrtTextureColor(u, v)
                                                           : glm::vec4(1.0f);
  }

private:
  int colorSource() const
  {
    return this->ThePart.copies && !this->ThePart.copies->colors.empty()
      ? HRT_COLOR_OF_COPY
      : static_cast<int>(this->Mesh.colorSource);
  }
  HrtTerms terms(bool front) const
  {
    return termsOf(front ? this->ThePart.material.front : this->ThePart.material.back);
  }

  // Without coordinates VTK shows no texture.
  int textureCount() const
  {
    return this->Mesh.textureCoordinates.empty()
      ? 0
      : static_cast<int>(this->ThePart.material.textures.layers.size());
  }
  const TextureLayer& layer(int k) const
  {
    return this->ThePart.material.textures.layers[static_cast<std::size_t>(k)];
  }
  HrtTexture texture(int k) const
  {
    const Texture& source = *this->layer(k).texture;
    HrtTexture t;
    t.size = glm::ivec2(source.width, source.height);
    t.first = k; // its texels are found by its place among the part's
    t.floats = !source.floats.empty();
    t.wrap = static_cast<int>(source.wrap);
    t.linear = source.linear;
    t.blend = static_cast<int>(this->layer(k).blend);
    t.border = source.border;
    return t;
  }
  glm::vec4 texel(int k, int i) const
  {
    const Texture& source = *this->layer(k).texture;
    const auto place = static_cast<std::size_t>(i);
    return source.floats.empty() ? glm::vec4(source.bytes[place]) / 255.0f
                                 : source.floats[place];
  }

  const Part& ThePart;
  const Geometry& Mesh;
  std::size_t Triangle, Copy;
};

static_assert(static_cast<int>(ColorSource::Property) == HRT_COLOR_OF_PROPERTY &&
    static_cast<int>(ColorSource::Corner) == HRT_COLOR_OF_CORNERS &&
    static_cast<int>(ColorSource::Lookup) == HRT_COLOR_OF_LOOKUP,
  "the shared source knows the kinds by these numbers");
static_assert(static_cast<int>(Texture::Wrap::ClampToEdge) == HRT_WRAP_CLAMP &&
    static_cast<int>(Texture::Wrap::Repeat) == HRT_WRAP_REPEAT &&
    static_cast<int>(Texture::Wrap::MirroredRepeat) == HRT_WRAP_MIRROR &&
    static_cast<int>(Texture::Wrap::ClampToBorder) == HRT_WRAP_BORDER,
  "and the wraps");
static_assert(static_cast<int>(TextureBlend::None) == HRT_BLEND_NONE &&
    static_cast<int>(TextureBlend::Replace) == HRT_BLEND_REPLACE &&
    static_cast<int>(TextureBlend::Modulate) == HRT_BLEND_MODULATE &&
    static_cast<int>(TextureBlend::Add) == HRT_BLEND_ADD &&
    static_cast<int>(TextureBlend::AddSigned) == HRT_BLEND_ADD_SIGNED &&
    static_cast<int>(TextureBlend::Subtract) == HRT_BLEND_SUBTRACT,
  "and the ways of blending");

} // namespace shading
} // namespace hrt
