//VTK::System::Dec
// Item buffer, fragment stage: the triangle's number plus one (zero is "no hit").
flat in int triangle;
out uvec4 hit;
//HRT::Offset

void main()
{
#ifdef HRT_OFFSET
  gl_FragDepth = offsetDepth();
#endif
  hit = uvec4(uint(triangle) + 1u, 0u, 0u, 0u);
}
