// A vertex stage's copies: the instances of a draw, each placed by its rows.
#ifdef HRT_COPIES
uniform int firstCopy;        // texel of the first one's rows
uniform int copyTexels;
uniform int trianglesOfCopy;
uniform int copiesBefore;     // of the part, drawn by the calls before

int copyNumber()
{
  return copiesBefore + gl_InstanceID;
}

vec4 placed(vec4 position)
{
  int at = firstCopy + copyNumber() * copyTexels;
  return vec4(dot(texelFetch(positions, at), position),
    dot(texelFetch(positions, at + 1), position), dot(texelFetch(positions, at + 2), position), 1.0);
}

int trianglesBefore()
{
  return copyNumber() * trianglesOfCopy;
}
#else
vec4 placed(vec4 position)
{
  return position;
}

int trianglesBefore()
{
  return 0;
}
#endif
