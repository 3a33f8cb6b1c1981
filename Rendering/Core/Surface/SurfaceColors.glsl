// The colours of one triangle at a point of it. Compiled with Shading.glsl and Surface.glsl into the GPU
// ray caster and, through SurfaceColors.h, into the tracer.
//
// Whoever includes it provides, of the triangle at hand,
//   HRT_COLOR_SOURCE                one of the numbers below
//   HRT_TERMS(front)                the HrtTerms of its part's property, or of the backface property
//   HRT_CORNER_COLOR(k)             the vec4 of a corner, HRT_COLOR_ONE meaning 1
//   HRT_CORNER_COORDINATES(k)       the corner's vec2 in the look-up table of its part
//   HRT_LOOKUP(i), HRT_LOOKUP_SIZE  that table's vec4, HRT_COLOR_ONE meaning 1, and its ivec2
//   HRT_COPY_COLOR                  the vec4 of the copy that the triangle belongs to, likewise

// As hrt::ColorSource; and the colour of a copy, whatever its mesh has.
#define HRT_COLOR_OF_PROPERTY 0
#define HRT_COLOR_OF_CORNERS 1
#define HRT_COLOR_OF_LOOKUP 2
#define HRT_COLOR_OF_COPY 3

// Colour and opacity that scalars give the point.
HRT_FUNCTION vec4 hrtScalarColor(real u, real v)
{
  if (HRT_COLOR_SOURCE == HRT_COLOR_OF_COPY)
  {
    return HRT_COPY_COLOR / HRT_COLOR_ONE;
  }
  if (HRT_COLOR_SOURCE == HRT_COLOR_OF_CORNERS)
  {
    return hrtInterpolate4(HRT_CORNER_COLOR(0), HRT_CORNER_COLOR(1), HRT_CORNER_COLOR(2), u, v) /
      HRT_COLOR_ONE;
  }
  vec2 st = hrtInterpolate2(
    HRT_CORNER_COORDINATES(0), HRT_CORNER_COORDINATES(1), HRT_CORNER_COORDINATES(2), u, v);
  return HRT_LOOKUP(hrtLookupTexel(st, HRT_LOOKUP_SIZE.x, HRT_LOOKUP_SIZE.y)) / HRT_COLOR_ONE;
}

// The terms of the side that is seen.
HRT_FUNCTION HrtTerms hrtTermsAt(real u, real v, bool front)
{
  bool scalars = HRT_COLOR_SOURCE != HRT_COLOR_OF_PROPERTY;
  HrtTerms terms = HRT_TERMS(front || scalars);
  if (scalars)
  {
    terms = hrtWithScalarColor(terms, hrtScalarColor(u, v));
  }
  return terms;
}
