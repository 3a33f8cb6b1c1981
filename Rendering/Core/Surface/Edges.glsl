// The edges of cells on a surface, as VTK's polydata mapper draws them: not lines of their own but the
// part of the surface that lies within half a line's width of an edge in the window, in the edges'
// colour. In the common subset of GLSL 1.50 and C++.
//
// VTK's geometry shader widens each triangle by a quarter of the line's width so that the lines of a
// silhouette get some of their outer half. Widened triangles overlap along their common sides, and
// depth decides which one shows there: beside an edge the line of the nearer triangle is wider by that.
// The triangle that a pixel sees may thus be another than the one whose side it is on, and what is
// interpolated over it is stretched with it.
//
// Corners are given as (x, y, z, w), homogeneous in the window: (x, y) / w in pixels from the pixel's
// centre, z / w the depth, less is nearer.
//
// Whoever includes it provides
//   HRT_SIDES(triangle)            the ivec4 of a triangle: the triangles beyond its sides, -1 for none,
//                                  and a bit for each side that is an edge of its cell
//   HRT_WINDOW_CORNER(triangle, k) the vec4 of a corner

// Depths that differ by less are equal: a step of a depth buffer of 24 bits, from -1 to 1.
#define HRT_EQUAL_DEPTHS real(1.2e-7)

// A triangle as widened for lines of some width, at the pixel's centre.
struct HrtWidened
{
  vec3 distances; // from the sides' lines, in pixels; inside is positive
  vec3 nearest;   // see hrtNearestEdge
  vec2 uv;        // barycentrics in the widened triangle, of its second and third corner
  real depth;
  real turn;      // 1 where the corners go round counter-clockwise, -1 the other way
  bool covers;    // the widened triangle covers the centre
};

// What a pixel sees of a surface with edges.
struct HrtEdgeHit
{
  int triangle;
  vec2 uv;
  vec3 nearest; // edge, see hrtNearestEdge
  real depth;
  real turn;
};

// The line through two corners: its unit normal, to the left of the way from p to q, and the distance
// of the centre to that side.
HRT_FUNCTION vec3 hrtWindowLine(vec4 p, vec4 q)
{
  vec3 line = cross(vec3(p.x, p.y, p.w), vec3(q.x, q.y, q.w));
  return line / length(vec2(line.x, line.y));
}

HRT_FUNCTION real hrtTurn(vec4 a, vec4 b, vec4 c)
{
  return sign(dot(vec3(a.x, a.y, a.w), cross(vec3(b.x, b.y, b.w), vec3(c.x, c.y, c.w))));
}

// Of the lines of a triangle's sides, with normals inwards, the nearest one. A side that is no edge counts
// as one a line's width farther away.
HRT_FUNCTION vec3 hrtNearestEdge(vec3 first, vec3 second, vec3 third, int edges, real width)
{
  vec3 lines[3];
  lines[0] = first;
  lines[1] = second;
  lines[2] = third;
  for (int k = 0; k < 3; ++k)
  {
    lines[k].z += (edges & (1 << k)) != 0 ? real(0.0) : width;
  }
  vec3 nearest = lines[0].z <= lines[1].z ? lines[0] : lines[1];
  return nearest.z <= lines[2].z ? nearest : lines[2];
}

// The same of a triangle.
HRT_FUNCTION vec3 hrtNearestEdgeOf(vec4 a, vec4 b, vec4 c, int edges, real width)
{
  real turn = hrtTurn(a, b, c);
  return hrtNearestEdge(turn * hrtWindowLine(a, b), turn * hrtWindowLine(b, c),
    turn * hrtWindowLine(c, a), edges, width);
}

// The share of the edges' colour at that distance from the nearest edge.
HRT_FUNCTION real hrtEdgeMix(real distanceToEdge, real width)
{
  return clamp(real(0.5) + real(0.5) * width - distanceToEdge, real(0.0), real(1.0));
}

// The normal where edges are drawn as tubes: bent across the nearest edge, like a tube's that lies on
// it. `normal`: in coordinates whose x and y are the window's and whose z is towards the viewer. Not a
// unit vector: VTK mixes normals and lights with the mixture.
HRT_FUNCTION vec3 hrtTubeNormal(vec3 normal, vec3 nearest, real width, real share)
{
  vec3 inwards = vec3(nearest.x, nearest.y, real(0.0));
  vec3 across = normalize(cross(normal, cross(inwards, normal)));
  real place = real(2.0) * nearest.z / width;
  // A real tube hides a part of itself where the surface is seen at an angle.
  place = real(0.5) * place + real(0.5) * (place + across.z) / (real(1.0) + abs(across.z));
  real outwards = sqrt(max(real(1.0) - place * place, real(0.0)));
  return mix(normal, normalize(place * across + normal * outwards), share);
}

// VTK widens a triangle on all sides, but takes back what lies far beyond a side that is no edge.
HRT_FUNCTION bool hrtTakenBack(vec3 distances, int edges)
{
  return (distances.x < real(-0.5) && (edges & 1) == 0) ||
    (distances.y < real(-0.5) && (edges & 2) == 0) ||
    (distances.z < real(-0.5) && (edges & 4) == 0);
}

HRT_FUNCTION real hrtCross2(vec2 p, vec2 q)
{
  return p.x * q.y - p.y * q.x;
}

// All corners must lie before the viewer, w > 0.
HRT_FUNCTION HrtWidened hrtWiden(vec4 a, vec4 b, vec4 c, int edges, real width)
{
  HrtWidened wide;
  wide.turn = hrtTurn(a, b, c);
  vec3 ab = wide.turn * hrtWindowLine(a, b);
  vec3 bc = wide.turn * hrtWindowLine(b, c);
  vec3 ca = wide.turn * hrtWindowLine(c, a);
  wide.distances = vec3(ab.z, bc.z, ca.z);
  wide.nearest = hrtNearestEdge(ab, bc, ca, edges, width);

  // Each corner moves outwards between its sides' normals.
  real outwards = real(-0.25) * width;
  vec2 p = vec2(a.x, a.y) / a.w + outwards * normalize(vec2(ca.x + ab.x, ca.y + ab.y));
  vec2 q = vec2(b.x, b.y) / b.w + outwards * normalize(vec2(ab.x + bc.x, ab.y + bc.y));
  vec2 r = vec2(c.x, c.y) / c.w + outwards * normalize(vec2(bc.x + ca.x, bc.y + ca.y));
  vec3 share = vec3(hrtCross2(q, r), hrtCross2(r, p), hrtCross2(p, q)) / hrtCross2(q - p, r - p);
  wide.covers = share.x >= real(0.0) && share.y >= real(0.0) && share.z >= real(0.0);
  wide.depth = share.x * (a.z / a.w) + share.y * (b.z / b.w) + share.z * (c.z / c.w);
  vec3 inSpace = vec3(share.x / a.w, share.y / b.w, share.z / c.w);
  wide.uv = vec2(inSpace.y, inSpace.z) / (inSpace.x + inSpace.y + inSpace.z);
  return wide;
}

HRT_FUNCTION bool hrtBeforeViewer(vec4 a, vec4 b, vec4 c)
{
  return a.w > real(0.0) && b.w > real(0.0) && c.w > real(0.0);
}

HRT_FUNCTION HrtEdgeHit hrtShownHit(int triangle, HrtWidened wide)
{
  HrtEdgeHit hit;
  hit.triangle = triangle;
  hit.uv = hrtClampBarycentrics(wide.uv.x, wide.uv.y);
  hit.nearest = wide.nearest;
  hit.depth = wide.depth;
  hit.turn = wide.turn;
  return hit;
}

// The hit, or that of another triangle where it is drawn over it.
HRT_FUNCTION HrtEdgeHit hrtDrawnOver(HrtEdgeHit hit, int other, real width, bool culled)
{
  if (other < 0 || other == hit.triangle)
  {
    return hit;
  }
  vec4 a = HRT_WINDOW_CORNER(other, 0);
  vec4 b = HRT_WINDOW_CORNER(other, 1);
  vec4 c = HRT_WINDOW_CORNER(other, 2);
  if (!hrtBeforeViewer(a, b, c))
  {
    return hit;
  }
  int edges = HRT_SIDES(other).w;
  HrtWidened wide = hrtWiden(a, b, c, edges, width);
  if (!wide.covers || hrtTakenBack(wide.distances, edges) || (culled && wide.turn != hit.turn))
  {
    return hit;
  }
  // Of equal depths what is drawn last stays.
  bool nearer = wide.depth < hit.depth - HRT_EQUAL_DEPTHS ||
    (wide.depth <= hit.depth + HRT_EQUAL_DEPTHS && other > hit.triangle);
  return nearer ? hrtShownHit(other, wide) : hit;
}

// What VTK shows at a pixel whose centre lies on a triangle, at uv: that triangle or another one around
// it, whose widened area covers the centre too. `culled`: the surface shows one side only.
HRT_FUNCTION HrtEdgeHit hrtEdgeHit(int triangle, vec2 uv, real width, bool culled)
{
  vec4 a = HRT_WINDOW_CORNER(triangle, 0);
  vec4 b = HRT_WINDOW_CORNER(triangle, 1);
  vec4 c = HRT_WINDOW_CORNER(triangle, 2);
  ivec4 sides = HRT_SIDES(triangle);
  if (!hrtBeforeViewer(a, b, c))
  {
    HrtEdgeHit plain;
    plain.triangle = triangle;
    plain.uv = uv;
    plain.nearest = hrtNearestEdgeOf(a, b, c, sides.w, width);
    plain.depth = real(0.0);
    plain.turn = real(0.0);
    return plain;
  }
  HrtWidened own = hrtWiden(a, b, c, sides.w, width);
  HrtEdgeHit hit = hrtShownHit(triangle, own);
  // A corner moves by a quarter of the width, no side by more. Where two sides are as near as that, so is a
  // corner, and who lies beyond the neighbours may reach over it.
  vec3 near = vec3(lessThanEqual(own.distances, vec3(real(0.25) * width)));
  bool atCorner = near.x + near.y + near.z > real(1.5);
  for (int k = 0; k < 3; ++k)
  {
    int other = sides[k];
    if (other < 0 || near[k] == real(0.0))
    {
      continue; // nobody there, or he does not reach so far
    }
    hit = hrtDrawnOver(hit, other, width, culled);
    if (atCorner)
    {
      ivec4 beyond = HRT_SIDES(other);
      for (int m = 0; m < 3; ++m)
      {
        hit = beyond[m] == triangle ? hit : hrtDrawnOver(hit, beyond[m], width, culled);
      }
    }
  }
  return hit;
}
