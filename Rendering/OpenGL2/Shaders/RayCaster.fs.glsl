//VTK::System::Dec
// The GPU ray caster (paper, section 3.2): for every pixel, look the triangle up in the object
// intersection buffer, intersect it with the primary ray or take the interpolated (u, v), test the
// shadow maps and shade. All positions are in view coordinates.
uniform usampler2D hitBuffer;
uniform usamplerBuffer trianglePart; // part number of each triangle
uniform samplerBuffer positions;     // 3 corners a triangle
uniform samplerBuffer normals;
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

//HRT::Shading

mat4 fetchMatrix(samplerBuffer table, int at)
{
  return mat4(texelFetch(table, at), texelFetch(table, at + 1), texelFetch(table, at + 2),
    texelFetch(table, at + 3));
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

HrtSurface fetchSurface(
  int part, ivec4 bases, ivec4 more, vec4 flags, int corner, vec2 uv, bool front)
{
  int at = part * PART_TEXELS + (front || flags.x == 1.0 ? 7 : 10);
  vec4 ambient = texelFetch(partTable, at);
  vec4 diffuse = texelFetch(partTable, at + 1);
  vec4 specular = texelFetch(partTable, at + 2);
  if (bases.z >= 0)
  {
    int c = bases.z * 3 + corner;
    vec3 rgb = hrtInterpolate4(texelFetch(colors, c), texelFetch(colors, c + 1),
      texelFetch(colors, c + 2), uv.x, uv.y).rgb;
    ambient.rgb = rgb;
    diffuse.rgb = rgb;
  }
  else if (bases.w >= 0)
  {
    int c = bases.w * 3 + corner;
    vec2 st = hrtInterpolate2(texelFetch(coordinates, c).rg, texelFetch(coordinates, c + 1).rg,
      texelFetch(coordinates, c + 2).rg, uv.x, uv.y);
    vec3 rgb = texelFetch(lookups, more.x + hrtLookupTexel(st, more.y, more.z)).rgb;
    ambient.rgb = rgb;
    diffuse.rgb = rgb;
  }
  return HrtSurface(ambient.rgb * ambient.w, diffuse.rgb * diffuse.w, specular.rgb, specular.w);
}

vec4 shadeHit(uvec4 hit)
{
  int triangle = int(hit.x - 1u);
  int part = int(texelFetch(trianglePart, triangle).r);
  ivec4 bases = texelFetch(partLayout, part * LAYOUT_TEXELS);    // first triangle, normals, colours, coordinates
  ivec4 more = texelFetch(partLayout, part * LAYOUT_TEXELS + 1); // lookup start, width, height
  vec4 flags = texelFetch(partTable, part * PART_TEXELS + 13); // scalar colours, lit, folds
  int corner = (triangle - bases.x) * 3; // within the part

  mat4 positionToView = fetchMatrix(partTable, part * PART_TEXELS);
  vec3 a = (positionToView * texelFetch(positions, triangle * 3)).xyz;
  vec3 b = (positionToView * texelFetch(positions, triangle * 3 + 1)).xyz;
  vec3 c = (positionToView * texelFetch(positions, triangle * 3 + 2)).xyz;

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
  if (bases.y >= 0)
  {
    int at = bases.y * 3 + corner;
    mat3 toView = mat3(texelFetch(partTable, part * PART_TEXELS + 4).xyz,
      texelFetch(partTable, part * PART_TEXELS + 5).xyz,
      texelFetch(partTable, part * PART_TEXELS + 6).xyz);
    n = normalize(toView * hrtInterpolate3(texelFetch(normals, at).xyz,
      texelFetch(normals, at + 1).xyz, texelFetch(normals, at + 2).xyz, uv.x, uv.y));
    n = front ? n : -n;
  }

  if (shadowLight >= 0)
  {
    return vec4(lightVisibility(shadowLight, fetchLight(shadowLight), p, ng, flags.z));
  }

  HrtSurface surface = fetchSurface(part, bases, more, flags, corner, uv, front);
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
