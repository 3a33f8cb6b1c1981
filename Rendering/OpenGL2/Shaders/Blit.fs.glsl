//VTK::System::Dec
// Puts the finished frame into the window: the primary image, with the radiance of mirrors and glass
// composited, and the hit's depth as true GL depth so that everything VTK draws afterwards (lines,
// translucent surfaces, volumes, text) is hidden where it should be.
uniform sampler2D primaryImage;
uniform sampler2D secondaryImage;
uniform sampler2D hitDepth;
uniform ivec2 viewportOrigin;
uniform int useSecondary;
uniform int reversedDepth;
uniform vec2 perW; // the margin's numbers: DepthMargin.h
uniform float marginByW;
uniform float fixedMargin;
uniform float marginBySlope;
out vec4 fragmentColor;

// From 0 near to 1 far; 1 where there is no hit.
float depthAt(ivec2 pixel)
{
  float stored = texelFetch(hitDepth, pixel, 0).r;
  return reversedDepth == 1 ? 1.0 - stored : stored;
}

// The depth's change to a neighbour on the same surface: the smaller one of two. Alone in its row the
// pixel has none.
float changeAlong(ivec2 pixel, ivec2 axis, float depth)
{
  const float none = 2.0;
  float change = none;
  for (int side = -1; side <= 1; side += 2)
  {
    ivec2 next = pixel + side * axis;
    if (all(greaterThanEqual(next, ivec2(0))) && all(lessThan(next, textureSize(hitDepth, 0))))
    {
      float there = depthAt(next);
      change = there < 1.0 ? min(change, abs(there - depth)) : change;
    }
  }
  return change < none ? change : 0.0;
}

float depthForVTK(ivec2 pixel)
{
  float depth = depthAt(pixel);
  float inverseW = perW.x + perW.y * (2.0 * depth - 1.0);
  float slope = changeAlong(pixel, ivec2(1, 0), depth) + changeAlong(pixel, ivec2(0, 1), depth);
  return min(depth + marginByW * abs(inverseW) + fixedMargin + marginBySlope * slope, 1.0);
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy) - viewportOrigin;
  vec4 color = texelFetch(primaryImage, pixel, 0);
  if (color.a == 0.0)
  {
    discard;
  }
  if (useSecondary == 1)
  {
    vec4 secondary = texelFetch(secondaryImage, pixel, 0);
    color.rgb = color.rgb * secondary.a + secondary.rgb;
  }
  gl_FragDepth = depthForVTK(pixel);
  fragmentColor = color;
}
