//VTK::System::Dec
// Fragment stage with a triangle's corners: the triangle's number plus one (zero is "no hit") and the
// rasteriser's interpolated (u, v), as 31-bit fractions, which hold every float in [0, 1] to 2^-31. An
// item buffer keeps the number only.
flat in int triangle;
in vec2 barycentric;
out uvec4 hit;
//HRT::Offset
//HRT::Holes

void main()
{
#ifdef HRT_OFFSET
  gl_FragDepth = offsetDepth();
#endif
#ifdef HRT_HOLES
  if (isHole(triangle, barycentric, gl_FrontFacing))
  {
    discard;
  }
#endif
  hit = uvec4(uint(triangle) + 1u, uvec2(clamp(barycentric, 0.0, 1.0) * 2147483648.0), 0u);
}
