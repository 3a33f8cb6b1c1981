//VTK::System::Dec
// Direct rendering, fragment stage: the triangle's number plus one (zero is "no hit") and the
// rasteriser's interpolated (u, v), as 31-bit fractions, which hold every float in [0, 1] to 2^-31.
flat in int triangle;
in vec2 barycentric;
out uvec4 hit;

void main()
{
  hit = uvec4(uint(triangle) + 1u, uvec2(clamp(barycentric, 0.0, 1.0) * 2147483648.0), 0u);
}
