// The coefficients and colours are copied as they are; the shading source multiplies them.

#include "Rendering/Scene/MaterialExtraction.h"

#include "Rendering/Scene/VTKConversions.h"
#include "Rendering/Scene/vtkHybridMaterial.h"

#include "vtkActor.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkMapper.h"
#include "vtkProperty.h"

#include "vtkVersion.h"

#include <algorithm>
#include <cmath>

// Edges have an opacity of their own since VTK 9.3, and polygon offsets a factor again.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
#define HRT_EDGE_OPACITY 1
#define HRT_OFFSET_BY_SLOPE 1
#else
#define HRT_EDGE_OPACITY 0
#define HRT_OFFSET_BY_SLOPE 0
#endif

namespace hrt
{
namespace scene
{
namespace
{

// VTK's mapper draws no edge thinner than this, in pixels.
constexpr float kLeastEdgeWidth = 1.1f;

//------------------------------------------------------------------------------
template <class Key, class Value>
Value nearestValue(const std::vector<vtkProp*>& path, Key* key, Value none)
{
  for (auto prop = path.rbegin(); prop != path.rend(); ++prop)
  {
    vtkInformation* keys = (*prop)->GetPropertyKeys();
    if (keys && keys->Has(key))
    {
      return keys->Get(key);
    }
  }
  return none;
}

//------------------------------------------------------------------------------
void apply(const PieceOverrides& overrides, PhongTerms& terms)
{
  if (overrides.color)
  {
    terms.ambientColor = terms.diffuseColor = overrides.colorValue;
  }
  if (overrides.opacity)
  {
    terms.opacity = overrides.opacityValue;
  }
}

//------------------------------------------------------------------------------
PhongTerms phongTerms(vtkProperty* property)
{
  PhongTerms terms;
  terms.ambientColor = toColor(property->GetAmbientColor());
  terms.ambient = static_cast<float>(property->GetAmbient());
  terms.diffuseColor = toColor(property->GetDiffuseColor());
  terms.diffuse = static_cast<float>(property->GetDiffuse());
  terms.specularColor = toColor(property->GetSpecularColor());
  terms.specular = static_cast<float>(property->GetSpecular());
  terms.specularPower = static_cast<float>(property->GetSpecularPower());
  terms.opacity = static_cast<float>(property->GetOpacity());
  return terms;
}

//------------------------------------------------------------------------------
EdgeStyle edgeStyle(vtkProperty* property)
{
  EdgeStyle style;
  style.visible = property->GetEdgeVisibility() != 0;
  style.color = toColor(property->GetEdgeColor());
#if HRT_EDGE_OPACITY
  style.opacity = static_cast<float>(property->GetEdgeOpacity());
#endif
  style.width = std::max(property->GetLineWidth(), kLeastEdgeWidth);
  style.tubes = property->GetRenderLinesAsTubes();
  return style;
}

//------------------------------------------------------------------------------
PhysicalTerms physicalTerms(vtkProperty* property)
{
  PhysicalTerms terms;
  terms.used = property->GetInterpolation() == VTK_PBR && property->GetLighting();
  terms.metallic = static_cast<float>(property->GetMetallic());
  terms.roughness = static_cast<float>(property->GetRoughness());
  terms.f0 = static_cast<float>(property->ComputeReflectanceOfBaseLayer());
  terms.edgeTint = toColor(property->GetEdgeTint());
  terms.coat = static_cast<float>(property->GetCoatStrength());
  terms.coatRoughness = static_cast<float>(property->GetCoatRoughness());
  // The coat lies in air.
  terms.coatF0 =
    static_cast<float>(vtkProperty::ComputeReflectanceFromIOR(property->GetCoatIOR(), 1.0));
  terms.coatColor = toColor(property->GetCoatColor());
  return terms;
}

//------------------------------------------------------------------------------
// As vtkOpenGLPolyDataMapper has it for polygons and strips: GetCoincidentParameters, and what its
// fragment shader makes of them. 65000 steps are what it takes a depth buffer for at least. Before VTK
// 9.3 the factor is not used.
DepthOffset depthOffset(vtkActor* actor)
{
  constexpr double kSteps = 65000.0;
  constexpr double kUnitsOfShift = 4.0;
  DepthOffset offset;
  const int mode = vtkMapper::GetResolveCoincidentTopology();
  if (mode == VTK_RESOLVE_SHIFT_ZBUFFER)
  {
    offset.constant = static_cast<float>(
      kUnitsOfShift * vtkMapper::GetResolveCoincidentTopologyZShift() / kSteps);
  }
  vtkMapper* const mapper = actor->GetMapper();
  if (mapper && (mode == VTK_RESOLVE_POLYGON_OFFSET || actor->GetProperty()->GetEdgeVisibility()))
  {
    double factor = 0.0, units = 0.0;
    mapper->GetCoincidentTopologyPolygonOffsetParameters(factor, units);
#if HRT_OFFSET_BY_SLOPE
    offset.slope = static_cast<float>(factor);
#endif
    offset.constant = static_cast<float>(units / kSteps);
  }
  return offset;
}

} // anonymous namespace

//------------------------------------------------------------------------------
RayKeys readRayKeys(const std::vector<vtkProp*>& path)
{
  // The keys are open to everyone; what vtkHybridMaterial would have refused is no mirror, no
  // glass.
  RayKeys keys;
  const double reflectance = nearestValue(path, vtkHybridMaterial::REFLECTANCE(), 0.0);
  keys.reflectance = reflectance >= 0.0 && reflectance <= 1.0 ? reflectance : 0.0;
  const double index = nearestValue(path, vtkHybridMaterial::INDEX_OF_REFRACTION(), 0.0);
  keys.indexOfRefraction = index >= 1.0 && std::isfinite(index) ? index : 0.0;
  keys.castsShadow = nearestValue(path, vtkHybridMaterial::CASTS_SHADOW(), 1) != 0;
  return keys;
}

//------------------------------------------------------------------------------
Material extractMaterial(vtkActor* actor, const RayKeys& keys, ColorSource colorSource,
  const PieceOverrides& overrides)
{
  vtkProperty* property = actor->GetProperty();
  Material material;
  material.front = phongTerms(property);
  // VTK's shader forgets the backface property altogether, its specular terms included, as soon as
  // the colours come from scalars.
  vtkProperty* backface =
    colorSource == ColorSource::Property ? actor->GetBackfaceProperty() : nullptr;
  material.back = backface ? phongTerms(backface) : material.front;
  apply(overrides, material.front);
  apply(overrides, material.back);
  material.lit = property->GetLighting();
  material.edges = edgeStyle(property);
  material.physical = physicalTerms(property);
  material.cullFront = property->GetFrontfaceCulling() != 0;
  material.cullBack = property->GetBackfaceCulling() != 0;
  material.depthOffset = depthOffset(actor);
  material.reflectance = static_cast<float>(keys.reflectance);
  material.indexOfRefraction = static_cast<float>(keys.indexOfRefraction);
  return material;
}

} // namespace scene
} // namespace hrt
