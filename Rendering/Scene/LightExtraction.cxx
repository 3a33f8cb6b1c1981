// Reads the lights by the rules of vtkOpenGLRenderer::UpdateLights and UpdateLightingUniforms. The
// renderer's lights follow the camera before this is called (vtkRenderer::UpdateLightGeometry).

#include "Rendering/Scene/LightExtraction.h"

#include "Rendering/Scene/ObjectName.h"
#include "Rendering/Scene/VTKConversions.h"

#include "vtkCamera.h"
#include "vtkCollection.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkRenderer.h"

#include <cmath>

namespace hrt
{
namespace scene
{
namespace
{

// The way a light shines whose position and focal point are the same.
const glm::dvec3 kDefaultDirection(0.0, 0.0, -1.0);

//------------------------------------------------------------------------------
template <typename F>
void forEachLight(vtkRenderer* renderer, F&& f)
{
  vtkLightCollection* lights = renderer->GetLights();
  vtkCollectionSimpleIterator it;
  lights->InitTraversal(it);
  while (vtkLight* light = lights->GetNextLight(it))
  {
    f(light);
  }
}

//------------------------------------------------------------------------------
// VTK's "lighting complexity" 1, which selects a formula of its own. Lights that are switched off
// take part in the decision: any positional one, and any after the headlight that is none itself.
bool usesSingleHeadlightFormula(vtkRenderer* renderer)
{
  int on = 0;
  bool simple = true;
  forEachLight(renderer,
    [&](vtkLight* light)
    {
      on += light->GetSwitch() ? 1 : 0;
      simple =
        simple && !light->GetPositional() && on <= 1 && (on == 0 || light->LightTypeIsHeadlight());
    });
  return simple && on == 1;
}

//------------------------------------------------------------------------------
bool isFiniteLight(const Light& light)
{
  return isFinite(light.position) && isFinite(light.direction) &&
    isFinite(glm::dvec3(light.color)) && isFinite(glm::dvec3(light.attenuation)) &&
    std::isfinite(light.coneAngle) && std::isfinite(light.exponent);
}

//------------------------------------------------------------------------------
void copyTerms(vtkLight* source, Light& light)
{
  light.kind = source->GetPositional() ? Light::Kind::Positional : Light::Kind::Directional;
  light.color =
    glm::vec3(toVector(source->GetDiffuseColor()) * static_cast<double>(source->GetIntensity()));
  light.attenuation = glm::vec3(toVector(source->GetAttenuationValues()));
  light.coneAngle = static_cast<float>(source->GetConeAngle());
  light.exponent = static_cast<float>(source->GetExponent());
}

//------------------------------------------------------------------------------
// Where the light is and where it points to, in the world. A headlight that follows the camera is
// at its eye, whether or not the renderer has moved it there already.
void place(vtkLight* source, vtkRenderer* renderer, Light& light)
{
  glm::dvec3 focus;
  if (light.isHeadlight)
  {
    vtkCamera* camera = renderer->GetActiveCamera();
    light.position = toVector(camera->GetPosition());
    focus = toVector(camera->GetFocalPoint());
  }
  else
  {
    source->GetTransformedPosition(&light.position.x);
    source->GetTransformedFocalPoint(&focus.x);
  }
  light.direction = focus - light.position;
}

//------------------------------------------------------------------------------
// The view's axis in the world, by which VTK shades under a single headlight. Normals go to view
// coordinates by the inverse transpose, hence the inverse's column.
glm::dvec3 viewAxis(const Camera& camera)
{
  return -glm::dvec3(glm::inverse(camera.worldToView)[2]);
}

} // anonymous namespace

//------------------------------------------------------------------------------
LightRig extractLights(vtkRenderer* renderer, const Camera& camera, bool headlightShadows)
{
  LightRig rig;
  rig.singleHeadlight = usesSingleHeadlightFormula(renderer);
  forEachLight(renderer,
    [&](vtkLight* source)
    {
      if (!source->GetSwitch())
      {
        return;
      }
      Light light;
      light.key = reinterpret_cast<std::uintptr_t>(source);
      light.isHeadlight =
        source->LightTypeIsHeadlight() && (rig.singleHeadlight || renderer->GetLightFollowCamera());
      light.castsShadows = headlightShadows || !source->LightTypeIsHeadlight();
      copyTerms(source, light);
      place(source, renderer, light);
      if (rig.singleHeadlight)
      {
        light.direction = viewAxis(camera);
      }
      if (!isFiniteLight(light))
      {
        rig.issues.push_back(
          { light.key, nameOf(source) + " has a value that is not finite; left out" });
        return;
      }
      const double length = glm::length(light.direction);
      const bool aimed = light.kind == Light::Kind::Directional || light.isSpot();
      if (length == 0.0 && aimed)
      {
        rig.issues.push_back({ light.key,
          nameOf(source) +
            " has its position at its focal point; taken to shine along (0, 0, -1)" });
      }
      light.direction = length > 0.0 ? light.direction / length : kDefaultDirection;
      rig.lights.push_back(light);
    });
  // A single headlight that was left out leaves the scene dark, not lit by a formula without light.
  rig.singleHeadlight = rig.singleHeadlight && !rig.lights.empty();
  return rig;
}

} // namespace scene
} // namespace hrt
