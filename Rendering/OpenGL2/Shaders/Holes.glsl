// Where the textures of a part have a hole, it does not exist. Included where parts are rasterised; see
// DepthPrograms.h.
uniform samplerBuffer coordinates;
uniform samplerBuffer partTable;   // see PartTables.h
uniform isamplerBuffer partLayout;
uniform int part;

//HRT::Textures

bool isHole(int triangle, vec2 barycentric, bool front)
{
  vec4 flags = texelFetch(partTable, part * PART_TEXELS + 13);
  if (!front && flags.z == 0.0) // no texture on the back
  {
    return false;
  }
  int first = texelFetch(partLayout, part * LAYOUT_TEXELS).x;
  readyTextures(part, flags, texelFetch(partLayout, part * LAYOUT_TEXELS + 1).w,
    (triangle - first) * 3);
  return hrtTextureColor(barycentric.x, barycentric.y).a <= 0.0;
}
