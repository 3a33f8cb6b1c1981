//VTK::System::Dec
// Shadow map, fragment stage: only the depth, which the rasteriser writes, is wanted.
//HRT::Holes

#ifdef HRT_HOLES
flat in int triangle;
in vec2 barycentric;
#endif

void main()
{
#ifdef HRT_HOLES
  // The side that the shadowed surface sees, as for shadow rays.
  if (isHole(triangle, barycentric, !gl_FrontFacing))
  {
    discard;
  }
#endif
}
