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
#include "Rendering/Core/Surface/SurfaceColors.glsl"
#undef HRT_FUNCTION
#undef HRT_COLOR_SOURCE
#undef HRT_TERMS
#undef HRT_CORNER_COLOR
#undef HRT_CORNER_COORDINATES
#undef HRT_LOOKUP
#undef HRT_LOOKUP_SIZE
#undef HRT_COPY_COLOR
#undef HRT_COLOR_ONE

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

  const Part& ThePart;
  const Geometry& Mesh;
  std::size_t Triangle, Copy;
};

static_assert(static_cast<int>(ColorSource::Property) == HRT_COLOR_OF_PROPERTY &&
    static_cast<int>(ColorSource::Corner) == HRT_COLOR_OF_CORNERS &&
    static_cast<int>(ColorSource::Lookup) == HRT_COLOR_OF_LOOKUP,
  "the shared source knows the kinds by these numbers");

} // namespace shading
} // namespace hrt
