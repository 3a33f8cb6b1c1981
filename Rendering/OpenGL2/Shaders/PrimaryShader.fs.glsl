//VTK::System::Dec
// The GPU ray caster (paper, section 3.2): for every pixel, look the triangle up in the object
// intersection buffer, intersect it with the primary ray or take the interpolated (u, v), test the
// shadow maps and shade. All positions are in view coordinates, or moved along their axis: ShadingFrame.h.
uniform usampler2D hitBuffer;
uniform usamplerBuffer trianglePart; // part number of each triangle
uniform usamplerBuffer indices;      // the vertices of each triangle's corners
uniform samplerBuffer positions;     // of the vertices
uniform samplerBuffer normals;       // of a part's vertices or triangles, as the next ones
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
uniform vec3 viewer; // view coordinates' origin, in the frame: see ShadingFrame.h
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

// Where the data of the triangle at hand lie, for what the shared sources ask for.
int partNumber;
ivec4 partBases;  // first triangle, normals, colours, coordinates
ivec4 partLookup; // start, width, height; first vertex
ivec4 partMore;   // whether normals and colours are the triangles'; texture coordinates; sides
int firstPlace;   // of the part's triangles in the tables
int triangleInPart;
ivec3 verticesInPart;
int colorSource;
mat4x3 positionToView;

#ifdef HRT_COPIES
uniform int firstCopied; // number of the first triangle of a part with copies; these parts come last
uniform int lastPart;
int firstTexelOfCopy; // its rows and colour among the positions
bool copied;
bool copyIsColored = false;
mat4x3 copyPlace;

// From a triangle's number to its place in the tables, with its part and its copy.
int placeOf(int triangle, out int part)
{
  copied = triangle >= firstCopied;
  if (!copied)
  {
    part = int(texelFetch(trianglePart, triangle).r);
    return triangle;
  }
  part = lastPart;
  while (texelFetch(partLayout, part * LAYOUT_TEXELS).x > triangle)
  {
    --part;
  }
  int local = triangle - texelFetch(partLayout, part * LAYOUT_TEXELS).x;
  ivec4 mesh = texelFetch(partLayout, part * LAYOUT_TEXELS + 3); // place, triangles, first, texels
  firstTexelOfCopy = mesh.z + local / mesh.y * mesh.w;
  copyIsColored = mesh.w == 4;
  copyPlace = fetchMatrix(positions, firstTexelOfCopy);
  return mesh.x + local % mesh.y;
}

// The inverse transpose but for a positive factor, which a direction does not have.
mat3 copyNormals()
{
  return mat3(cross(copyPlace[1], copyPlace[2]), cross(copyPlace[2], copyPlace[0]),
    cross(copyPlace[0], copyPlace[1])) *
    sign(dot(copyPlace[0], cross(copyPlace[1], copyPlace[2])));
}
#endif

// The vertices of one of the part's triangles among all. The last corner of the i-th is the i-th vertex.
ivec3 verticesOf(int triangle)
{
  int at = 3 * (firstPlace + triangle);
  return ivec3(int(texelFetch(indices, at).r), int(texelFetch(indices, at + 1).r),
    partLookup.w + triangle);
}

vec3 cornerInView(int vertex)
{
  vec4 local = texelFetch(positions, vertex);
#ifdef HRT_COPIES
  if (copied)
  {
    local = vec4(copyPlace * local, 1.0);
  }
#endif
  return positionToView * local;
}

// A triangle's corners in the frame.
struct Corners
{
  vec3 a;
  vec3 b;
  vec3 c;
};

Corners readyTriangle(int triangle)
{
  triangleInPart = triangle;
  ivec3 vertices = verticesOf(triangle);
  verticesInPart = vertices - partLookup.w;
  return Corners(cornerInView(vertices.x), cornerInView(vertices.y), cornerInView(vertices.z));
}

// The places of an attribute's values at the corners; `base`: of the part's first one.
ivec3 cornersFrom(int base, bool ofTriangles)
{
  return base + (ofTriangles ? ivec3(triangleInPart) : verticesInPart);
}

HrtTerms fetchTerms(bool front)
{
  int at = partNumber * PART_TEXELS + (front ? 6 : 9);
  vec4 ambient = texelFetch(partTable, at);
  vec4 diffuse = texelFetch(partTable, at + 1);
  vec4 specular = texelFetch(partTable, at + 2);
  return HrtTerms(
    ambient.rgb, diffuse.rgb, specular.rgb, ambient.w, diffuse.w, specular.w, 1.0);
}

#define HRT_COLOR_SOURCE colorSource
#define HRT_TERMS(side) fetchTerms(side)
#define HRT_CORNER_COLOR(k) texelFetch(colors, cornersFrom(partBases.z, partMore.y == 1)[k])
#define HRT_CORNER_COORDINATES(k) texelFetch(coordinates, cornersFrom(partBases.w, false)[k]).rg
#define HRT_LOOKUP(i) texelFetch(lookups, partLookup.x + (i))
#define HRT_LOOKUP_SIZE partLookup.yz
#ifdef HRT_COPIES
#define HRT_COPY_COLOR texelFetch(positions, firstTexelOfCopy + 3)
#else
#define HRT_COPY_COLOR vec4(0.0)
#endif
#define HRT_COLOR_ONE 1.0
//HRT::SurfaceColors

void readyPart(int part)
{
  partNumber = part;
  partBases = texelFetch(partLayout, part * LAYOUT_TEXELS);
  partLookup = texelFetch(partLayout, part * LAYOUT_TEXELS + 1);
  partMore = texelFetch(partLayout, part * LAYOUT_TEXELS + 2);
  firstPlace = partBases.x;
  colorSource = partBases.z >= 0 ? HRT_COLOR_OF_CORNERS
    : partBases.w >= 0           ? HRT_COLOR_OF_LOOKUP
                                 : HRT_COLOR_OF_PROPERTY;
#ifdef HRT_COPIES
  firstPlace = texelFetch(partLayout, part * LAYOUT_TEXELS + 3).x;
  if (copyIsColored)
  {
    colorSource = HRT_COLOR_OF_COPY;
  }
#endif
  positionToView = fetchMatrix(partTable, part * PART_TEXELS);
}

#ifdef HRT_TEXTURES
//HRT::Textures
#endif

#ifdef HRT_EDGES
uniform isamplerBuffer triangleSides;
uniform mat4 frameToWindow; // pixels from the picture's corner and depth, times w

vec4 windowCorner(int triangle, int k)
{
  vec4 corner = frameToWindow * vec4(cornerInView(verticesOf(triangle)[k]), 1.0);
  return vec4(corner.xy - gl_FragCoord.xy * corner.w, corner.zw);
}

#define HRT_SIDES(triangle) texelFetch(triangleSides, partMore.w + (triangle))
#define HRT_WINDOW_CORNER(triangle, k) windowCorner(triangle, k)
//HRT::Edges
#endif

#ifdef HRT_PHYSICAL
//HRT::Physical

// Of the part; metallic -1 where it is Phong's.
HrtPhysical fetchPhysical(vec3 albedo)
{
  vec4 base = texelFetch(partTable, partNumber * PART_TEXELS + 18);
  vec4 coat = texelFetch(partTable, partNumber * PART_TEXELS + 19);
  vec4 terms = texelFetch(partTable, partNumber * PART_TEXELS + 20);
  return HrtPhysical(
    albedo, terms.x, base.w, terms.y, base.rgb, coat.w, terms.z, terms.w, coat.rgb);
}
#endif

vec4 shadeHit(uvec4 hit)
{
  int triangle = int(hit.x - 1u);
#ifdef HRT_COPIES
  int part;
  triangle = placeOf(triangle, part);
#else
  int part = int(texelFetch(trianglePart, triangle).r);
#endif
  readyPart(part);
  vec4 flags = texelFetch(partTable, part * PART_TEXELS + 12); // lit, folds, textures: on back
  Corners corners = readyTriangle(triangle - firstPlace);

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
    vec3 tuv = hrtIntersectPlane(origin, direction, corners.a, corners.b, corners.c);
    uv = hrtClampBarycentrics(tuv.y, tuv.z);
  }
#ifdef HRT_EDGES
  vec4 edgeColor = vec4(0.0); // and its opacity
  vec4 edgeStyle = vec4(1.0, 0.0, 0.0, 0.0); // width, culled, tubes
  vec3 nearestEdge = vec3(0.0);
  real edgeMix = 0.0;
  if (partMore.w >= 0)
  {
    edgeColor = texelFetch(partTable, part * PART_TEXELS + 16);
    edgeStyle = texelFetch(partTable, part * PART_TEXELS + 17);
    HrtEdgeHit seen = hrtEdgeHit(triangleInPart, uv, edgeStyle.x, edgeStyle.y == 1.0);
    corners = readyTriangle(seen.triangle);
    uv = seen.uv;
    nearestEdge = seen.nearest;
    edgeMix = hrtEdgeMix(nearestEdge.z, edgeStyle.x);
  }
#endif
  vec3 a = corners.a;
  vec3 b = corners.b;
  vec3 c = corners.c;
  vec3 p = hrtInterpolate3(a, b, c, uv.x, uv.y);

  HrtSides sides = hrtSides(a, b, c, direction);
  vec3 ng = sides.geometricNormal;
  vec3 n = ng;
  if (partBases.y >= 0)
  {
    ivec3 at = cornersFrom(partBases.y, partMore.x == 1);
    mat3 toView = mat3(texelFetch(partTable, part * PART_TEXELS + 3).xyz,
      texelFetch(partTable, part * PART_TEXELS + 4).xyz,
      texelFetch(partTable, part * PART_TEXELS + 5).xyz);
#ifdef HRT_COPIES
    toView = copied ? toView * copyNormals() : toView;
#endif
    n = hrtSmoothNormal(toView * hrtInterpolate3(fetchVector(normals, at.x),
      fetchVector(normals, at.y), fetchVector(normals, at.z), uv.x, uv.y),
      ng, sides.front);
  }

  if (shadowLight >= 0)
  {
    HrtLight light = fetchLight(shadowLight);
    bool lit = hrtInCone(light, hrtLightDirectionAt(light, p));
    return vec4(lit ? lightVisibility(shadowLight, light, p, ng, flags.y) : 0.0);
  }

  HrtTerms terms = hrtTermsAt(uv.x, uv.y, sides.front);
  HrtSurface surface = hrtSurface(terms);
#ifdef HRT_EDGES
  surface =
    hrtWithEdges(terms, surface, edgeColor.rgb, edgeColor.w * edgeMix, edgeStyle.z == 1.0);
  if (edgeStyle.z == 1.0)
  {
    n = hrtTubeNormal(n, nearestEdge, edgeStyle.x, edgeMix);
  }
#endif
  vec3 color = hrtUnlit(surface);
  if (flags.x == 1.0 && unlitScene == 0)
  {
    color = surface.ambient;
#ifdef HRT_PHYSICAL
    HrtPhysical physical = fetchPhysical(surface.diffuse);
    bool isPhysical = physical.metallic >= 0.0;
    color = isPhysical ? vec3(0.0) : color;
#endif
    // As VTK does for every projection, the viewer is taken to be at the view coordinates' origin.
    vec3 toViewer = normalize(viewer - p);
    for (int i = 0; i < lightCount; ++i)
    {
      HrtLight light = fetchLight(i);
#ifdef HRT_PHYSICAL
      vec3 term = isPhysical ? hrtShadePhysically(physical, light, p, n, toViewer)
                             : hrtShadeLight(surface, light, p, n, toViewer);
#else
      vec3 term = hrtShadeLight(surface, light, p, n, toViewer);
#endif
      if (term != vec3(0.0))
      {
        color += term * lightVisibility(i, light, p, ng, flags.y);
      }
    }
#ifdef HRT_PHYSICAL
    color = isPhysical ? hrtEncoded(color) : color;
#endif
  }
#ifdef HRT_TEXTURES
  if (sides.front || flags.z == 1.0)
  {
    readyTextures(part, flags, cornersFrom(partMore.z, false));
    color *= hrtTextureColor(uv.x, uv.y).rgb;
  }
#endif
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
