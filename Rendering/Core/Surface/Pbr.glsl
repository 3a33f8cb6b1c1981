// Physically based surfaces under direct light, by the equations of VTK's polydata mapper: Lambert
// under a specular layer of the GGX distribution (Walter et al., 2007) with Smith's shadowing
// correlated in height (Heitz, 2014) and Schlick's Fresnel term (1994), and a clear coat above. VTK's
// lights are not divided by pi; its colours are gamma encoded at the end, which makes the light of
// several sources no plain sum. In one point we differ: once a scene has a positional light, VTK's
// physically based shading takes its directional lights to shine from their position; here, as in
// Phong's shading and for shadow rays, they shine along their direction. In the common subset of
// GLSL 1.50 and C++, compiled with Shading.glsl.

#define HRT_PI real(3.14159265358979)

// Least cosine of the angles that the equations divide by.
#define HRT_LEAST_COSINE real(1e-5)

// Least square of the distribution's denominator: of a surface without any roughness, whose highlight
// has no extent, it is 0.
#define HRT_LEAST_SPREAD real(1e-20)

struct HrtPhysical
{
  vec3 albedo;
  real metallic;
  real roughness;
  real f0;       // reflectance of the base layer along its normal, where it is no metal
  vec3 edgeTint; // reflectance of metal at grazing angles
  real coat;     // strength of the clear coat, 0: none
  real coatRoughness;
  real coatF0;
  vec3 coatColor;
};

HRT_FUNCTION real hrtCosine(vec3 a, vec3 b)
{
  return clamp(dot(a, b), HRT_LEAST_COSINE, real(1.0));
}

HRT_FUNCTION vec3 hrtSchlick(vec3 f0, vec3 f90, real cosine)
{
  return f0 + (f90 - f0) * pow(real(1.0) - cosine, real(5.0));
}

// Distribution times shadowing of a rough surface: cosines of normal and half vector, viewer, light.
HRT_FUNCTION real hrtSpecularLobe(real toHalf, real toViewer, real toLight, real roughness)
{
  real square = roughness * roughness;
  real fourth = square * square;
  real spread = (toHalf * fourth - toHalf) * toHalf + real(1.0);
  real distribution = fourth / (HRT_PI * max(spread * spread, HRT_LEAST_SPREAD));
  real viewer = toLight * sqrt(square + toViewer * (toViewer - square * toViewer));
  real light = toViewer * sqrt(square + toLight * (toLight - square * toLight));
  return distribution * real(0.5) / (viewer + light);
}

// What one unshadowed light adds at a point, before gamma. `normal`, `toViewer` as for hrtShadeLight.
HRT_FUNCTION vec3 hrtShadePhysically(
  HrtPhysical surface, HrtLight light, vec3 position, vec3 normal, vec3 toViewer)
{
  real viewer = hrtCosine(normal, toViewer);
  vec3 toward = hrtLightDirectionAt(light, position);
  // The single headlight shines from the viewer on everything.
  bool fromViewer = light.kind == HRT_LIGHT_SINGLE_HEADLIGHT;
  vec3 toLight = fromViewer ? toViewer : -toward;
  // A light straight behind the surface, as the viewer sees it, has no half vector and gives nothing.
  vec3 both = toViewer + toLight;
  vec3 halfway = dot(both, both) > real(0.0) ? normalize(both) : normal;
  real facing = hrtCosine(normal, toLight);
  real toHalf = hrtCosine(normal, halfway);
  real between = fromViewer ? real(1.0) : hrtCosine(halfway, toLight);
  vec3 radiance =
    light.color * hrtAttenuation(light, toward, length(position - light.position));

  vec3 f0 = mix(vec3(surface.f0), surface.albedo, surface.metallic);
  real f90 = clamp(dot(f0, vec3(real(50.0) * real(0.33))), real(0.0), real(1.0));
  vec3 fresnel =
    hrtSchlick(f0, mix(vec3(f90), surface.edgeTint, surface.metallic), between);
  vec3 specular = fresnel * hrtSpecularLobe(toHalf, viewer, facing, surface.roughness);
  vec3 diffuse =
    (real(1.0) - surface.metallic) * (vec3(real(1.0)) - fresnel) * surface.albedo / HRT_PI;

  vec3 coat = vec3(real(0.0));
  if (surface.coat > real(0.0))
  {
    real reflected = hrtSchlick(vec3(surface.coatF0), vec3(real(1.0)), between).x;
    coat = radiance *
      (reflected * hrtSpecularLobe(toHalf, viewer, facing, surface.coatRoughness) * facing *
        surface.coat);
    real left = real(1.0) - reflected * surface.coat;
    specular = specular * (left * left);
    diffuse = diffuse * left;
    radiance = radiance * mix(vec3(real(1.0)), surface.coatColor, surface.coat);
  }
  return coat + radiance * (diffuse + specular) * facing;
}

// From the sum of all lights to the colour that VTK shows.
HRT_FUNCTION vec3 hrtEncoded(vec3 light)
{
  return pow(max(light, vec3(real(0.0))), vec3(real(1.0) / real(2.2)));
}
