// A part with copies is what as many parts are: to every structure, and to the surface at a hit.
#include "Scenes.h"

#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "Rendering/Core/Tracing/Surface.h"

#include <gtest/gtest.h>

namespace hrt
{
namespace
{

// A matrix of random rotation, unequal scale and place; every fourth is turned inside out.
Copies::Rows randomPlace(std::mt19937& random, int number)
{
  std::uniform_real_distribution<float> angle(0.0f, 6.0f), size(0.2f, 0.8f), place(-4.0f, 4.0f);
  glm::mat4 m = glm::translate(glm::mat4(1.0f), { place(random), place(random), place(random) });
  m = glm::rotate(m, angle(random), glm::normalize(glm::vec3(1.0f, 2.0f, angle(random))));
  m = glm::scale(m, { number % 4 == 0 ? -size(random) : size(random), size(random), size(random) });
  Copies::Rows rows;
  for (int row = 0; row < 3; ++row)
  {
    rows[std::size_t(row)] = { m[0][row], m[1][row], m[2][row], m[3][row] };
  }
  return rows;
}

struct Twins
{
  Snapshot copied, expanded;

  explicit Twins(int count, glm::dvec3 origin = glm::dvec3(0.0))
  {
    std::mt19937 random(7);
    const auto mesh = scenes::torus(16, 8, 1.0, 0.35);
    auto copies = std::make_shared<Copies>();
    copies->version = 1;
    copies->origin = origin;
    for (int i = 0; i < count; ++i)
    {
      copies->rows.push_back(randomPlace(random, i));
      copies->colors.emplace_back(i % 256, 255 - i % 256, 7, 255);
    }
    boundCopies(*mesh, *copies);
    const glm::dmat4 actor = glm::translate(
      glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0.0, 0.0, 1.0)), -origin);
    for (Snapshot* s : { &this->copied, &this->expanded })
    {
      scenes::addPart(*s, scenes::quad({ -6, -6, -5 }, { 6, -6, -5 }, { 6, 6, -5 }, { -6, 6, -5 }));
    }
    Part& all = scenes::addPart(this->copied, mesh, actor);
    all.copies = copies;
    this->copied.triangleCount = static_cast<TriangleId>(2 + all.triangleCount());
    for (int i = 0; i < count; ++i)
    {
      scenes::addPart(this->expanded, mesh, actor * copies->matrix(std::size_t(i)));
    }
  }
};

std::vector<Ray> randomRays(int count)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::vector<Ray> rays(static_cast<std::size_t>(count));
  for (Ray& ray : rays)
  {
    ray.origin = { place(random), place(random), 9.0 };
    ray.direction = glm::dvec3(place(random), place(random), -4.0) - ray.origin;
  }
  // Neighbours close together, for packets.
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    const Ray& first = rays[i / 16 * 16];
    rays[i].origin = first.origin + 0.002 * double(i % 16) * glm::dvec3(1.0, 0.5, 0.0);
    rays[i].direction = first.direction;
  }
  return rays;
}

template <class AStructure>
class CopiesIn : public ::testing::Test
{
};
using Structures = ::testing::Types<BvhStructure, KdTreeStructure>;
TYPED_TEST_SUITE(CopiesIn, Structures);

TYPED_TEST(CopiesIn, AreWhatAsManyPartsAre)
{
  for (const int count : { 1, 2, 60 })
  {
    for (const glm::dvec3 origin : { glm::dvec3(0.0), glm::dvec3(1e7, -3e6, 5.0) })
    {
      SCOPED_TRACE(count);
      const Twins twins(count, origin);
      TypeParam copied, expanded;
      copied.update(twins.copied);
      expanded.update(twins.expanded);
      const std::vector<Ray> rays = randomRays(4096);
      for (const RayOrder order : { RayOrder::Coherent, RayOrder::Incoherent })
      {
        std::vector<Hit> a(rays.size()), b(rays.size());
        std::vector<std::uint8_t> shadowA(rays.size()), shadowB(rays.size());
        copied.intersect(rays.data(), a.data(), rays.size(), order);
        expanded.intersect(rays.data(), b.data(), rays.size(), order);
        copied.occluded(rays.data(), shadowA.data(), rays.size(), order);
        expanded.occluded(rays.data(), shadowB.data(), rays.size(), order);
        std::size_t hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i)
        {
          ASSERT_EQ(a[i].triangle, b[i].triangle) << i;
          ASSERT_EQ(a[i].t, b[i].t) << i;
          ASSERT_EQ(a[i].u, b[i].u) << i;
          ASSERT_EQ(shadowA[i], shadowB[i]) << i;
          hits += a[i].valid() && a[i].triangle > 1 ? 1 : 0;
        }
        EXPECT_GT(hits, count == 60 ? 800u : 0u);
      }
    }
  }
}

TYPED_TEST(CopiesIn, FollowTheirPart)
{
  Twins twins(40);
  TypeParam copied;
  copied.update(twins.copied);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1.0, 0.0, 0.0));
  for (Snapshot* s : { &twins.copied, &twins.expanded })
  {
    for (std::size_t i = 1; i < s->parts.size(); ++i)
    {
      s->parts[i].localToWorld = turn * s->parts[i].localToWorld;
    }
  }
  TypeParam expanded;
  copied.update(twins.copied);
  expanded.update(twins.expanded);
  const Surfaces a(twins.copied), b(twins.expanded);
  for (const Ray& ray : randomRays(1024))
  {
    const Hit hit = copied.intersect(ray);
    EXPECT_EQ(hit.triangle, expanded.intersect(ray).triangle);
    if (hit.valid())
    {
      // The matrix of a copy is a product of three here and of two there: some roundings apart.
      EXPECT_NEAR(hit.t, expanded.intersect(ray).t, 1e-12);
    }
  }
}

TEST(Copies, HaveTheSurfaceOfTheirOwn)
{
  const Twins twins(30);
  const Surfaces a(twins.copied), b(twins.expanded);
  BvhStructure structure;
  structure.update(twins.copied);
  int met = 0;
  for (const Ray& ray : randomRays(2048))
  {
    const Hit hit = structure.intersect(ray);
    if (!hit.valid() || hit.triangle < 2)
    {
      continue;
    }
    ++met;
    const SurfacePoint p = a.at(hit, ray.direction), q = b.at(hit, ray.direction);
    EXPECT_EQ(p.part, 1u);
    EXPECT_EQ(p.position, q.position);
    EXPECT_EQ(p.geometricNormal, q.geometricNormal);
    EXPECT_EQ(p.outside, q.outside);
    const std::size_t copy = twins.copied.parts[1].copyOf(hit.triangle);
    EXPECT_EQ(q.part, copy + 1);
    EXPECT_FLOAT_EQ(p.diffuseColor.x, float(copy % 256) / 255.0f);
  }
  EXPECT_GT(met, 200);
}

TEST(Copies, BoundsAreThoseOfAllCopies)
{
  const Twins twins(50);
  glm::dvec3 lower, upper, from(1e9), to(-1e9);
  worldBounds(twins.copied.parts[1], lower, upper);
  for (std::size_t i = 1; i < twins.expanded.parts.size(); ++i)
  {
    glm::dvec3 l, u;
    worldBounds(twins.expanded.parts[i], l, u);
    from = glm::min(from, l);
    to = glm::max(to, u);
  }
  // The box around boxes that the part's matrix turns: no smaller than what it holds.
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_LE(lower[k], from[k] + 1e-12);
    EXPECT_GE(upper[k], to[k] - 1e-12);
    EXPECT_LT(upper[k] - lower[k], 1.6 * (to[k] - from[k]));
  }
}

} // namespace
} // namespace hrt
