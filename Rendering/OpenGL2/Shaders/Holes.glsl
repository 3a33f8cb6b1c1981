// Where the textures of a part have a hole, it does not exist. Included where parts are rasterised; see
// DepthPrograms.h.
uniform samplerBuffer coordinates;
uniform samplerBuffer partTable;   // see PartTables.h
uniform isamplerBuffer partLayout;
uniform usamplerBuffer indices;
uniform int part;

//HRT::Textures

bool isHole(int triangle, vec2 barycentric, bool front)
{
  vec4 flags = texelFetch(partTable, part * PART_TEXELS + 12);
  if (!front && flags.z == 0.0) // no texture on the back
  {
    return false;
  }
  ivec3 vertices = ivec3(int(texelFetch(indices, 3 * triangle).r),
    int(texelFetch(indices, 3 * triangle + 1).r), int(texelFetch(indices, 3 * triangle + 2).r));
  int firstVertex = texelFetch(partLayout, part * LAYOUT_TEXELS + 1).w;
  int firstCoordinates = texelFetch(partLayout, part * LAYOUT_TEXELS + 2).z;
  readyTextures(part, flags, vertices - firstVertex + firstCoordinates);
  return hrtTextureColor(barycentric.x, barycentric.y).a <= 0.0;
}
