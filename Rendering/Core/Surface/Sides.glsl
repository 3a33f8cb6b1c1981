// A triangle where a ray meets it: barycentrics, sides and normals, in the common subset of GLSL 1.50 and C++;
// compiled with Shading.glsl, and like it for lanes too.
//
// Beside what Shading.glsl asks for, whoever includes it provides HRT_DIRECTION(v), the unit vector
// along a v that is not zero.

// Barycentric interpolation: u belongs to the second corner, v to the third, as in Moeller-Trumbore.
HRT_FUNCTION vec3 hrtInterpolate3(vec3 a, vec3 b, vec3 c, real u, real v)
{
  return a * (real(1.0) - u - v) + b * u + c * v;
}

// Moves barycentrics that fall outside the triangle (the rasteriser snaps vertices to a sub-pixel
// grid, so a pixel's centre may lie a hair outside the triangle it was given to) onto its border.
HRT_FUNCTION vec2 hrtClampBarycentrics(real u, real v)
{
  real cu = clamp(u, real(0.0), real(1.0));
  real cv = clamp(v, real(0.0), real(1.0));
  real excess = max(cu + cv - real(1.0), real(0.0));
  return vec2(max(cu - real(0.5) * excess, real(0.0)), max(cv - real(0.5) * excess, real(0.0)));
}

// A triangle as one ray sees it.
struct HrtSides
{
  vec3 geometricNormal; // unit, towards the viewer
  HRT_BOOL front;       // by the corners' winding, as gl_FrontFacing
};

HRT_FUNCTION HrtSides hrtSides(vec3 a, vec3 b, vec3 c, vec3 direction)
{
  vec3 wound = cross(b - a, c - a);
  HrtSides sides;
  sides.front = !(dot(wound, direction) > real(0.0));
  sides.geometricNormal = normalize(HRT_SELECT(sides.front, wound, -wound));
  return sides;
}

// The interpolated normal, of any length, as VTK turns it: with the side that is seen, whatever way it
// points. Where normals cancel out, the triangle's own.
HRT_FUNCTION vec3 hrtSmoothNormal(vec3 smoothNormal, vec3 geometricNormal, HRT_BOOL side)
{
  vec3 turned = HRT_SELECT(side, smoothNormal, -smoothNormal);
  return HRT_SELECT(length(smoothNormal) > real(0.0), HRT_DIRECTION(turned), geometricNormal);
}
