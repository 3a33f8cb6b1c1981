// Implements SurfaceKernels.h for the instruction set that the including file is compiled for, which names
// HRT_LANES_NAMESPACE and HRT_KERNEL_TABLE.
#include "Rendering/Core/Geometry/Rounding.h"
#include "Rendering/Core/Math/Lanes.h"
#include "Rendering/Core/Math/Power.h"
#include "Rendering/Core/Surface/SurfaceKernels.h"

#include <cstddef>

namespace hrt
{
namespace HRT_LANES_NAMESPACE
{

static_assert(kLanes == kSurfaceLanes, "a block is one value");

constexpr double kInfinity = __builtin_inf();

// The shared source in lanes.
#define HRT_FUNCTION HRT_INLINE
// Of a zero vector, which no lane asks for, it is zero and no exception.
#define HRT_DIRECTION(v) ((v) / max(length(v), real(__DBL_DENORM_MIN__)))
#define HRT_SELECT(condition, a, b) select(condition, a, b)
#define HRT_ANY(condition) any(condition)
namespace singles
{
using real = Floats;
using vec3 = VectorLanes<Floats>;
HRT_INLINE Floats pow(const Floats& x, const Floats& y)
{
  return toFloats(powerOf(toDoubles(x), toDoubles(y)));
}
#define HRT_BOOL Floats::Mask
#include "Rendering/Core/Shading/Shading.glsl"
#undef HRT_BOOL
}
namespace doubles
{
using real = Doubles;
using vec3 = VectorLanes<Doubles>;
struct vec2
{
  Doubles x, y;
  HRT_INLINE vec2(const Doubles& a, const Doubles& b)
    : x(a)
    , y(b)
  {
  }
};
#define HRT_BOOL Doubles::Mask
#include "Rendering/Core/Surface/Sides.glsl"
#undef HRT_BOOL
}

using doubles::vec3;
using Mask = Doubles::Mask;

// The matrix' number, of all lanes.
HRT_INLINE Doubles numberOf(const double* const (&matrix)[kLanes], bool same, std::size_t i)
{
  if (same)
  {
    return Doubles(matrix[0][i]);
  }
  alignas(64) double each[kLanes];
  for (int k = 0; k < kLanes; ++k)
  {
    each[k] = matrix[k][i];
  }
  return Doubles::load(each);
}

HRT_INLINE bool allSame(const double* const (&matrix)[kLanes])
{
  bool same = true;
  for (int k = 1; k < kLanes; ++k)
  {
    same = same && matrix[k] == matrix[0];
  }
  return same;
}

struct LaneCorners
{
  vec3 a, b, c;
};

// sceneCorners.
HRT_INLINE LaneCorners cornersOf(const SurfaceLanes& lanes)
{
  const bool same = allSame(lanes.toScene);
  Doubles m[12];
  for (std::size_t column = 0; column < 4; ++column)
  {
    for (std::size_t row = 0; row < 3; ++row)
    {
      m[3 * column + row] = numberOf(lanes.toScene, same, 4 * column + row);
    }
  }
  const auto place = [&](int k) HRT_INLINED
  {
    const vec3 p = toDoubles(VectorLanes<Floats>::load(lanes.corner[k]));
    return vec3{ m[0] * p.x + m[3] * p.y + m[6] * p.z + m[9],
      m[1] * p.x + m[4] * p.y + m[7] * p.z + m[10], m[2] * p.x + m[5] * p.y + m[8] * p.z + m[11] };
  };
  return { place(0), place(1), place(2) };
}

void pixelRays(const PixelRays& camera, SurfaceLanes& lanes)
{
  alignas(64) double numbers[kLanes];
  for (int i = 0; i < kLanes; ++i)
  {
    numbers[i] = lanes.pixel[i];
  }
  const Doubles pixel = Doubles::load(numbers), width(camera.width), half(0.5), one(1.0), two(2.0);
  // Of numbers below 2^32 the quotient's floor is exact.
  const Doubles row = floorOfCount(pixel / width), column = pixel - row * width;
  const Doubles x = (column + half) / width * two - one;
  const Doubles y = (row + half) / Doubles(camera.height) * two - one;
  const auto affine = [&](const double(&of)[3][3]) HRT_INLINED
  {
    return vec3::broadcast(of[0]) + x * vec3::broadcast(of[1]) + y * vec3::broadcast(of[2]);
  };
  affine(camera.origin).store(lanes.origin);
  normalize(affine(camera.direction)).store(lanes.direction);
}

// A row of the matrix times a vector, in GLM's order.
HRT_INLINE Doubles rowTimes(const double (&row)[4], const vec3& v, double last)
{
  return (Doubles(row[0]) * v.x + Doubles(row[1]) * v.y) +
    (Doubles(row[2]) * v.z + Doubles(row[3]) * Doubles(last));
}

unsigned int clip(const ClipRows& planes, SurfaceLanes& lanes)
{
  const vec3 origin = vec3::load(lanes.origin), direction = vec3::load(lanes.direction);
  const Doubles fromZ = rowTimes(planes.z, origin, 1.0), fromW = rowTimes(planes.w, origin, 1.0);
  const Doubles alongZ = rowTimes(planes.z, direction, 0.0),
                alongW = rowTimes(planes.w, direction, 0.0);
  const Doubles zero(0.0), one(1.0);
  Doubles first = zero, last(kInfinity);
  Mask open = !(zero < zero);
  const double sides[] = { 1.0, -1.0 };
  for (const double side : sides)
  {
    const Doubles start = fromW + Doubles(side) * fromZ, slope = alongW + Doubles(side) * alongZ;
    const Mask rises = slope > zero, falls = slope < zero, neither = !(rises | falls);
    const Doubles at = -start / select(neither, one, slope);
    first = select(rises, max(first, at), first);
    last = select(falls, min(last, at), last);
    open = open & !(neither & (start < zero));
  }
  open = open & (first < last);
  // What is left of no ray goes nowhere, whatever it is.
  first = select(open, first, zero);
  (origin + first * direction).store(lanes.origin);
  (last - first).store(lanes.t);
  return bitsOf(open);
}

void depths(const ClipRows& planes, SurfaceLanes& lanes)
{
  const vec3 position =
    vec3::load(lanes.origin) + Doubles::load(lanes.t) * vec3::load(lanes.direction);
  const Doubles depth = rowTimes(planes.z, position, 1.0) / rowTimes(planes.w, position, 1.0);
  clamp(depth, Doubles(-1.0), Doubles(1.0)).store(lanes.t);
}

HRT_INLINE Doubles differenceOfProducts(
  const Doubles& a, const Doubles& b, const Doubles& c, const Doubles& d)
{
  const Doubles product = c * d;
  return fused(a, b, -product) + fused(-c, d, product);
}

// Some of them zero counts for both sides.
HRT_INLINE Mask agree(const Doubles& a, const Doubles& b, const Doubles& c)
{
  const Doubles zero(0.0);
  return ((a >= zero) & (b >= zero) & (c >= zero)) | ((a <= zero) & (b <= zero) & (c <= zero));
}

// ShearedRay::hitsTriangle, or hitsPlane and what hitPrimary makes of it.
template <bool kExactly>
unsigned int meet(SurfaceLanes& lanes)
{
  const LaneCorners corners = cornersOf(lanes);
  const vec3 origin = vec3::load(lanes.origin), direction = vec3::load(lanes.direction);
  const vec3 size{ abs(direction.x), abs(direction.y), abs(direction.z) };
  const Mask alongX = (size.x >= size.y) & (size.x >= size.z);
  const Mask alongY = (!alongX) & (size.y >= size.z);
  const auto turned = [&](const vec3& v) HRT_INLINED
  {
    return vec3{ select(alongX, v.y, select(alongY, v.z, v.x)),
      select(alongX, v.z, select(alongY, v.x, v.y)),
      select(alongX, v.x, select(alongY, v.y, v.z)) };
  };
  const vec3 d = turned(direction);
  const Doubles zero(0.0), one(1.0);
  const Mask usable = abs(d.z) >= Doubles(__DBL_MIN__);
  const Doubles along = select(usable, d.z, one);
  const Doubles shearX = d.x / along, shearY = d.y / along, scale = one / along;
  const vec3 a = turned(corners.a - origin), b = turned(corners.b - origin),
             c = turned(corners.c - origin);
  const Doubles ax = a.x - shearX * a.z, ay = a.y - shearY * a.z;
  const Doubles bx = b.x - shearX * b.z, by = b.y - shearY * b.z;
  const Doubles cx = c.x - shearX * c.z, cy = c.y - shearY * c.z;
  const Doubles a0 = cx * by, a1 = cy * bx, b0 = ax * cy, b1 = ay * cx, c0 = bx * ay, c1 = by * ax;
  Doubles ofA = a0 - a1, ofB = b0 - b1, ofC = c0 - c1;
  const Mask maybe = agree(ofA, ofB, ofC);
  const Doubles products = abs(a0) + abs(a1) + abs(b0) + abs(b1) + abs(c0) + abs(c1);
  const Mask kept = abs(ofA + ofB + ofC) >= Doubles(kCancelled) * products;
  if (any(!kept))
  {
    ofA = select(kept, ofA, differenceOfProducts(cx, by, cy, bx));
    ofB = select(kept, ofB, differenceOfProducts(ax, cy, ay, cx));
    ofC = select(kept, ofC, differenceOfProducts(bx, ay, by, ax));
  }
  // Edge-on there is nothing to divide by, and where the exact test has failed nothing to divide for.
  Doubles determinant = ofA + ofB + ofC;
  Mask solved = usable & !(determinant == zero);
  if (kExactly)
  {
    solved = solved & maybe & agree(ofA, ofB, ofC);
  }
  determinant = select(solved, determinant, one);
  const Doubles t = scale * (ofA * a.z + ofB * b.z + ofC * c.z) / determinant;
  const Doubles u = ofB / determinant, v = ofC / determinant;
  const Doubles infinity(kInfinity);
  const Mask met = (abs(t) < infinity) & (abs(u) < infinity) & (abs(v) < infinity) &
    (t > zero) & solved;
  t.store(lanes.t);
  if (kExactly)
  {
    u.store(lanes.u);
    v.store(lanes.v);
    return bitsOf(met);
  }
  const doubles::vec2 inside = doubles::hrtClampBarycentrics(u, v);
  inside.x.store(lanes.u);
  inside.y.store(lanes.v);
  return bitsOf(met);
}

// Surfaces::evaluate, but for the colours.
void surface(SurfaceLanes& lanes)
{
  const LaneCorners corners = cornersOf(lanes);
  const Doubles u = Doubles::load(lanes.u), v = Doubles::load(lanes.v), one(1.0);
  const vec3 e1 = corners.b - corners.a, e2 = corners.c - corners.a;
  const vec3 position = corners.a + u * e1 + v * e2;
  position.store(lanes.position);
  position.store(lanes.start);

  const auto most = [&](const Doubles& a, const Doubles& b, const Doubles& c) HRT_INLINED
  {
    return max(abs(a), max(abs(b), abs(c)));
  };
  const Doubles x = most(corners.a.x, corners.b.x, corners.c.x),
                y = most(corners.a.y, corners.b.y, corners.c.y),
                z = most(corners.a.z, corners.b.z, corners.c.z);
  (Doubles(kComputedRounding) * max(max(x, y), z)).store(lanes.positionError);
  lanes.border = bitsOf(!(min(min(u, v), one - u - v) > Doubles(kSurelyInside)));

  const doubles::HrtSides sides =
    doubles::hrtSides(corners.a, corners.b, corners.c, vec3::load(lanes.direction));
  sides.geometricNormal.store(lanes.geometricNormal);
  lanes.front = bitsOf(sides.front);

  const auto normal = [&](int k) HRT_INLINED
  { return toDoubles(VectorLanes<Floats>::load(lanes.normal[k])); };
  const vec3 n = doubles::hrtInterpolate3(normal(0), normal(1), normal(2), u, v);
  const bool same = allSame(lanes.normalsToScene);
  Doubles m[9];
  for (std::size_t i = 0; i < 9; ++i)
  {
    m[i] = numberOf(lanes.normalsToScene, same, i);
  }
  const vec3 smooth{ m[0] * n.x + m[3] * n.y + m[6] * n.z, m[1] * n.x + m[4] * n.y + m[7] * n.z,
    m[2] * n.x + m[5] * n.y + m[8] * n.z };
  lanes.smooth = bitsOf(length(smooth) > Doubles(0.0));
  doubles::hrtSmoothNormal(smooth, sides.geometricNormal, sides.front).store(lanes.shadingNormal);

  const vec3 toViewer = lanes.seenFromEye ? normalize(vec3::broadcast(lanes.eye) - position)
                                          : -vec3::load(lanes.direction);
  toViewer.store(lanes.toViewer);
}

// From a point to a light that has a place.
HRT_INLINE vec3 towardsPlace(const LaneLight& light, const vec3& from)
{
  return vec3::broadcast(light.position) - from;
}

unsigned int shade(const LaneLight& light, SurfaceLanes& lanes)
{
  using Vector = singles::vec3;
  singles::HrtLight l;
  l.position = toFloats(towardsPlace(light, vec3::load(lanes.position)));
  l.direction = Vector::broadcast(light.direction);
  l.color = Vector::broadcast(light.color);
  l.attenuation = Vector::broadcast(light.attenuation);
  l.cosCone = Floats(light.cosCone);
  l.exponent = Floats(light.exponent);
  l.kind = light.kind;
  singles::HrtSurface surface;
  surface.ambient = Vector(Floats(0.0f)); // is no light's
  surface.diffuse = Vector::load(lanes.diffuse);
  surface.specular = Vector::load(lanes.specular);
  surface.power = Floats::load(lanes.power);
  const Vector portion = Vector::load(lanes.weight) *
    singles::hrtShadeLight(surface, l, Vector(Floats(0.0f)),
      toFloats(vec3::load(lanes.shadingNormal)), toFloats(vec3::load(lanes.toViewer)));
  portion.store(lanes.portion);
  const Floats zero(0.0f);
  return bitsOf(!((portion.x == zero) & (portion.y == zero) & (portion.z == zero)));
}

// Lighting::sight, of a light that casts shadows.
unsigned int shadowRays(const LaneLight& light, SurfaceLanes& lanes)
{
  const vec3 position = vec3::load(lanes.position), normal = vec3::load(lanes.geometricNormal);
  const vec3 toLight = light.positional ? towardsPlace(light, position)
                                        : -vec3::broadcast(light.directionOf);
  const Doubles along = dot(normal, toLight);
  // leave(), to the side that is seen.
  const vec3 origin = vec3::load(lanes.start) +
    Doubles::load(lanes.positionError) * (normal - vec3::load(lanes.direction));
  const Doubles turned(4.0), least(1e-200), most(double(__FLT_MAX__));
  toFloats(min(turned * Doubles::load(lanes.twinReach) / max(abs(along), least), most))
    .store(lanes.twinEnd);
  origin.store(lanes.shadowOrigin);
  (light.positional ? towardsPlace(light, origin) : toLight).store(lanes.shadowDirection);
  const Doubles end = light.positional ? Doubles(1.0)
    : light.fromEye ? dot(origin - vec3::broadcast(light.eye), vec3::broadcast(light.directionOf))
                    : Doubles(kInfinity);
  end.store(lanes.shadowEnd);
  return bitsOf(along > Doubles(0.0));
}

#undef HRT_FUNCTION
#undef HRT_DIRECTION
#undef HRT_SELECT
#undef HRT_ANY

} // namespace HRT_LANES_NAMESPACE

extern const SurfaceKernels HRT_KERNEL_TABLE;
const SurfaceKernels HRT_KERNEL_TABLE = { &HRT_LANES_NAMESPACE::pixelRays,
  &HRT_LANES_NAMESPACE::clip, &HRT_LANES_NAMESPACE::depths, &HRT_LANES_NAMESPACE::meet<false>,
  &HRT_LANES_NAMESPACE::meet<true>, &HRT_LANES_NAMESPACE::surface, &HRT_LANES_NAMESPACE::shade,
  &HRT_LANES_NAMESPACE::shadowRays };

} // namespace hrt
