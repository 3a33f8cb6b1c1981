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
out vec4 fragmentColor;

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
  float depth = texelFetch(hitDepth, pixel, 0).r;
  gl_FragDepth = reversedDepth == 1 ? 1.0 - depth : depth;
  fragmentColor = color;
}
