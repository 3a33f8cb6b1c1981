//VTK::System::Dec
// Shadow map, vertex stage: the scene's own vertex buffer as seen from a light.
in vec4 position;
uniform mat4 positionToClip;
//HRT::Holes

#ifdef HRT_HOLES
flat out int triangle;
out vec2 barycentric; // u grows towards the second corner, v to the third
#endif

void main()
{
#ifdef HRT_HOLES
  int corner = gl_VertexID % 3;
  triangle = gl_VertexID / 3;
  barycentric = vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
#endif
  gl_Position = positionToClip * position;
}
