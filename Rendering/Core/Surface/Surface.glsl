// From a hit to the surface that a ray sees there: sides, normals and the terms of its reflection. Like
// Shading.glsl, with which it is compiled, this source is GLSL and C++ at once. These functions take
// values; what has to be fetched first stands in SurfaceColors.glsl.
//
// Beside what Shading.glsl asks for, whoever includes it provides HRT_DIRECTION(v), the unit vector
// along a v that is not zero.

// A triangle as one ray sees it.
struct HrtSides
{
  vec3 geometricNormal; // unit, towards the viewer
  bool front;           // by the corners' winding, as gl_FrontFacing
};

HRT_FUNCTION HrtSides hrtSides(vec3 a, vec3 b, vec3 c, vec3 direction)
{
  vec3 wound = cross(b - a, c - a);
  HrtSides sides;
  sides.front = !(dot(wound, direction) > real(0.0));
  sides.geometricNormal = normalize(sides.front ? wound : -wound);
  return sides;
}

// The interpolated normal, of any length, as VTK turns it: with the side that is seen, whatever way it
// points. Where normals cancel out, the triangle's own.
HRT_FUNCTION vec3 hrtSmoothNormal(vec3 smoothNormal, vec3 geometricNormal, bool side)
{
  if (!(length(smoothNormal) > real(0.0)))
  {
    return geometricNormal;
  }
  vec3 n = HRT_DIRECTION(smoothNormal);
  return side ? n : -n;
}

// One side's reflection terms. Ambient and diffuse coefficients are apart from the colours because
// scalar colours replace both colours but neither coefficient.
struct HrtTerms
{
  vec3 ambientColor;
  vec3 diffuseColor;
  vec3 specular; // colour times coefficient
  real ambient;
  real diffuse;
  real power;
  real opacity;
};

// VTK's rule: scalar colours replace the front's ambient and diffuse colour and switch the backface
// property off.
HRT_FUNCTION HrtTerms hrtWithScalarColor(HrtTerms front, vec4 color)
{
  HrtTerms terms = front;
  terms.ambientColor = vec3(color);
  terms.diffuseColor = vec3(color);
  terms.opacity = terms.opacity * color.w;
  return terms;
}

HRT_FUNCTION HrtSurface hrtSurface(HrtTerms terms)
{
  HrtSurface surface;
  surface.ambient = terms.ambientColor * terms.ambient;
  surface.diffuse = terms.diffuseColor * terms.diffuse;
  surface.specular = terms.specular;
  surface.power = terms.power;
  return surface;
}

// The surface where a share of it is edge: see Edges.glsl. Lines are ambient light alone, tubes take light
// as the surface does.
HRT_FUNCTION HrtSurface hrtWithEdges(
  HrtTerms terms, HrtSurface surface, vec3 edgeColor, real share, bool tubes)
{
  HrtSurface mixed = surface;
  mixed.diffuse =
    mix(surface.diffuse, tubes ? terms.diffuse * edgeColor : vec3(real(0.0)), share);
  mixed.ambient = mix(surface.ambient, tubes ? terms.ambient * edgeColor : edgeColor, share);
  return mixed;
}

// One of a part's textures; see TextureLookup.glsl.
struct HrtTexture
{
  ivec2 size;
  int first; // where its texels are
  bool floats;
  int wrap;
  bool linear;
  int blend;
  vec4 border;
};
