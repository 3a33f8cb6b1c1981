// Looking a texture up and putting several together, in the common subset of GLSL 1.50 and C++. The
// rules are OpenGL's for GL_NEAREST and GL_LINEAR without mip maps, but in full precision: hardware may
// interpolate with weights of eight bits.
//
// Whoever includes it provides HRT_TEXEL(image, i), the vec4 of a texel, and, of the triangle at hand,
//   HRT_TEXTURE_COUNT, HRT_TEXTURE(k)  the HrtTextures of its part (see Surface.glsl)
//   HRT_TEXTURE_COORDINATES(k)         the vec2 of a corner
//   HRT_TEXTURE_TRANSFORMED            whether these are transformed, by the vec3s
//   HRT_TEXTURE_X, _Y, _W              over (s, t, 1): (s, t) becomes (x / w, y / w)

// As hrt::Texture::Wrap.
#define HRT_WRAP_CLAMP 0
#define HRT_WRAP_REPEAT 1
#define HRT_WRAP_MIRROR 2
#define HRT_WRAP_BORDER 3

// As hrt::TextureBlend.
#define HRT_BLEND_NONE 0
#define HRT_BLEND_REPLACE 1
#define HRT_BLEND_MODULATE 2
#define HRT_BLEND_ADD 3
#define HRT_BLEND_ADD_SIGNED 4
#define HRT_BLEND_SUBTRACT 5

// A coordinate in texels, such that the numbers next to it are those of texels after hrtWrapped: within
// two texels of the image, whatever it was before.
HRT_FUNCTION real hrtTexelCoordinate(real s, int size, int wrap)
{
  real length = real(size);
  if (wrap == HRT_WRAP_REPEAT)
  {
    return (s - floor(s)) * length;
  }
  if (wrap == HRT_WRAP_MIRROR)
  {
    return (s - real(2.0) * floor(s * real(0.5))) * length;
  }
  return clamp(s * length, real(-1.0), length + real(1.0));
}

// The texel that stands at place i of a row that goes on beyond the image; -1: the border.
HRT_FUNCTION int hrtWrapped(int i, int size, int wrap)
{
  if (wrap == HRT_WRAP_REPEAT)
  {
    return i < 0 ? i + size : i >= size ? i - size : i;
  }
  if (wrap == HRT_WRAP_MIRROR)
  {
    int k = i < 0 ? i + 2 * size : i >= 2 * size ? i - 2 * size : i;
    return k < size ? k : 2 * size - 1 - k;
  }
  if (wrap == HRT_WRAP_BORDER && (i < 0 || i >= size))
  {
    return -1;
  }
  return clamp(i, 0, size - 1);
}

HRT_FUNCTION vec4 hrtTexelAt(HrtTexture image, int x, int y)
{
  int column = hrtWrapped(x, image.size.x, image.wrap);
  int row = hrtWrapped(y, image.size.y, image.wrap);
  if (column < 0 || row < 0)
  {
    return image.border;
  }
  return HRT_TEXEL(image, row * image.size.x + column);
}

HRT_FUNCTION vec4 hrtSample(HrtTexture image, vec2 st)
{
  real x = hrtTexelCoordinate(st.x, image.size.x, image.wrap);
  real y = hrtTexelCoordinate(st.y, image.size.y, image.wrap);
  if (!image.linear)
  {
    return hrtTexelAt(image, int(floor(x)), int(floor(y)));
  }
  x = x - real(0.5);
  y = y - real(0.5);
  real left = floor(x);
  real below = floor(y);
  int i = int(left);
  int j = int(below);
  vec4 low = mix(hrtTexelAt(image, i, j), hrtTexelAt(image, i + 1, j), x - left);
  vec4 high = mix(hrtTexelAt(image, i, j + 1), hrtTexelAt(image, i + 1, j + 1), x - left);
  return mix(low, high, y - below);
}

// A texture's colour over that of the ones before it.
HRT_FUNCTION vec4 hrtBlended(vec4 below, vec4 color, int blend)
{
  vec3 under = vec3(below);
  vec3 over = vec3(color);
  if (blend == HRT_BLEND_REPLACE)
  {
    return vec4(over * color.w + under * (real(1.0) - color.w),
      color.w + below.w * (real(1.0) - color.w));
  }
  if (blend == HRT_BLEND_MODULATE)
  {
    return below * color;
  }
  if (blend == HRT_BLEND_ADD)
  {
    return vec4(over * color.w + under * below.w, below.w + color.w);
  }
  if (blend == HRT_BLEND_ADD_SIGNED)
  {
    return vec4(over * color.w + under * below.w - real(0.5), below.w + color.w - real(0.5));
  }
  if (blend == HRT_BLEND_SUBTRACT)
  {
    return vec4(under - over * color.w, below.w);
  }
  return below;
}

// VTK transforms coordinates at the vertices and interpolates what comes out.
HRT_FUNCTION vec2 hrtTextureCoordinates(int corner)
{
  vec2 st = HRT_TEXTURE_COORDINATES(corner);
  if (HRT_TEXTURE_TRANSFORMED)
  {
    vec3 p = vec3(st, real(1.0));
    st = vec2(dot(HRT_TEXTURE_X, p), dot(HRT_TEXTURE_Y, p)) / dot(HRT_TEXTURE_W, p);
  }
  return st;
}

// What the textures of the triangle's part multiply its shaded colour and its opacity with.
HRT_FUNCTION vec4 hrtTextureColor(real u, real v)
{
  vec4 color = vec4(real(1.0));
  int count = HRT_TEXTURE_COUNT;
  if (count > 0)
  {
    vec2 st = hrtInterpolate2(
      hrtTextureCoordinates(0), hrtTextureCoordinates(1), hrtTextureCoordinates(2), u, v);
    color = hrtSample(HRT_TEXTURE(0), st);
    for (int k = 1; k < count; ++k)
    {
      HrtTexture image = HRT_TEXTURE(k);
      color = hrtBlended(color, hrtSample(image, st), image.blend);
    }
  }
  return color;
}
