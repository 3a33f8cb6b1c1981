// The keys of vtkHybridMaterial and the checks at the only door through which values come in. A
// refused value leaves the prop as it was.

#include "vtkHybridMaterial.h"

#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkProp.h"

#include <cmath>

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkHybridMaterial);
vtkInformationKeyMacro(vtkHybridMaterial, REFLECTANCE, Double);
vtkInformationKeyMacro(vtkHybridMaterial, INDEX_OF_REFRACTION, Double);
vtkInformationKeyMacro(vtkHybridMaterial, CASTS_SHADOW, Integer);

namespace
{

// What vtkProperty alone describes: neither mirror nor glass.
constexpr double kNoReflectance = 0.0;
constexpr double kNotGlass = 0.0;
// Light is fastest in vacuum; a ratio below 1 would be a bubble, for which normals are turned.
constexpr double kLowestIndexOfRefraction = 1.0;

//------------------------------------------------------------------------------
vtkInformation* keysOf(vtkProp* prop)
{
  if (!prop->GetPropertyKeys())
  {
    vtkNew<vtkInformation> keys;
    prop->SetPropertyKeys(keys);
  }
  return prop->GetPropertyKeys();
}

//------------------------------------------------------------------------------
template <class Key, class Value>
Value valueOr(vtkProp* prop, Key* key, Value fallback)
{
  vtkInformation* keys = prop ? prop->GetPropertyKeys() : nullptr;
  return keys && keys->Has(key) ? keys->Get(key) : fallback;
}

} // anonymous namespace

//------------------------------------------------------------------------------
void vtkHybridMaterial::SetReflectance(vtkProp* prop, double reflectance)
{
  if (!prop)
  {
    vtkErrorWithObjectMacro(nullptr, "vtkHybridMaterial::SetReflectance needs a prop.");
    return;
  }
  // Written so that NaN, which fails every comparison, is refused too.
  if (!(reflectance >= 0.0 && reflectance <= 1.0))
  {
    vtkErrorWithObjectMacro(prop,
      "A reflectance must lie in [0, 1]; " << reflectance << " is refused and nothing is changed.");
    return;
  }
  keysOf(prop)->Set(REFLECTANCE(), reflectance);
}

//------------------------------------------------------------------------------
double vtkHybridMaterial::GetReflectance(vtkProp* prop)
{
  return valueOr(prop, REFLECTANCE(), kNoReflectance);
}

//------------------------------------------------------------------------------
void vtkHybridMaterial::SetGlass(vtkProp* prop, double indexOfRefraction)
{
  if (!prop)
  {
    vtkErrorWithObjectMacro(nullptr, "vtkHybridMaterial::SetGlass needs a prop.");
    return;
  }
  if (!(indexOfRefraction >= kLowestIndexOfRefraction && std::isfinite(indexOfRefraction)))
  {
    vtkErrorWithObjectMacro(prop,
      "An index of refraction must be finite and at least "
        << kLowestIndexOfRefraction << "; " << indexOfRefraction
        << " is refused and nothing is changed.");
    return;
  }
  keysOf(prop)->Set(INDEX_OF_REFRACTION(), indexOfRefraction);
}

//------------------------------------------------------------------------------
double vtkHybridMaterial::GetIndexOfRefraction(vtkProp* prop)
{
  return valueOr(prop, INDEX_OF_REFRACTION(), kNotGlass);
}

//------------------------------------------------------------------------------
void vtkHybridMaterial::SetCastsShadow(vtkProp* prop, bool castsShadow)
{
  if (!prop)
  {
    vtkErrorWithObjectMacro(nullptr, "vtkHybridMaterial::SetCastsShadow needs a prop.");
    return;
  }
  keysOf(prop)->Set(CASTS_SHADOW(), castsShadow ? 1 : 0);
}

//------------------------------------------------------------------------------
bool vtkHybridMaterial::GetCastsShadow(vtkProp* prop)
{
  return valueOr(prop, CASTS_SHADOW(), 1) != 0;
}

//------------------------------------------------------------------------------
void vtkHybridMaterial::Clear(vtkProp* prop)
{
  if (!prop)
  {
    vtkErrorWithObjectMacro(nullptr, "vtkHybridMaterial::Clear needs a prop.");
    return;
  }
  // The keys object is made even when there is none: vtkAssembly replaces the keys of its parts by
  // its own, and a part with an object of its own is known not to have been replaced.
  vtkInformation* keys = keysOf(prop);
  keys->Remove(REFLECTANCE());
  keys->Remove(INDEX_OF_REFRACTION());
  keys->Remove(CASTS_SHADOW());
}

//------------------------------------------------------------------------------
void vtkHybridMaterial::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

VTK_ABI_NAMESPACE_END
