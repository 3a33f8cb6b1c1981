// Rows 12 to 14: a structure that has been brought up to date a hundred times answers like one that was
// built this moment, and both like no structure at all.
#include "Testing/Cxx/Core/KdTreeScenes.h"
#include "Testing/Cxx/TracedImages.h"
#include "Testing/Stress/Stress.h"


#include <tbb/task_arena.h>
#include <tbb/parallel_for.h>

#include <cstring>

using namespace hrt;
using namespace hrt::stress;

namespace
{

class Dynamic : public EveryEngine
{
};

// Numbers the triangles anew after parts have come, gone or changed places.
void renumber(Snapshot& s)
{
  s.triangleCount = 0;
  for (Part& part : s.parts)
  {
    part.firstTriangle = s.triangleCount;
    s.triangleCount += static_cast<TriangleId>(part.geometry->triangleCount());
  }
}

glm::dmat4 placement(scenes::Random& random, double spread)
{
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), random.inBox(spread));
  const glm::dvec3 axis = random.direction();
  return glm::scale(glm::rotate(moved, random(0.0, 2.0 * scenes::kPi), axis),
    glm::dvec3(random(0.2, 1.0)));
}

std::shared_ptr<Geometry> anyMesh(scenes::Random& random)
{
  switch (random.below(4))
  {
    case 0:
      return scenes::sphere(8 + int(random.below(12)), 6);
    case 1:
      return scenes::torus(12, 6 + int(random.below(6)), 0.7, 0.25);
    case 2:
      return scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 });
    default:
    {
      std::vector<glm::vec3> positions(3 * (1 + random.below(40)));
      for (glm::vec3& p : positions)
      {
        p = glm::vec3(random.inBox(1.0));
      }
      return scenes::makeGeometry(std::move(positions));
    }
  }
}

// The kinds of change that a frame of an animation may bring, from none to all at once.
enum class Move
{
  Nothing,
  TranslateOne,
  TranslateAll,
  RotateSome,
  ScaleOne,
  MirrorOne,
  Deform,
  Replace,
  ShareGeometry,
  Add,
  Remove,
  Swap,
  HideFromRays,
  TakeShadow,
  MoveOrigin,
  EmptyAndRefill,
  Count
};

std::shared_ptr<Geometry> deformed(const Geometry& geometry, scenes::Random& random)
{
  std::vector<glm::vec3> positions = scenes::cornersOf(geometry);
  const glm::vec3 by(random.inBox(0.2));
  for (glm::vec3& p : positions)
  {
    p += by * p.x * p.y;
  }
  return scenes::makeGeometry(std::move(positions));
}

// One change; keys of new parts go on rising.
void change(Snapshot& s, Move move, scenes::Random& random)
{
  if (s.parts.empty())
  {
    scenes::addPart(s, anyMesh(random), placement(random, 3.0));
  }
  const auto any = [&]() -> Part& { return s.parts[random.below(s.parts.size())]; };
  switch (move)
  {
    case Move::TranslateOne:
      any().localToWorld[3] += glm::dvec4(random.inBox(0.5), 0.0);
      break;
    case Move::TranslateAll:
      for (Part& part : s.parts)
      {
        part.localToWorld[3] += glm::dvec4(random.inBox(0.1), 0.0);
      }
      break;
    case Move::RotateSome:
      for (Part& part : s.parts)
      {
        if (random.below(3) == 0)
        {
          part.localToWorld =
            glm::rotate(part.localToWorld, random(0.0, 1.0), random.direction());
        }
      }
      break;
    case Move::ScaleOne:
      any().localToWorld *= glm::scale(glm::dmat4(1.0), glm::dvec3(random(0.8, 1.25)));
      break;
    case Move::MirrorOne:
      any().localToWorld *= glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0));
      break;
    case Move::Deform:
    {
      Part& part = any();
      part.geometry = deformed(*part.geometry, random);
      break;
    }
    case Move::Replace:
      any().geometry = anyMesh(random);
      break;
    case Move::ShareGeometry:
      any().geometry = any().geometry;
      break;
    case Move::Add:
      scenes::addPart(s, anyMesh(random), placement(random, 3.0)).key = 1000000 + random.below(1u << 30);
      break;
    case Move::Remove:
      s.parts.erase(s.parts.begin() + std::ptrdiff_t(random.below(s.parts.size())));
      break;
    case Move::Swap:
      std::swap(any(), any());
      break;
    case Move::HideFromRays:
    {
      Part& part = any();
      part.visibleToRays = !part.visibleToRays;
      break;
    }
    case Move::TakeShadow:
    {
      Part& part = any();
      part.castsShadow = !part.castsShadow;
      break;
    }
    case Move::MoveOrigin:
      s.origin += random.inBox(5.0);
      break;
    case Move::EmptyAndRefill:
      for (Part& part : s.parts)
      {
        part.geometry = part.geometry->triangleCount() ? scenes::makeGeometry({}) : anyMesh(random);
      }
      break;
    case Move::Nothing:
    case Move::Count:
      break;
  }
  renumber(s);
}

Snapshot randomScene(scenes::Random& random, std::size_t parts)
{
  Snapshot s;
  for (std::size_t i = 0; i < parts; ++i)
  {
    scenes::addPart(s, anyMesh(random), placement(random, 3.0));
  }
  return s;
}

std::vector<Ray> rayFan(scenes::Random& random, const Snapshot& s, std::size_t count)
{
  std::vector<Ray> rays(count);
  for (Ray& ray : rays)
  {
    ray = rayTo(6.0 * random.direction() - s.origin, random.inBox(3.0) - s.origin);
  }
  return rays;
}

std::size_t differences(const Structure& a, const Structure& b, const std::vector<Ray>& rays)
{
  std::size_t different = 0;
  for (const Ray& ray : rays)
  {
    different += sameHit(a.intersect(ray), b.intersect(ray)) &&
        a.occluded(ray) == b.occluded(ray)
      ? 0
      : 1;
  }
  return different;
}

std::vector<glm::vec4> pictureOf(const Snapshot& s, const Structure& structure)
{
  PrimaryHits hits;
  castPrimaryRays(s, structure, {}, hits);
  SecondaryImage image;
  traceImage(s, structure, TracerSettings(), hits.ids.data(), image);
  return image.pixels;
}

bool sameBytes(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
  return a.size() == b.size() &&
    std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)) == 0;
}

void light(Snapshot& s)
{
  Light lamp;
  lamp.kind = Light::Kind::Positional;
  lamp.position = { 3, 6, 4 };
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(-1, -2, -1));
  sun.color = glm::vec3(0.5f);
  s.lights = { lamp, sun };
  s.camera = scenes::perspective({ 0, 1, 9 }, { 0, 0, 0 }, 80, 60);
}

} // namespace

// BART's robots: 190 parts that move in every frame.
TEST_P(Dynamic, Row12AnimationEqualsPicturesFromScratch)
{
  constexpr std::size_t kParts = 190;
  const std::size_t frames = scaled(800.0, 24.0);
  scenes::Random random(12);
  Snapshot s = randomScene(random, kParts);
  for (std::size_t i = 0; i < kParts; i += 7)
  {
    s.parts[i].material = scenes::mirror(0.5f, { 0.2f, 0.3f, 0.4f });
  }
  light(s);
  const auto updated = GetParam().make();
  std::size_t different = 0;
  for (std::size_t frame = 0; frame < frames; ++frame)
  {
    for (Part& part : s.parts)
    {
      part.localToWorld = glm::rotate(
        glm::translate(part.localToWorld, random.inBox(0.02)), 0.05, glm::dvec3(0, 1, 0));
    }
    updated->update(s);
    different += sameBytes(pictureOf(s, *updated), pictureOf(s, *built(s))) ? 0 : 1;
  }
  report(12, std::string("animation ") + GetParam().name,
    "%zu of %zu frames differ from the picture from scratch (0 allowed)", different, frames);
  EXPECT_EQ(different, 0u);
}

TEST_P(Dynamic, Row12EveryKindOfMove)
{
  const std::size_t rounds = scaled(200.0, 8.0);
  for (int move = 0; move < static_cast<int>(Move::Count); ++move)
  {
    scenes::Random random(1200 + static_cast<std::uint32_t>(move));
    Snapshot s = randomScene(random, 12);
    const auto updated = GetParam().make();
    updated->update(s);
    std::size_t different = 0, rays = 0;
    for (std::size_t round = 0; round < rounds; ++round)
    {
      change(s, static_cast<Move>(move), random);
      updated->update(s);
      // Embree's counts: 1 to 99 rays, so that bundles are full and not.
      const std::vector<Ray> fan = rayFan(random, s, 1 + random.below(99));
      rays += fan.size();
      different += differences(*updated, *built(s), fan);
    }
    report(12, "move " + std::to_string(move) + " " + GetParam().name,
      "%zu of %zu rays differ from a structure from scratch (0 allowed)", different, rays);
    EXPECT_EQ(different, 0u) << move;
  }
}

TEST_P(Dynamic, Row13RandomScenesFromOneAndTwoThreads)
{
  const std::size_t rounds = scaled(30.0, 4.0);
  constexpr std::size_t kScenes = 30, kRays = 200;
  std::size_t different = 0, rays = 0;
  for (std::size_t scene = 0; scene < kScenes; ++scene)
  {
    scenes::Random random(13 + static_cast<std::uint32_t>(scene));
    Snapshot s = randomScene(random, 1 + random.below(20));
    const auto structure = GetParam().make();
    scenes::BruteForce truth;
    for (std::size_t round = 0; round < rounds; ++round)
    {
      const int changes = static_cast<int>(random.below(4));
      for (int i = 0; i < changes; ++i)
      {
        change(s, static_cast<Move>(random.below(static_cast<std::size_t>(Move::Count))), random);
      }
      structure->update(s);
      truth.update(s);
      const std::vector<Ray> fan = rayFan(random, s, kRays);
      tbb::task_arena arena(1 + static_cast<int>(scene % 2));
      different += arena.execute([&] {
        return tbb::parallel_reduce(
          tbb::blocked_range<std::size_t>(0, fan.size(), 10), std::size_t(0),
          [&](const tbb::blocked_range<std::size_t>& range, std::size_t sum) {
            return sum +
              differences(*structure, truth,
                { fan.begin() + std::ptrdiff_t(range.begin()),
                  fan.begin() + std::ptrdiff_t(range.end()) });
          },
          std::plus<std::size_t>());
      });
      rays += fan.size();
    }
  }
  report(13, std::string("random scenes ") + GetParam().name,
    "%zu of %zu rays differ from brute force, 30 scenes of up to 3 moves a round, 1 and 2 threads "
    "(0 allowed)",
    different, rays);
  EXPECT_EQ(different, 0u);
}

// Mitsuba's stairs: the depth of every ray straight down is known.
TEST_P(Dynamic, Row14Stairs)
{
  constexpr int kSteps = 127;
  std::vector<glm::vec3> positions;
  const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    positions.insert(positions.end(), { a, b, c, a, c, d });
  };
  for (int i = 0; i < kSteps; ++i)
  {
    const auto x = static_cast<float>(i), h = static_cast<float>(i) / 4.0f;
    add({ x, 0, h }, { x + 1, 0, h }, { x + 1, 127, h }, { x, 127, h });
    add({ x + 1, 0, h }, { x + 1, 0, h + 0.25f }, { x + 1, 127, h + 0.25f }, { x + 1, 127, h });
  }
  Snapshot s;
  scenes::addPart(s, scenes::makeGeometry(positions));
  const auto structure = built(s);
  double worst = 0.0;
  std::size_t missed = 0;
  for (int i = 0; i < kSteps; ++i)
  {
    for (int j = 0; j < kSteps; ++j)
    {
      const glm::dvec3 from(i + 0.5, j + 0.3, 100.0);
      const Hit hit = structure->intersect(rayTo(from, from - glm::dvec3(0, 0, 1)));
      missed += hit.valid() ? 0 : 1;
      worst = std::max(worst, std::abs(hit.t - (100.0 - i / 4.0)));
    }
  }
  report(14, std::string("stairs ") + GetParam().name,
    "127 x 127 rays: %zu missed (0 allowed), depths within %.2g (1e-9 allowed)", missed, worst);
  EXPECT_EQ(missed, 0u);
  EXPECT_LE(worst, 1e-9);
}

// The bunny, or without the data a sphere with as many triangles and bumps all over, against every one
// of its triangles.
TEST_P(Dynamic, Row14MeshAgainstBruteForce)
{
  const auto bunny = scenes::bunny();
  const auto mesh = bunny ? bunny : scenes::bumpySphere(69451);
  const glm::dvec3 lower(mesh->boundsMin), upper(mesh->boundsMax);
  // About as large as the box that the rays aim at.
  const double scale = 6.0 / glm::length(upper - lower);
  Snapshot s;
  scenes::addPart(s, mesh,
    glm::translate(glm::scale(glm::dmat4(1.0), glm::dvec3(scale)), -0.5 * (lower + upper)));
  const auto structure = built(s);
  scenes::BruteForce truth;
  truth.update(s);
  const std::size_t rays = scaled(10000.0, 200.0);
  const std::size_t different =
    overChunks<std::size_t>(rays, 14, [&](scenes::Random& random, std::size_t count) {
      return differences(*structure, truth, rayFan(random, s, count));
    });
  report(14, std::string(bunny ? "bunny " : "bumpy sphere ") + GetParam().name,
    "%zu of %zu rays differ from brute force over %u triangles (0 allowed)", different, rays,
    s.triangleCount);
  EXPECT_EQ(different, 0u);
}

HRT_STRESS_EVERY_ENGINE(Dynamic);
