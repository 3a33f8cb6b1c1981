// Implements the reference renderer: see the header.
#include "Testing/Cxx/Reference/ReferenceRenderer.h"

#include "Rendering/Core/Shading/Shading.h"
#include "Testing/Cxx/Reference/TriangleSoup.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace reference
{

namespace
{

// The documented weight below which the product does not follow a ray.
constexpr double kLeastWeight = 1.0 / 512.0;

// Cosine below any direction's: the shared source's "no cone".
constexpr double kNoCone = -2.0;

// What one pixel learns besides its colour.
struct Notes
{
  glm::dvec3 omitted{ 0.0 };
  bool fragile = false;
};

// Where a ray stands in the recursion.
struct Step
{
  SoupRay ray;
  int bounces = 0;
  glm::dvec3 weight{ 1.0 };
  bool omitted = false; // some ray before it was too light to be traced by the product
};

struct Point
{
  const SoupTriangle* triangle = nullptr;
  const Part* part = nullptr;
  glm::dvec3 position, faceNormal, shadingNormal, opticalNormal; // normals on the viewer's side
  bool outside = true;
  shading64::HrtSurface colors;
  glm::dvec3 diffuseColor;
  double opacity = 1.0;
};

double largest(const glm::dvec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

glm::dvec3 mirrored(const glm::dvec3& direction, const glm::dvec3& normal)
{
  return direction - 2.0 * glm::dot(direction, normal) * normal;
}

// What glass does with a ray: Snell's law by angles' sines, Fresnel's shares by both polarisations.
struct Split
{
  bool passes = false;
  glm::dvec3 refracted{ 0.0 };
  double reflectance = 1.0;
};

Split splitAt(const glm::dvec3& direction, const glm::dvec3& normal, double from, double to)
{
  Split split;
  const double cosFrom = -glm::dot(direction, normal);
  const glm::dvec3 tangent = direction + cosFrom * normal; // length: sine of the angle
  const glm::dvec3 bent = tangent * (from / to);
  const double sinSquared = glm::dot(bent, bent);
  if (sinSquared >= 1.0)
  {
    return split;
  }
  const double cosTo = std::sqrt(1.0 - sinSquared);
  const double s = (from * cosFrom - to * cosTo) / (from * cosFrom + to * cosTo);
  const double p = (from * cosTo - to * cosFrom) / (from * cosTo + to * cosFrom);
  split.passes = true;
  split.refracted = bent - cosTo * normal;
  split.reflectance = 0.5 * (s * s + p * p);
  return split;
}

class Renderer
{
public:
  Renderer(const Snapshot& snapshot, const TracerSettings& settings)
    : Scene(snapshot)
    , Settings(settings)
    , Soup(snapshot)
    , Rays(snapshot.camera.worldRays(snapshot.origin))
    , ToClip(snapshot.camera.viewToClip * snapshot.camera.worldToView)
    , Viewer(glm::dvec3(glm::inverse(snapshot.camera.worldToView)[3]) - snapshot.origin)
  {
    this->ToClip[3] = this->ToClip * glm::dvec4(snapshot.origin, 1.0);
  }

  void drawPixel(int column, int row, Picture& picture) const
  {
    const Camera& camera = this->Scene.camera;
    const double x = (column + 0.5) / camera.width * 2.0 - 1.0;
    const double y = (row + 0.5) / camera.height * 2.0 - 1.0;
    SoupRay ray;
    ray.origin = this->Rays.origin(x, y);
    ray.direction = glm::normalize(this->Rays.direction(x, y));
    const Sighting seen = this->Soup.look(
      ray, [this](std::size_t p, bool front) { return this->shownToCamera(p, front); },
      [&](double t) { return this->clearanceOfClipPlanes(ray.origin + t * ray.direction); });

    const std::size_t pixel = std::size_t(row) * camera.width + column;
    picture.admissible[pixel] = seen.admissible;
    if (!seen.hit.triangle)
    {
      return;
    }
    picture.triangles[pixel] = seen.hit.triangle->id;
    Step step;
    step.ray = ray;
    Notes notes;
    const Point point = this->pointAt(seen.hit, ray.direction);
    const glm::dvec3 toViewer = glm::normalize(this->Viewer - point.position);
    picture.colors[pixel] = glm::dvec4(this->surface(point, toViewer, step, notes), 1.0);
    picture.omitted[pixel] = notes.omitted;
    picture.fragile[pixel] = notes.fragile ? 1 : 0;
  }

private:
  bool isGlass(const Material& m) const
  {
    return m.isGlass() && this->Settings.refractions && this->Settings.maximumDepth > 0;
  }

  bool isMirror(const Material& m) const
  {
    return m.isMirror() && this->Settings.reflections && this->Settings.maximumDepth > 0 &&
      !this->isGlass(m);
  }

  bool shownToCamera(std::size_t part, bool front) const
  {
    const Part& p = this->Scene.parts[part];
    return p.visibleToCamera && !(front ? p.material.cullFront : p.material.cullBack);
  }

  // Positive between the near and the far plane, relative to the clip volume's depth.
  double clearanceOfClipPlanes(const glm::dvec3& point) const
  {
    const glm::dvec4 clip = this->ToClip * glm::dvec4(point, 1.0);
    return 1.0 - std::abs(clip.z / clip.w);
  }

  glm::dvec4 scalarColor(const Geometry& g, std::size_t i, double u, double v) const;
  Point pointAt(const SoupHit& hit, const glm::dvec3& direction) const;

  glm::dvec3 follow(const Step& step, Notes& notes) const;
  glm::dvec3 surface(
    const Point& point, const glm::dvec3& toViewer, const Step& step, Notes& notes) const;
  glm::dvec3 glass(
    const Point& point, const glm::dvec3& toViewer, const Step& step, Notes& notes) const;
  glm::dvec3 bounce(const Point& point, const glm::dvec3& direction, const glm::dvec3& share,
    const Step& step, Notes& notes) const;
  glm::dvec3 lights(const Point& point, const shading64::HrtSurface& colors,
    const glm::dvec3& toViewer, Notes& notes) const;
  glm::dvec3 arriving(const Point& point, const Light& light, Notes& notes) const;
  glm::dvec3 mirrorDirection(const Point& point, const glm::dvec3& direction) const;
  glm::dvec3 background(const glm::dvec3& direction) const;

  const Snapshot& Scene;
  const TracerSettings& Settings;
  TriangleSoup Soup;
  CameraRays Rays;
  glm::dmat4 ToClip;
  glm::dvec3 Viewer;
};

glm::dvec4 Renderer::scalarColor(const Geometry& g, std::size_t i, double u, double v) const
{
  if (g.colorSource == ColorSource::Corner)
  {
    const auto c = g.cornersOf(g.colors, i);
    return shading64::hrtInterpolate4(
             glm::dvec4(c[0]), glm::dvec4(c[1]), glm::dvec4(c[2]), u, v) / 255.0;
  }
  const auto c = g.cornersOf(g.coordinates, i);
  const glm::dvec2 st = shading64::hrtInterpolate2(
    glm::dvec2(c[0]), glm::dvec2(c[1]), glm::dvec2(c[2]), u, v);
  const glm::u8vec4 texel = g.lookup[std::size_t(shading64::hrtLookupTexel(st, g.lookupWidth, g.lookupHeight))];
  return glm::dvec4(texel) / 255.0;
}

Point Renderer::pointAt(const SoupHit& hit, const glm::dvec3& direction) const
{
  Point point;
  const SoupTriangle& triangle = *hit.triangle;
  const Part& part = this->Scene.parts[triangle.part];
  const Geometry& g = *part.geometry;
  const std::size_t i = triangle.id - part.firstTriangle;
  point.triangle = &triangle;
  point.part = &part;
  point.position =
    shading64::hrtInterpolate3(triangle.a, triangle.b, triangle.c, hit.u, hit.v);

  const glm::dvec3 wound = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const bool front = !(glm::dot(wound, direction) > 0.0);
  const glm::dmat3 linear(part.localToWorld);
  point.outside = front == (glm::determinant(linear) > 0.0);
  point.faceNormal = glm::normalize(front ? wound : -wound);
  point.shadingNormal = point.opticalNormal = point.faceNormal;
  if (!g.normals.empty())
  {
    const auto n = g.cornersOf(g.normals, i);
    const glm::dvec3 smooth = glm::transpose(glm::inverse(linear)) *
      shading64::hrtInterpolate3(
        glm::dvec3(n[0]), glm::dvec3(n[1]), glm::dvec3(n[2]), hit.u, hit.v);
    if (glm::length(smooth) > 0.0)
    {
      point.shadingNormal = glm::normalize(front ? smooth : -smooth);
      point.opticalNormal = glm::normalize(point.outside ? smooth : -smooth);
    }
  }

  const bool scalars = g.colorSource != ColorSource::Property;
  const PhongTerms& terms = front || scalars ? part.material.front : part.material.back;
  const glm::dvec4 scalar = scalars ? this->scalarColor(g, i, hit.u, hit.v) : glm::dvec4(1.0);
  const glm::dvec3 ambient = scalars ? glm::dvec3(scalar) : glm::dvec3(terms.ambientColor);
  point.diffuseColor = scalars ? glm::dvec3(scalar) : glm::dvec3(terms.diffuseColor);
  point.opacity = double(terms.opacity) * scalar.a;
  point.colors = { ambient * double(terms.ambient), point.diffuseColor * double(terms.diffuse),
    glm::dvec3(terms.specularColor) * double(terms.specular), double(terms.specularPower) };
  return point;
}

// What a secondary ray brings home.
glm::dvec3 Renderer::follow(const Step& arriving, Notes& notes) const
{
  if (arriving.bounces > this->Settings.maximumDepth)
  {
    return glm::dvec3(0.0);
  }
  Step step = arriving;
  const bool tooLight = !step.omitted && largest(step.weight) < kLeastWeight;
  step.omitted = step.omitted || tooLight;
  const SoupHit hit = this->Soup.nearest(
    step.ray, [this](std::size_t p, bool) { return this->Scene.parts[p].visibleToRays; });
  notes.fragile = notes.fragile || !hit.safe;
  const glm::dvec3& direction = step.ray.direction;
  const glm::dvec3 radiance = hit.triangle
    ? this->surface(this->pointAt(hit, direction), -direction, step, notes)
    : this->background(direction);
  if (tooLight)
  {
    notes.omitted += step.weight * radiance;
  }
  return radiance;
}

glm::dvec3 Renderer::surface(
  const Point& point, const glm::dvec3& toViewer, const Step& step, Notes& notes) const
{
  const Material& material = point.part->material;
  if (this->isGlass(material))
  {
    return this->glass(point, toViewer, step, notes);
  }
  // VTK itself draws what is translucent, so that a surface seen directly is opaque.
  const double opacity = step.bounces == 0 ? 1.0 : point.opacity;
  const double mirror = this->isMirror(material) ? double(material.reflectance) : 0.0;
  glm::dvec3 own = material.lit && !this->Scene.lights.empty()
    ? point.colors.ambient + this->lights(point, point.colors, toViewer, notes)
    : shading64::hrtUnlit(point.colors);
  own *= opacity * (1.0 - mirror);
  if (mirror > 0.0)
  {
    own += this->bounce(point, this->mirrorDirection(point, step.ray.direction),
      glm::dvec3(mirror * opacity), step, notes);
  }
  if (opacity < 1.0)
  {
    Step next = step;
    next.ray.origin = point.position;
    next.ray.leaves = point.triangle->id;
    next.weight *= 1.0 - opacity;
    own += (1.0 - opacity) * this->follow(next, notes);
  }
  return own;
}

glm::dvec3 Renderer::glass(
  const Point& point, const glm::dvec3& toViewer, const Step& step, Notes& notes) const
{
  const Material& material = point.part->material;
  const glm::dvec3& direction = step.ray.direction;
  glm::dvec3 sum(0.0);
  if (material.lit)
  {
    shading64::HrtSurface highlights = point.colors;
    highlights.ambient = highlights.diffuse = glm::dvec3(0.0);
    sum += this->lights(point, highlights, toViewer, notes);
  }
  const double index = material.indexOfRefraction;
  const double from = point.outside ? 1.0 : index, to = point.outside ? index : 1.0;
  const bool turnedAway = !(glm::dot(point.opticalNormal, direction) < 0.0);
  Split split =
    splitAt(direction, turnedAway ? point.faceNormal : point.opticalNormal, from, to);
  if (split.passes && !(glm::dot(split.refracted, point.faceNormal) < 0.0))
  {
    split = splitAt(direction, point.faceNormal, from, to); // would not cross the face
  }
  const double reflected = this->Settings.reflections ? split.reflectance : 0.0;
  if (this->Settings.reflections)
  {
    sum += this->bounce(
      point, this->mirrorDirection(point, direction), glm::dvec3(reflected), step, notes);
  }
  if (split.passes)
  {
    sum += this->bounce(
      point, split.refracted, (1.0 - reflected) * point.diffuseColor, step, notes);
  }
  return sum;
}

glm::dvec3 Renderer::bounce(const Point& point, const glm::dvec3& direction,
  const glm::dvec3& share, const Step& step, Notes& notes) const
{
  Step next;
  next.ray.origin = point.position;
  next.ray.direction = direction;
  next.ray.leaves = point.triangle->id;
  next.bounces = step.bounces + 1;
  next.weight = step.weight * share;
  next.omitted = step.omitted;
  return share * this->follow(next, notes);
}

glm::dvec3 Renderer::mirrorDirection(const Point& point, const glm::dvec3& direction) const
{
  const bool turnedAway = !(glm::dot(point.opticalNormal, direction) < 0.0);
  const glm::dvec3 smooth =
    mirrored(direction, turnedAway ? point.faceNormal : point.opticalNormal);
  return glm::dot(smooth, point.faceNormal) > 0.0 ? smooth : mirrored(direction, point.faceNormal);
}

glm::dvec3 Renderer::lights(const Point& point, const shading64::HrtSurface& colors,
  const glm::dvec3& toViewer, Notes& notes) const
{
  glm::dvec3 sum(0.0);
  for (const Light& light : this->Scene.lights)
  {
    shading64::HrtLight l;
    l.position = light.position - this->Scene.origin;
    l.direction = glm::normalize(light.direction);
    l.color = glm::dvec3(light.color);
    l.attenuation = glm::dvec3(light.attenuation);
    l.cosCone = light.isSpot() ? std::cos(glm::radians(double(light.coneAngle))) : kNoCone;
    l.exponent = light.exponent;
    l.kind = this->Scene.singleHeadlight ? HRT_LIGHT_SINGLE_HEADLIGHT
      : light.kind == Light::Kind::Positional ? HRT_LIGHT_POSITIONAL
                                              : HRT_LIGHT_DIRECTIONAL;
    const glm::dvec3 portion =
      shading64::hrtShadeLight(colors, l, point.position, point.shadingNormal, toViewer);
    if (portion == glm::dvec3(0.0))
    {
      continue; // its shadow ray has nothing to hide
    }
    sum += this->Settings.shadows ? portion * this->arriving(point, light, notes) : portion;
  }
  return sum;
}

// The share of a light that nothing holds back on its way to a point.
glm::dvec3 Renderer::arriving(const Point& point, const Light& light, Notes& notes) const
{
  if (!light.castsShadows)
  {
    return glm::dvec3(1.0);
  }
  SoupRay ray;
  ray.origin = point.position;
  ray.leaves = point.triangle->id;
  if (light.kind == Light::Kind::Positional)
  {
    ray.direction = light.position - this->Scene.origin - point.position;
    ray.tMaximum = 1.0;
  }
  else
  {
    ray.direction = -light.direction;
    if (light.isHeadlight && !this->Scene.camera.parallel)
    {
      // Shines from the camera's plane on.
      ray.tMaximum = glm::dot(point.position - this->Rays.origin0, light.direction);
      if (!(ray.tMaximum > 0.0))
      {
        return glm::dvec3(1.0);
      }
    }
  }
  const double facing =
    glm::dot(point.faceNormal, ray.direction) / glm::length(ray.direction);
  notes.fragile = notes.fragile || std::abs(facing) < kSafeMargin;
  if (!(facing > 0.0))
  {
    return glm::dvec3(0.0); // in the shadow of its own surface
  }
  bool blocked = false;
  const bool safeBlock = this->Soup.forEachHit(
    ray, [this](std::size_t p, bool) { return this->Scene.parts[p].castsShadow; },
    [&](const SoupHit& hit) { blocked = blocked || hit.safe; });
  if (blocked)
  {
    return glm::dvec3(0.0); // one certain hit is enough, whatever the others are
  }
  notes.fragile = notes.fragile || !safeBlock;
  glm::dvec3 share(1.0);
  if (this->Settings.tintedShadows)
  {
    const bool safe = this->Soup.forEachHit(
      ray,
      [this](std::size_t p, bool) {
        const Part& part = this->Scene.parts[p];
        return part.visibleToRays && part.tintsShadow;
      },
      [&](const SoupHit& hit) {
        const Point veil = this->pointAt(hit, ray.direction);
        const double a = glm::clamp(veil.opacity, 0.0, 1.0);
        share *= (1.0 - a) * (1.0 - a + a * veil.diffuseColor);
      });
    notes.fragile = notes.fragile || !safe;
  }
  return share;
}

glm::dvec3 Renderer::background(const glm::dvec3& direction) const
{
  const Background& b = this->Scene.background;
  const double height = 0.5 + 0.5 * glm::dot(glm::normalize(direction), glm::dvec3(b.up));
  return glm::mix(
    glm::dvec3(b.bottom), glm::dvec3(b.top), glm::clamp(height, 0.0, 1.0));
}

} // namespace

Picture render(const Snapshot& snapshot, const TracerSettings& settings)
{
  Picture picture;
  picture.width = snapshot.camera.width;
  picture.height = snapshot.camera.height;
  const std::size_t pixels = std::size_t(picture.width) * picture.height;
  picture.colors.assign(pixels, glm::dvec4(0.0));
  picture.omitted.assign(pixels, glm::dvec3(0.0));
  picture.fragile.assign(pixels, 0);
  picture.triangles.assign(pixels, kNoTriangle);
  picture.admissible.resize(pixels);
  const Renderer renderer(snapshot, settings);
  tbb::parallel_for(0, picture.height, [&](int row) {
    for (int column = 0; column < picture.width; ++column)
    {
      renderer.drawPixel(column, row, picture);
    }
  });
  return picture;
}

} // namespace reference
} // namespace hrt
