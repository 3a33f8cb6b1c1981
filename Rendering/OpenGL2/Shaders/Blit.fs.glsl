//VTK::System::Dec
//HRT::Define
// Puts the finished frame into the window: the primary image, with the radiance of mirrors and glass
// composited, and the hit's depth as true GL depth so that everything VTK draws afterwards (lines,
// translucent surfaces, volumes, text) is hidden where it should be.
uniform sampler2D primaryImage;
uniform sampler2D secondaryImage;
uniform sampler2D hitDepth;
uniform ivec2 viewportOrigin;
uniform int useSecondary;
uniform int reversedDepth;
out vec4 fragmentColor;

// From 0 near to 1 far.
float depthAt(ivec2 pixel)
{
  float stored = texelFetch(hitDepth, pixel, 0).r;
  return reversedDepth == 1 ? 1.0 - stored : stored;
}

#ifdef HRT_MARGIN
uniform vec2 perW; // the margin's numbers: DepthMargin.h
uniform float marginByW;
uniform float fixedMargin;
uniform float marginBySlope;
uniform float steepestChange;

// The depth's change to a neighbour on the same surface: the smaller one of two. Where both are on others,
// alone in its row, the pixel has none. At the picture's border both are the one there is.
float changeAlong(ivec2 pixel, ivec2 axis, float depth)
{
  ivec2 end = textureSize(hitDepth, 0) - 1;
  ivec2 before = pixel - axis, after = pixel + axis;
  before = before.x < 0 || before.y < 0 ? after : before;
  after = after.x > end.x || after.y > end.y ? before : after;
  before = clamp(before, ivec2(0), end);
  after = clamp(after, ivec2(0), end);
  float change = min(abs(depthAt(before) - depth), abs(depthAt(after) - depth));
  return change < steepestChange ? change : 0.0;
}

float depthForVTK(ivec2 pixel)
{
  float depth = depthAt(pixel);
  float inverseW = perW.x + perW.y * (2.0 * depth - 1.0);
  float slope = changeAlong(pixel, ivec2(1, 0), depth) + changeAlong(pixel, ivec2(0, 1), depth);
  return min(depth + marginByW * abs(inverseW) + fixedMargin + marginBySlope * slope, 1.0);
}
#else
float depthForVTK(ivec2 pixel)
{
  return depthAt(pixel);
}
#endif

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
