/**
 * @class   vtkHybridMaterial
 * @brief   mirrors and glass for the actors of a scene
 *
 * vtkProperty describes how a surface answers to lights, but knows neither mirror images nor
 * refraction. vtkHybridMaterial adds the two numbers that vtkHybridRayTracingPass needs for them,
 * and whether a prop casts shadows. It has static methods only; the values live in the prop's property keys
 * (vtkProp::GetPropertyKeys), so that they are copied by vtkProp::ShallowCopy and cost nothing for
 * props without them.
 *
 * A value set on a vtkAssembly holds for all of its parts that have none of their own.
 *
 * Plain opacity stays plain transparency: an actor refracts light only after SetGlass.
 *
 * @sa
 * vtkProperty vtkHybridRayTracingPass
 */

#ifndef vtkHybridMaterial_h
#define vtkHybridMaterial_h

#include "vtkHybridRenderingSceneModule.h" // For export macro
#include "vtkHybridVersion.h"              // For the ABI namespace
#include "vtkObject.h"

VTK_ABI_NAMESPACE_BEGIN

class vtkInformationDoubleKey;
class vtkInformationIntegerKey;
class vtkProp;

class VTKHYBRIDRENDERINGSCENE_EXPORT vtkHybridMaterial : public vtkObject
{
public:
  static vtkHybridMaterial* New();
  vtkTypeMacro(vtkHybridMaterial, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Set/Get the share of the mirror image in the colour of a prop's surface: 0 is no mirror, 1
   * shows nothing but the mirror image. The remaining share, 1 - reflectance, is the colour that
   * vtkProperty gives. A value outside [0, 1] or NaN is refused with an error and changes nothing.
   * Range [0, 1], no unit. Default: 0.
   */
  static void SetReflectance(vtkProp* prop, double reflectance);
  static double GetReflectance(vtkProp* prop);
  ///@}

  ///@{
  /**
   * Make a prop's surface the boundary of a glass body, with the given index of refraction: the
   * ratio of the index inside to the index outside. Inside is behind the front faces, as the order
   * of a cell's points tells them (vtkPolyDataNormals::AutoOrientNormalsOn turns them right for a
   * closed surface). 1 is air in air, 1.33 water, 1.5 window glass, 2.42 diamond. A value below 1,
   * infinite or NaN is refused with an error and changes nothing. Range [1, infinity), no unit.
   * GetIndexOfRefraction returns 0 for a prop that is not of glass, which is the default.
   */
  static void SetGlass(vtkProp* prop, double indexOfRefraction);
  static double GetIndexOfRefraction(vtkProp* prop);
  ///@}

  ///@{
  /**
   * Set/Get whether a prop casts shadows. Off, light passes it as if it were not there, while it is
   * seen and receives shadows as before: for the mesh of a lamp or a sun that has a light inside.
   * Glass casts no shadow either way. Default: true.
   */
  static void SetCastsShadow(vtkProp* prop, bool castsShadow);
  static bool GetCastsShadow(vtkProp* prop);
  ///@}

  /**
   * Make a prop an ordinary one again: neither mirror nor glass, and casting shadows.
   */
  static void Clear(vtkProp* prop);

  ///@{
  /**
   * The keys under which the values are kept in the prop's property keys. Scripts should prefer the
   * methods above, which check the range.
   */
  static vtkInformationDoubleKey* REFLECTANCE();
  static vtkInformationDoubleKey* INDEX_OF_REFRACTION();
  static vtkInformationIntegerKey* CASTS_SHADOW();
  ///@}

protected:
  vtkHybridMaterial() = default;
  ~vtkHybridMaterial() override = default;

private:
  vtkHybridMaterial(const vtkHybridMaterial&) = delete;
  void operator=(const vtkHybridMaterial&) = delete;
};

VTK_ABI_NAMESPACE_END
#endif
