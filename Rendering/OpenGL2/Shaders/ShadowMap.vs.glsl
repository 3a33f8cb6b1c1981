//VTK::System::Dec
// Shadow map, vertex stage: the scene's own vertex buffer as seen from a light.
//HRT::Define
in vec4 position;
uniform mat4 positionToClip;
#ifdef HRT_COPIES
uniform samplerBuffer positions;
#endif

//HRT::Copies

void main()
{
  gl_Position = positionToClip * placed(position);
}
