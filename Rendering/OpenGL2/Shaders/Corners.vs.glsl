//VTK::System::Dec
// Vertex stage of triangles whose corners are known to the fragments: direct rendering, and parts whose
// textures have holes. A corner's (u, v) belong to the triangle, so no vertex can be shared: every
// corner is drawn by itself and looks its vertex up.
//HRT::Define
uniform usamplerBuffer indices; // the vertices of each triangle's corners
uniform samplerBuffer positions;
uniform mat4 positionToClip;
uniform int cornerToTriangle; // from its place to its number
flat out int triangle;
out vec2 barycentric;

//HRT::Copies

void main()
{
  int corner = gl_VertexID % 3;
  triangle = gl_VertexID / 3 + cornerToTriangle + trianglesBefore();
  // (u, v) of the paper's direct rendering: u grows towards the second corner, v to the third.
  barycentric = vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
  int vertex = int(texelFetch(indices, gl_VertexID).r);
  gl_Position = positionToClip * placed(texelFetch(positions, vertex));
}
