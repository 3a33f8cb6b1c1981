//VTK::System::Dec
// Shadow map, vertex stage: the scene's own vertex buffer as seen from a light.
in vec4 position;
uniform mat4 positionToClip;

void main()
{
  gl_Position = positionToClip * position;
}
