// The one shading source. This file is compiled twice: into the fragment shader of the GPU ray
// caster and, through Shading.h, into hrt's C++ tracer; a mirror image and a primary hit therefore
// cannot drift apart. It is written in the common subset of GLSL 1.50 and GLM C++.
//
// The equations are those of VTK's own polydata shader (vtkOpenGLPolyDataMapper, ReplaceShaderLight
// and ReplaceShaderColor), so that a picture with all effects off equals VTK's. They are invariant
// under rotations: the GPU evaluates them in its frame (ShadingFrame.h), the tracer in world coordinates.
//
// HRT_FUNCTION is `inline` in C++ and empty in GLSL. `real` is float, or double in the reference, or lanes
// of them (Surface/SurfaceKernels.h), for which what depends on a point may not be decided by `if`:
// HRT_SELECT(c, a, b) is a where c holds and b elsewhere, HRT_ANY(c) whether c holds anywhere, and HRT_BOOL
// the type of c. A light is the same for all lanes but for its position.

// Light kinds, as in hrt::Light plus VTK's short cut for a scene whose only light is one headlight.
#define HRT_LIGHT_DIRECTIONAL 0
#define HRT_LIGHT_POSITIONAL 1
#define HRT_LIGHT_SINGLE_HEADLIGHT 2

// Lower bound of the base of a specular power: pow(0, 0) is undefined in GLSL, and VTK >= 9.3 uses
// the same floor. For every power >= 1 the term it adds is below 1e-5, 1/390 of an 8-bit step.
#define HRT_POW_FLOOR real(1e-5)

struct HrtLight
{
  vec3 position;    // unused by directional lights
  vec3 direction;   // unit, the way the light travels
  vec3 color;
  vec3 attenuation; // constant, linear, quadratic
  real cosCone;     // cosine of the cone's half angle; below -1: no cone
  real exponent;
  int kind;
};

// A surface's colours with their coefficients multiplied in.
struct HrtSurface
{
  vec3 ambient;
  vec3 diffuse;
  vec3 specular;
  real power;
};

// (t, u, v) where the ray meets the triangle's plane; no test whether it is inside. The ray is
// parallel to the plane when the determinant is 0; then t is not finite.
HRT_FUNCTION vec3 hrtIntersectPlane(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c)
{
  vec3 e1 = b - a;
  vec3 e2 = c - a;
  vec3 p = cross(direction, e2);
  real scale = real(1.0) / dot(e1, p);
  vec3 s = origin - a;
  vec3 q = cross(s, e1);
  return vec3(dot(e2, q) * scale, dot(s, p) * scale, dot(direction, q) * scale);
}

// Whether light that travels `toward` a point is in the light's cone; all is where it has none.
HRT_FUNCTION HRT_BOOL hrtInCone(HrtLight light, vec3 toward)
{
  return !(dot(toward, light.direction) < light.cosCone);
}

// Distance attenuation and cone of a light at a point whose unit direction from the light is `toward`.
HRT_FUNCTION real hrtAttenuation(HrtLight light, vec3 toward, real distanceToLight)
{
  if (light.kind != HRT_LIGHT_POSITIONAL)
  {
    return real(1.0);
  }
  real attenuation = real(1.0) /
    (light.attenuation.x + light.attenuation.y * distanceToLight +
      light.attenuation.z * distanceToLight * distanceToLight);
  if (HRT_ANY(light.cosCone >= real(-1.0)))
  {
    real coneDot = dot(toward, light.direction);
    // VTK's exponent 0 is a cone of even light; a wide cone may have a negative cosine only beyond
    // 90 degrees, where cosCone is off.
    attenuation = HRT_SELECT(hrtInCone(light, toward),
      attenuation * pow(max(coneDot, HRT_POW_FLOOR), light.exponent), real(0.0));
  }
  return attenuation;
}

// The unit direction in which light arrives at a point.
HRT_FUNCTION vec3 hrtLightDirectionAt(HrtLight light, vec3 position)
{
  if (light.kind == HRT_LIGHT_POSITIONAL)
  {
    return normalize(position - light.position);
  }
  return light.direction;
}

// The highlight at a cosine to its middle. Most surfaces have none, and a power is dear.
HRT_FUNCTION real hrtLobe(HrtSurface surface, real cosine)
{
  HRT_BOOL shines = surface.specular.x + surface.specular.y + surface.specular.z > real(0.0);
  if (HRT_ANY(shines))
  {
    return HRT_SELECT(shines,
      pow(max(cosine, HRT_POW_FLOOR), HRT_SELECT(shines, surface.power, real(1.0))), real(0.0));
  }
  return real(0.0);
}

// What one unshadowed light adds at a point. `normal` is unit and faces the viewer's side;
// `toViewer` is the unit vector from the point back along the ray that sees it.
HRT_FUNCTION vec3 hrtShadeLight(
  HrtSurface surface, HrtLight light, vec3 position, vec3 normal, vec3 toViewer)
{
  if (light.kind == HRT_LIGHT_SINGLE_HEADLIGHT)
  {
    real facing = max(real(0.0), -dot(normal, light.direction));
    return (surface.diffuse * facing + surface.specular * hrtLobe(surface, facing)) * light.color;
  }
  vec3 toward = hrtLightDirectionAt(light, position);
  real attenuation = hrtAttenuation(light, toward, length(position - light.position));
  real facing = max(real(0.0), -attenuation * dot(normal, toward));
  real lobe = hrtLobe(surface, dot(reflect(toward, normal), toViewer));
  real highlight = sign(facing) * attenuation * lobe;
  return (surface.diffuse * facing + surface.specular * highlight) * light.color;
}

// The colour of a surface that takes no part in lighting (vtkProperty::LightingOff, or no light).
HRT_FUNCTION vec3 hrtUnlit(HrtSurface surface)
{
  return surface.ambient + surface.diffuse;
}
