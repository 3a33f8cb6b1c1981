// By how much farther away a part is shown than it is, in stored depth, as VTK's polygon mapper does it.
uniform float offsetBySlope;
uniform float offsetConstant;

float offsetDepth()
{
  float slope = length(vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)));
  return clamp(gl_FragCoord.z + offsetBySlope * slope + offsetConstant, 0.0, 1.0);
}
