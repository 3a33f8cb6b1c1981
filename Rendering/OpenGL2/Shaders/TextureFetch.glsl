// What the shared source of textures asks for, fetched from the scene's tables (see PartTables.h and
// TextureBuffers.h). Of the triangle at hand:
uniform samplerBuffer texels;
uniform samplerBuffer floatTexels;
ivec3 textureCorners;        // its corners' places among all coordinates
vec4 textureX;               // the rows of its part's texture transform, and what stands beside them
vec4 textureY;
vec4 textureW;
bool textureTransformed;

// Before any of the shared functions is called.
void readyTextures(int part, vec4 flags, ivec3 corners)
{
  textureCorners = corners;
  textureX = texelFetch(partTable, part * PART_TEXELS + 13);
  textureY = texelFetch(partTable, part * PART_TEXELS + 14);
  textureW = texelFetch(partTable, part * PART_TEXELS + 15);
  textureTransformed = flags.w == 1.0;
}

HrtTexture fetchTexture(int k)
{
  int at = int(textureX.w) + k * TEXTURE_TEXELS;
  vec4 place = texelFetch(partTable, at);
  vec4 kind = texelFetch(partTable, at + 1);
  return HrtTexture(ivec2(place.xy), int(place.z) * 65536 + int(place.w), kind.x == 1.0,
    int(kind.y), kind.z == 1.0, int(kind.w), texelFetch(partTable, at + 2));
}

vec4 fetchTexel(HrtTexture image, int i)
{
  return image.floats ? texelFetch(floatTexels, image.first + i)
                      : texelFetch(texels, image.first + i);
}

#define HRT_TEXTURE_COUNT int(textureY.w)
#define HRT_TEXTURE(k) fetchTexture(k)
#define HRT_TEXEL(image, i) fetchTexel(image, i)
#define HRT_TEXTURE_COORDINATES(k) texelFetch(coordinates, textureCorners[k]).rg
#define HRT_TEXTURE_TRANSFORMED textureTransformed
#define HRT_TEXTURE_X textureX.xyz
#define HRT_TEXTURE_Y textureY.xyz
#define HRT_TEXTURE_W textureW.xyz
