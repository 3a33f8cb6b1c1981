//VTK::System::Dec
// Object intersection buffer, vertex stage: a triangle's number is its place in the vertex buffer,
// so no attribute, no gl_PrimitiveID (broken in several drivers) and no index order is involved.
in vec4 position;
uniform mat4 positionToClip;
flat out int triangle;
out vec2 barycentric;

void main()
{
  int corner = gl_VertexID % 3;
  triangle = gl_VertexID / 3;
  // (u, v) of the paper's direct rendering: u grows towards the second corner, v to the third.
  barycentric = vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
  gl_Position = positionToClip * position;
}
