//VTK::System::Dec
// Item buffer, vertex stage. The vertices are ordered so that the last corner of a part's i-th triangle
// is the part's i-th vertex; the last corner is the one whose flat outputs a triangle takes. So the
// triangle's number comes without gl_PrimitiveID (broken in several drivers), and vertices are shared.
//HRT::Define
in vec4 position;
uniform mat4 positionToClip;
uniform int vertexToTriangle; // from a last corner's number to its triangle's
#ifdef HRT_COPIES
uniform samplerBuffer positions;
#endif
flat out int triangle;

//HRT::Copies

void main()
{
  triangle = gl_VertexID + vertexToTriangle + trianglesBefore();
  gl_Position = positionToClip * placed(position);
}
