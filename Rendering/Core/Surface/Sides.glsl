// A triangle's sides and normals as a ray sees them, in the common subset of GLSL 1.50 and C++; compiled
// with Shading.glsl, and like it for lanes too.
//
// Beside what Shading.glsl asks for, whoever includes it provides HRT_DIRECTION(v), the unit vector
// along a v that is not zero.

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
