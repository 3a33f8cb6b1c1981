// Surface points and their light in blocks have the very bits that they have one by one, in the lanes of every
// instruction set that this processor has.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Tracing/ClipPlanes.h"
#include "Rendering/Core/Tracing/Lighting.h"
#include "Rendering/Core/Tracing/SurfaceBlock.h"
#include "Rendering/Core/Tracing/TileTracer.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace
{

using namespace hrt;

constexpr unsigned int kLanes = SurfaceBlock::kLanes;

class InLanes : public testing::TestWithParam<InstructionSet>
{
protected:
  void SetUp() override
  {
    if (GetParam() > bestInstructionSet())
    {
      GTEST_SKIP() << "not a processor that has them";
    }
  }
  const SurfaceKernels& kernels() const { return surfaceKernelsFor(GetParam()); }
};

// Also tells 0 from -0, and any not-a-number from a number.
template <class T>
testing::AssertionResult sameBits(const T& a, const T& b)
{
  if (std::memcmp(&a, &b, sizeof(T)) == 0)
  {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << testing::PrintToString(a) << " and "
                                     << testing::PrintToString(b);
}

void expectSame(const glm::dvec3& a, const glm::dvec3& b, const char* what)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_TRUE(sameBits(a[axis], b[axis])) << what << ", axis " << axis;
  }
}

void expectSame(const glm::vec3& a, const glm::vec3& b, const char* what)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_TRUE(sameBits(a[axis], b[axis])) << what << ", axis " << axis;
  }
}

void expectSame(const SurfacePoint& a, const SurfacePoint& b)
{
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.part, b.part);
  EXPECT_EQ(a.material, b.material);
  expectSame(a.position, b.position, "position");
  expectSame(a.geometricNormal, b.geometricNormal, "geometric normal");
  expectSame(a.normal, b.normal, "normal");
  expectSame(a.opticalNormal, b.opticalNormal, "optical normal");
  EXPECT_EQ(a.frontSide, b.frontSide);
  EXPECT_EQ(a.outside, b.outside);
  expectSame(a.colors.ambient, b.colors.ambient, "ambient");
  expectSame(a.colors.diffuse, b.colors.diffuse, "diffuse");
  expectSame(a.colors.specular, b.colors.specular, "specular");
  EXPECT_TRUE(sameBits(a.colors.power, b.colors.power));
  EXPECT_TRUE(sameBits(a.edgeShare, b.edgeShare));
  expectSame(a.textureColor, b.textureColor, "texture");
  expectSame(a.diffuseColor, b.diffuseColor, "tint");
  EXPECT_TRUE(sameBits(a.opacity, b.opacity));
  expectSame(a.start, b.start, "start");
  expectSame(a.arrival, b.arrival, "arrival");
  EXPECT_TRUE(sameBits(a.positionError, b.positionError));
  EXPECT_TRUE(sameBits(a.twinReach, b.twinReach));
}

Material shiny(float power)
{
  Material material;
  material.front.ambient = 0.25f;
  material.front.ambientColor = { 0.5f, 0.25f, 1.0f };
  material.front.diffuseColor = { 0.75f, 0.5f, 0.3f };
  material.front.specular = 0.6f;
  material.front.specularPower = power;
  material.back = material.front;
  material.back.diffuseColor = { 0.1f, 0.9f, 0.2f };
  return material;
}

// Everything that a lane may find: with and without normals, of vertices or triangles, or cancelling out;
// mirrored, stretched and sheared matrices; slivers; colours of all kinds; copies.
Snapshot manyParts(std::uint32_t seed)
{
  scenes::Random random(seed);
  Snapshot s;
  const auto soup = [&](double flatness)
  {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 60; ++i)
    {
      const glm::dvec3 centre = random.inBox(1.0), along = random.inBox(0.5);
      corners.emplace_back(centre);
      corners.emplace_back(centre + along);
      corners.emplace_back(centre + 0.5 * along + flatness * random.inBox(0.5));
    }
    return scenes::makeGeometry(corners);
  };
  const auto matrix = [&]
  {
    glm::dmat4 m = glm::rotate(glm::dmat4(1.0), random(0, 6), random.direction());
    m = glm::scale(m, { random(0.5, 2), random(-2, -0.5), random(0.5, 2) });
    m[1] += 0.3 * m[0];
    m[3] = glm::dvec4(random.inBox(2.0), 1.0);
    return m;
  };
  scenes::addPart(s, soup(1.0), matrix()).material = shiny(17.5f);
  scenes::addPart(s, soup(1e-5), matrix()).material = shiny(1.0f);

  auto smooth = scenes::sphere(12, 8);
  smooth->normals.values.front() = glm::vec3(0.0f);
  scenes::addPart(s, smooth, matrix()).material = shiny(100.0f);

  auto faceted = soup(1.0);
  faceted->normals.attachment = Attachment::Triangles;
  faceted->colors.attachment = Attachment::Vertices;
  for (std::size_t i = 0; i < faceted->triangleCount(); ++i)
  {
    faceted->normals.values.emplace_back(random.direction());
  }
  for (std::size_t i = 0; i < faceted->vertexCount(); ++i)
  {
    faceted->colors.values.emplace_back(glm::vec4(255.0 * random(0, 1), 255.0 * random(0, 1), 40, 200));
  }
  faceted->colorSource = ColorSource::Corner;
  scenes::addPart(s, faceted, matrix()).material = shiny(3.0f);

  auto looked = soup(1.0);
  for (std::size_t i = 0; i < looked->vertexCount(); ++i)
  {
    looked->coordinates.values.emplace_back(random(-0.2, 1.2), 0.5);
  }
  looked->lookup = { { 255, 0, 0, 255 }, { 0, 255, 0, 255 }, { 0, 0, 255, 128 } };
  looked->lookupWidth = 3;
  looked->lookupHeight = 1;
  looked->colorSource = ColorSource::Lookup;
  scenes::addPart(s, looked).material = shiny(3.0f);

  auto copies = std::make_shared<Copies>();
  copies->version = 1;
  for (int i = 0; i < 3; ++i)
  {
    const glm::dmat4 m = matrix();
    Copies::Rows rows;
    for (int row = 0; row < 3; ++row)
    {
      rows[std::size_t(row)] = glm::vec4(m[0][row], m[1][row], m[2][row], m[3][row]);
    }
    copies->rows.push_back(rows);
    copies->colors.emplace_back(40 * i, 100, 200, 255);
  }
  Part& copied = scenes::addPart(s, smooth);
  boundCopies(*copied.geometry, *copies);
  copied.copies = copies;
  s.triangleCount = copied.firstTriangle + static_cast<TriangleId>(copied.triangleCount());
  s.origin = { 0.3, -0.2, 0.1 };
  return s;
}

// Directions of any length and triangles of any part, met at u, v that are often on a border.
struct Query
{
  TriangleId triangle;
  glm::dvec3 direction;
  Hit hit;
};

Query randomQuery(const Snapshot& s, scenes::Random& random)
{
  Query q;
  q.triangle = static_cast<TriangleId>(random.below(s.triangleCount));
  q.direction = random.direction() * random(0.5, 2.0);
  double u = random(0, 1), v = random(0, 1);
  if (u + v > 1.0)
  {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const std::size_t kind = random.below(6);
  u = kind == 0 ? 0.0 : u;
  v = kind == 1 ? 0.0 : kind == 2 ? 1.0 - u : v;
  q.hit = { q.triangle, random(0.1, 9), u, v };
  return q;
}

TEST_P(InLanes, SurfacesAreThoseOfOnePoint)
{
  scenes::Random random(7);
  for (std::uint32_t seed = 0; seed < 20; ++seed)
  {
    const Snapshot s = manyParts(seed);
    const Surfaces surfaces(s);
    SurfaceBlock block(surfaces, this->kernels());
    for (int i = 0; i < 200; ++i)
    {
      const auto count = static_cast<unsigned int>(1 + random.below(kLanes));
      Query queries[kLanes];
      for (unsigned int lane = 0; lane < count; ++lane)
      {
        queries[lane] = randomQuery(s, random);
        block.set(lane, queries[lane].triangle);
        block.setHit(lane, queries[lane].hit);
        block.setDirection(lane, queries[lane].direction);
      }
      const auto all = (1u << count) - 1u;
      const auto bits = static_cast<unsigned int>(1 + random.below(all));
      const glm::dvec3 eye = random.inBox(9.0);
      block.evaluate(count, bits, i % 2 == 0 ? &eye : nullptr);
      for (unsigned int lane = 0; lane < count; ++lane)
      {
        if (((bits >> lane) & 1u) != 0)
        {
          const SurfacePoint one = surfaces.at(queries[lane].hit, queries[lane].direction);
          expectSame(block.point(lane), one);
          expectSame(SurfaceBlock::vectorOf(block.lanes().toViewer, lane),
            i % 2 == 0 ? glm::normalize(eye - one.position) : -queries[lane].direction, "viewer");
        }
      }
    }
    if (HasFailure())
    {
      return;
    }
  }
}

// Rays towards triangles, some of which they only graze or miss.
TEST_P(InLanes, RaysMeetTrianglesWhereOneRayDoes)
{
  scenes::Random random(8);
  unsigned int met = 0, missed = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed)
  {
    const Snapshot s = manyParts(seed);
    const Surfaces surfaces(s);
    SurfaceBlock block(surfaces, this->kernels());
    for (int i = 0; i < 200; ++i)
    {
      Ray rays[kLanes];
      Hit planes[kLanes], exact[kLanes];
      unsigned int meetPlane = 0, meetExactly = 0;
      for (unsigned int lane = 0; lane < kLanes; ++lane)
      {
        const Query q = randomQuery(s, random);
        Ray& ray = rays[lane];
        ray.origin = random.inBox(6.0);
        ray.direction = surfaces.positionOf(q.hit) - ray.origin +
          (lane % 2 == 0 ? 0.02 * random.direction() : glm::dvec3(0.0));
        if (lane % 3 == 0) // along an axis, from the middle of nowhere
        {
          ray.direction = glm::dvec3(0.0);
          ray.direction[int(random.below(3))] = random.below(2) == 0 ? 1.0 : -1.0;
        }
        block.set(lane, q.triangle);
        block.setDirection(lane, ray.direction);
        SurfaceBlock::setVector(block.lanes().origin, lane, ray.origin);
        meetPlane |= surfaces.primaryHit(q.triangle, ray, planes[lane]) ? 1u << lane : 0u;
        meetExactly |= surfaces.exactHit(
                         q.triangle, ShearedRay(ray.origin, ray.direction), ray.tMaximum, exact[lane])
          ? 1u << lane
          : 0u;
      }
      ASSERT_EQ(block.meet(kLanes, false), meetPlane);
      for (unsigned int lane = 0; lane < kLanes; ++lane)
      {
        if (((meetPlane >> lane) & 1u) != 0)
        {
          const Hit hit = block.hit(lane);
          EXPECT_TRUE(sameBits(hit.t, planes[lane].t) && sameBits(hit.u, planes[lane].u) &&
            sameBits(hit.v, planes[lane].v));
        }
      }
      ASSERT_EQ(block.meet(kLanes, true), meetExactly);
      for (unsigned int lane = 0; lane < kLanes; ++lane)
      {
        const bool meets = ((meetExactly >> lane) & 1u) != 0;
        ++(meets ? met : missed);
        if (meets)
        {
          const Hit hit = block.hit(lane);
          EXPECT_TRUE(sameBits(hit.t, exact[lane].t) && sameBits(hit.u, exact[lane].u) &&
            sameBits(hit.v, exact[lane].v));
        }
      }
    }
  }
  EXPECT_GT(met, 5000u);
  EXPECT_GT(missed, 5000u);
}

Camera parallelCamera(int width, int height)
{
  Camera camera = scenes::perspective({ 1, 2, 5 }, { 0.1, 0.2, 0.3 }, width, height);
  camera.viewToClip = glm::ortho(-2.0, 3.0, -1.0, 1.5, 0.5, 7.0);
  camera.parallel = true;
  return camera;
}

TEST_P(InLanes, PixelsHaveTheRaysOfOnePixel)
{
  const BvhStructure structure("");
  const TracerSettings settings;
  for (const auto& [width, height] : { std::pair<int, int>{ 1, 1 }, { 7, 5 }, { 801, 599 } })
  {
    for (const bool parallel : { false, true })
    {
      Snapshot s;
      s.origin = { 100.25, -3.5, 7 };
      s.camera = parallel ? parallelCamera(width, height)
                          : scenes::perspective({ 1, 2, 5 }, { 0.1, 0.2, 0.3 }, width, height);
      const TracedFrame frame(s, structure, settings);
      const ClipPlanes planes(s);
      SurfaceBlock block(frame.surfaces, this->kernels());
      SurfaceLanes& lanes = block.lanes();
      const auto pixels = static_cast<unsigned int>(width * height);
      for (unsigned int first = 0; first < pixels; first += 13 * kLanes)
      {
        const unsigned int count = std::min(kLanes, pixels - first);
        for (unsigned int lane = 0; lane < count; ++lane)
        {
          lanes.pixel[lane] = first + lane;
        }
        block.pixelRays(frame.pixelRays, count);
        Ray rays[kLanes];
        for (unsigned int lane = 0; lane < count; ++lane)
        {
          rays[lane] = frame.primaryRay(first + lane);
          expectSame(block.ray(lane).origin, rays[lane].origin, "origin");
          expectSame(block.ray(lane).direction, rays[lane].direction, "direction");
        }
        const unsigned int open = this->kernels().clip(planes.rows(), lanes);
        for (unsigned int lane = 0; lane < count; ++lane)
        {
          double begin = 0.0, end = 0.0;
          ASSERT_EQ(((open >> lane) & 1u) != 0, planes.between(rays[lane], begin, end));
          expectSame(
            block.ray(lane).origin, rays[lane].origin + begin * rays[lane].direction, "near plane");
          EXPECT_TRUE(sameBits(lanes.t[lane], end - begin));
        }
        for (unsigned int lane = 0; lane < kLanes; ++lane)
        {
          lanes.t[lane] = 0.25 * (lane + 1);
        }
        this->kernels().depths(planes.rows(), lanes);
        for (unsigned int lane = 0; lane < count; ++lane)
        {
          const Ray ray = block.ray(lane);
          EXPECT_TRUE(sameBits(lanes.t[lane],
            planes.depth(ray.origin + 0.25 * (lane + 1) * ray.direction)));
        }
      }
    }
  }
}

// What is added at once, and what waits behind which rays.
struct Lit
{
  std::vector<glm::vec3> sums = std::vector<glm::vec3>(kLanes, glm::vec3(0.125f));
  std::vector<PathSignature> signatures = std::vector<PathSignature>(kLanes, 0);
  ShadowQueue queue;
  RayCount rays;
};

void expectSame(const Lit& a, const Lit& b)
{
  for (unsigned int lane = 0; lane < kLanes; ++lane)
  {
    expectSame(a.sums[lane], b.sums[lane], "sum");
    EXPECT_EQ(a.signatures[lane], b.signatures[lane]);
    // The queues have the pixels' portions in other orders; each pixel's own are in one.
    std::size_t i = 0, k = 0;
    for (;; ++i, ++k)
    {
      const auto next = [lane](const ShadowQueue& queue, std::size_t& at)
      {
        while (at < queue.rays.size() && queue.pixels[at] != lane)
        {
          ++at;
        }
        return at < queue.rays.size();
      };
      const bool more = next(a.queue, i);
      ASSERT_EQ(more, next(b.queue, k));
      if (!more)
      {
        break;
      }
      const Ray &one = a.queue.rays[i], &other = b.queue.rays[k];
      expectSame(one.origin, other.origin, "origin");
      expectSame(one.direction, other.direction, "direction");
      EXPECT_TRUE(sameBits(one.tMaximum, other.tMaximum));
      EXPECT_TRUE(sameBits(one.twinEnd, other.twinEnd));
      EXPECT_EQ(one.originTriangle, other.originTriangle);
      expectSame(a.queue.portions[i], b.queue.portions[k], "portion");
      EXPECT_EQ(a.queue.lights[i], b.queue.lights[k]);
      EXPECT_EQ(a.queue.bounces[i], b.queue.bounces[k]);
    }
  }
  EXPECT_EQ(a.rays.asked, b.rays.asked);
  EXPECT_EQ(a.rays.answered, b.rays.answered);
  EXPECT_EQ(a.rays.traced, b.rays.traced);
}

std::vector<Light> randomLights(scenes::Random& random)
{
  std::vector<Light> lights(random.below(5));
  for (Light& light : lights)
  {
    light.kind = random.below(2) == 0 ? Light::Kind::Positional : Light::Kind::Directional;
    light.isHeadlight = random.below(3) == 0;
    light.castsShadows = random.below(4) != 0;
    light.position = random.inBox(6.0);
    light.direction = random.direction();
    light.color = glm::vec3(random.inBox(1.0)) + 1.0f;
    light.attenuation = { 1.0f, float(random(0, 0.2)), float(random(0, 0.2)) };
    light.coneAngle = random.below(2) == 0 ? 40.0f : 90.0f;
    light.exponent = float(random(0, 9));
  }
  return lights;
}

TEST_P(InLanes, LightIsThatOfOnePoint)
{
  scenes::Random random(9);
  std::size_t traced = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed)
  {
    Snapshot s = manyParts(seed);
    s.camera = scenes::perspective(random.inBox(3.0), random.inBox(1.0), 40, 30);
    s.lights = randomLights(random);
    s.singleHeadlight = s.lights.size() == 1 && random.below(2) == 0;
    TracerSettings settings;
    settings.shadows = seed % 5 != 0;
    settings.interleave = 1 + int(seed % 2); // with and without signatures
    BvhStructure structure("");
    structure.update(s);
    const Surfaces surfaces(s);
    const Lighting lighting(s, surfaces, structure, settings);
    SurfaceBlock block(surfaces, this->kernels());
    for (int i = 0; i < 60; ++i)
    {
      Lit together, alone;
      const Lighting::Target* targets[kLanes];
      std::vector<Lighting::Target> kept, ones;
      const bool highlights = random.below(4) == 0;
      for (unsigned int lane = 0; lane < kLanes; ++lane)
      {
        Query q = randomQuery(s, random);
        q.direction = glm::normalize(q.direction);
        block.set(lane, q.triangle);
        block.setHit(lane, q.hit);
        block.setDirection(lane, q.direction);
      }
      const auto bits = static_cast<unsigned int>(1 + random.below(255));
      block.evaluate(kLanes, bits, nullptr);
      kept.reserve(kLanes);
      for (unsigned int lane = 0; lane < kLanes; ++lane)
      {
        const glm::vec3 weight(random.inBox(1.0));
        kept.push_back({ lane, weight, together.sums[lane], together.signatures[lane], 2 });
        targets[lane] = &kept.back();
        if (((bits >> lane) & 1u) == 0)
        {
          continue;
        }
        const SurfacePoint point = block.point(lane);
        const Lighting::Target one{ lane, weight, alone.sums[lane], alone.signatures[lane], 2 };
        const glm::dvec3 viewer = -point.arrival;
        if (highlights)
        {
          lighting.highlights(point, viewer, one, alone.queue, alone.rays);
        }
        else
        {
          lighting.shade(point, viewer, one, alone.queue, alone.rays);
        }
      }
      if (highlights)
      {
        lighting.highlights(block, bits, targets, together.queue, together.rays);
      }
      else
      {
        lighting.shade(block, bits, targets, together.queue, together.rays);
      }
      expectSame(together, alone);
      traced += alone.queue.rays.size();
      if (HasFailure())
      {
        return;
      }
    }
  }
  EXPECT_GT(traced, 1000u);
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, InLanes,
  testing::Values(InstructionSet::Base, InstructionSet::Avx2, InstructionSet::Avx512));

// Against the C library in double precision: within the bound of Math/Power.h and one rounding to float.
TEST(Power, IsTheTruePowerRounded)
{
  scenes::Random random(10);
  for (int i = 0; i < 300000; ++i)
  {
    const auto x = static_cast<float>(i % 3 == 0 ? std::exp2(random(-100, 100)) : random(1e-5, 1.0));
    const auto y = static_cast<float>(i % 3 == 0 ? random(-1, 1) : random(0, 128));
    const double exact = std::pow(double(x), double(y));
    const double bound = exact * (scenes::kFloatRounding + 1e-10) + 0x1p-150;
    ASSERT_LE(std::abs(power(x, y) - exact), bound) << x << "^" << y;
  }
  EXPECT_EQ(power(0.0f, 5.0f), 0.0f);
  EXPECT_EQ(power(0.0f, 0.0f), 1.0f);
  EXPECT_EQ(power(1.0f, 77.0f), 1.0f);
  EXPECT_EQ(power(2.0f, 10.0f), 1024.0f);
  EXPECT_EQ(power(0.5f, 100.0f), 0x1p-100f);
  EXPECT_EQ(power(1e-5f, 128.0f), 0.0f);
  EXPECT_EQ(power(1e-5f, -128.0f), std::numeric_limits<float>::infinity());
}

} // namespace
