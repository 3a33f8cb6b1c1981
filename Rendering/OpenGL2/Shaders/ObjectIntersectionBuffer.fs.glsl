//VTK::System::Dec
// Object intersection buffer, fragment stage. Item buffer: the triangle's number plus one (zero is
// "no hit"). Direct rendering: also the rasteriser's interpolated (u, v), as 31-bit fractions,
// which hold every float in [0, 1] to 2^-31.
flat in int triangle;
in vec2 barycentric;
uniform int directRendering;
out uvec4 hit;
//HRT::Holes

void main()
{
#ifdef HRT_HOLES
  if (isHole(triangle, barycentric, gl_FrontFacing))
  {
    discard;
  }
#endif
  uvec2 uv = uvec2(0u);
  if (directRendering == 1)
  {
    uv = uvec2(clamp(barycentric, 0.0, 1.0) * 2147483648.0);
  }
  hit = uvec4(uint(triangle) + 1u, uv, 0u);
}
