// From a hit to the surface that a ray sees there: sides, normals and the terms of its reflection. Like
// Shading.glsl, with which it is compiled, this source is GLSL and C++ at once. These functions take
// values; what has to be fetched first stands in SurfaceColors.glsl.

// Barycentric interpolation: see hrtInterpolate3.
HRT_FUNCTION vec4 hrtInterpolate4(vec4 a, vec4 b, vec4 c, real u, real v)
{
  return a * (real(1.0) - u - v) + b * u + c * v;
}

HRT_FUNCTION vec2 hrtInterpolate2(vec2 a, vec2 b, vec2 c, real u, real v)
{
  return a * (real(1.0) - u - v) + b * u + c * v;
}

// The nearest texel of a width x height table at (s, t), clamped to the edge: VTK's look-up texture.
HRT_FUNCTION int hrtLookupTexel(vec2 st, int width, int height)
{
  int column = int(clamp(floor(st.x * real(width)), real(0.0), real(width - 1)));
  int row = int(clamp(floor(st.y * real(height)), real(0.0), real(height - 1)));
  return row * width + column;
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
