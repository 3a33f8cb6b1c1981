//VTK::System::Dec
// The GPU ray caster (paper, section 3.2): for every pixel, look the triangle up in the object
// intersection buffer, intersect it with the primary ray or take the interpolated (u, v), test the
// shadow maps and shade. All positions are in view coordinates.
uniform usampler2D hitBuffer;
uniform usamplerBuffer trianglePart; // part number of each triangle
uniform usamplerBuffer indices;       // the vertices of each triangle's corners
uniform samplerBuffer positions;     // of the vertices
uniform samplerBuffer normals;       // of a part's vertices, or of its triangles, as the next ones
uniform samplerBuffer colors;
uniform samplerBuffer coordinates;
uniform samplerBuffer lookups;
uniform samplerBuffer partTable;     // PART_TEXELS a part, see PartTables.h
uniform isamplerBuffer partLayout;   // LAYOUT_TEXELS a part
uniform samplerBuffer lightTable;    // LIGHT_TEXELS a light
uniform samplerBuffer shadowFaces;   // FACE_TEXELS a face, see ShadowMaps.h
uniform sampler2D shadowAtlas;
uniform float shadowClearDepth;
uniform int lightCount;
uniform int unlitScene;              // no light at all
uniform int directRendering;
uniform int shadowLight;             // >= 0: write this light's visible share instead of a colour
uniform vec2 viewportSize;
uniform vec4 noHit;
uniform int triangleLimit;
uniform vec3 rayOrigin0, rayOriginX, rayOriginY;
uniform vec3 rayDirection0, rayDirectionX, rayDirectionY;
out vec4 fragmentColor;

//HRT::Fetch
//HRT::Shading

// A matrix of three rows, the fourth being (0, 0, 0, 1).
mat4x3 fetchMatrix(samplerBuffer table, int at)
{
  vec4 x = texelFetch(table, at);
  vec4 y = texelFetch(table, at + 1);
  vec4 z = texelFetch(table, at + 2);
  return mat4x3(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z, x.w, y.w, z.w);
}

HrtLight fetchLight(int index)
{
  int at = index * LIGHT_TEXELS;
  vec4 t0 = texelFetch(lightTable, at);
  vec4 t1 = texelFetch(lightTable, at + 1);
  vec4 t2 = texelFetch(lightTable, at + 2);
  vec4 t3 = texelFetch(lightTable, at + 3);
  return HrtLight(t0.xyz, t1.xyz, t2.xyz, t3.xyz, t1.w, t2.w, int(t0.w));
}

// Share of a light that reaches point p of a triangle with unit normal ng on the viewer's side.
float lightVisibility(int index, HrtLight light, vec3 p, vec3 ng, float folds)
{
  vec4 t4 = texelFetch(lightTable, index * LIGHT_TEXELS + 4);
  return hrtLightVisibility(int(t4.x), int(t4.y), light, p, ng, folds);
}

// A triangle, its part, and where an attribute's values at its corners lie from the start of the part.
struct Place
{
  int part;
  ivec4 bases;     // first triangle, normals, colours, coordinates
  ivec4 more;      // lookup start, width, height, first vertex
  ivec4 ofTriangles; // whether normals, colours
  int triangle;    // within the part
  ivec3 vertices;  // within the part
};

ivec3 cornersOf(Place place, int base, bool ofTriangles)
{
  return base + (ofTriangles ? ivec3(place.triangle) : place.vertices);
}

HrtSurface fetchSurface(Place place, vec4 flags, vec2 uv, bool front)
{
  int at = place.part * PART_TEXELS + (front || flags.x == 1.0 ? 6 : 9);
  vec4 ambient = texelFetch(partTable, at);
  vec4 diffuse = texelFetch(partTable, at + 1);
  vec4 specular = texelFetch(partTable, at + 2);
  if (place.bases.z >= 0)
  {
    ivec3 c = cornersOf(place, place.bases.z, place.ofTriangles.y == 1);
    vec3 rgb = hrtInterpolate4(texelFetch(colors, c.x), texelFetch(colors, c.y),
      texelFetch(colors, c.z), uv.x, uv.y).rgb;
    ambient.rgb = rgb;
    diffuse.rgb = rgb;
  }
  else if (place.bases.w >= 0)
  {
    ivec3 c = cornersOf(place, place.bases.w, false);
    vec2 st = hrtInterpolate2(texelFetch(coordinates, c.x).rg, texelFetch(coordinates, c.y).rg,
      texelFetch(coordinates, c.z).rg, uv.x, uv.y);
    vec3 rgb =
      texelFetch(lookups, place.more.x + hrtLookupTexel(st, place.more.y, place.more.z)).rgb;
    ambient.rgb = rgb;
    diffuse.rgb = rgb;
  }
  return HrtSurface(ambient.rgb * ambient.w, diffuse.rgb * diffuse.w, specular.rgb, specular.w);
}

vec4 shadeHit(uvec4 hit)
{
  int triangle = int(hit.x - 1u);
  int part = int(texelFetch(trianglePart, triangle).r);
  Place place;
  place.part = part;
  place.bases = texelFetch(partLayout, part * LAYOUT_TEXELS);
  place.more = texelFetch(partLayout, part * LAYOUT_TEXELS + 1);
  place.ofTriangles = texelFetch(partLayout, part * LAYOUT_TEXELS + 2);
  place.triangle = triangle - place.bases.x;
  // The last corner of a part's i-th triangle is its i-th vertex.
  ivec3 vertices = ivec3(int(texelFetch(indices, 3 * triangle).r),
    int(texelFetch(indices, 3 * triangle + 1).r), place.more.w + place.triangle);
  place.vertices = vertices - place.more.w;
  vec4 flags = texelFetch(partTable, part * PART_TEXELS + 12); // scalar colours, lit, folds

  mat4x3 positionToView = fetchMatrix(partTable, part * PART_TEXELS);
  vec3 a = positionToView * vec4(fetchVector(positions, vertices.x), 1.0);
  vec3 b = positionToView * vec4(fetchVector(positions, vertices.y), 1.0);
  vec3 c = positionToView * vec4(fetchVector(positions, vertices.z), 1.0);

  vec2 ndc = gl_FragCoord.xy / viewportSize * 2.0 - 1.0;
  vec3 origin = rayOrigin0 + ndc.x * rayOriginX + ndc.y * rayOriginY;
  vec3 direction = rayDirection0 + ndc.x * rayDirectionX + ndc.y * rayDirectionY;

  vec2 uv;
  if (directRendering == 1)
  {
    uv = vec2(hit.yz) / 2147483648.0;
  }
  else
  {
    vec3 tuv = hrtIntersectPlane(origin, direction, a, b, c);
    uv = hrtClampBarycentrics(tuv.y, tuv.z);
  }
  vec3 p = hrtInterpolate3(a, b, c, uv.x, uv.y);

  vec3 face = cross(b - a, c - a);
  bool front = dot(face, direction) <= 0.0;
  vec3 ng = normalize(front ? face : -face);
  vec3 n = ng;
  if (place.bases.y >= 0)
  {
    ivec3 at = cornersOf(place, place.bases.y, place.ofTriangles.x == 1);
    mat3 toView = mat3(texelFetch(partTable, part * PART_TEXELS + 3).xyz,
      texelFetch(partTable, part * PART_TEXELS + 4).xyz,
      texelFetch(partTable, part * PART_TEXELS + 5).xyz);
    n = normalize(toView * hrtInterpolate3(fetchVector(normals, at.x), fetchVector(normals, at.y),
      fetchVector(normals, at.z), uv.x, uv.y));
    n = front ? n : -n;
  }

  if (shadowLight >= 0)
  {
    return vec4(lightVisibility(shadowLight, fetchLight(shadowLight), p, ng, flags.z));
  }

  HrtSurface surface = fetchSurface(place, flags, uv, front);
  vec3 color = hrtUnlit(surface);
  if (flags.y == 1.0 && unlitScene == 0)
  {
    color = surface.ambient;
    // As VTK does for every projection, the viewer is taken to be at the view coordinates' origin.
    vec3 toViewer = normalize(-p);
    for (int i = 0; i < lightCount; ++i)
    {
      HrtLight light = fetchLight(i);
      vec3 term = hrtShadeLight(surface, light, p, n, toViewer);
      if (term != vec3(0.0))
      {
        color += term * lightVisibility(i, light, p, ng, flags.z);
      }
    }
  }
  return vec4(color, 1.0);
}

void main()
{
  // A branch around all the work instead of a discard: a software rasteriser executes what follows a
  // discard for blocks of background pixels too.
  uvec4 hit = texelFetch(hitBuffer, ivec2(gl_FragCoord.xy), 0);
  fragmentColor = noHit;
  if (hit.x != 0u && int(hit.x) <= triangleLimit) // a driver's wild id must not be looked up
  {
    fragmentColor = shadeHit(hit);
  }
}
