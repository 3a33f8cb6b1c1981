// Row 14 on BART's robots, the paper's third scene: hundreds of meshes placed 1,849 times, far smaller
// than the city they stand in, read and placed as an application would. Every ray that a tracer sends
// through it must get the same triangle and the same (t, u, v), to the bit, from every structure and
// from no structure at all. Skipped, not passed, where the data are absent.
#include "Testing/Cxx/Core/StructureChecks.h"
#include "Testing/Cxx/Scene/SceneTest.h"
#include "Testing/Stress/Stress.h"
#include "vtkHybridBARTImporter.h"

#include <algorithm>
#include <filesystem>

using namespace hrt;
using namespace hrt::stress;

namespace
{

std::string robotsFile()
{
  const char* chosen = std::getenv("HRT_DATA_ROOT");
  const std::string root = chosen && *chosen ? chosen : HRT_DEFAULT_DATA_ROOT;
  const std::string path = root + "/bart/robots/aff/Robot.aff";
  return std::filesystem::exists(path) ? path : std::string();
}

// The rays of a tracer by kind.
enum Kind
{
  Primary,
  Shadow,
  Mirror,
  Random,
  Kinds
};
const char* const kNames[Kinds] = { "camera", "shadow", "mirror", "random" };

constexpr double kCameraRays = 400.0 * 300.0;
constexpr double kBruteForceRays = 8000.0;

class Robots : public SceneTest
{
protected:
  // At the time 0, in the picture's own proportions.
  void read(const std::string& path)
  {
    vtkNew<vtkHybridBARTImporter> importer;
    importer->SetFileName(path.c_str());
    importer->TexturesOff(); // colours are not asked for here
    ASSERT_TRUE(importer->Read());
    ASSERT_EQ(importer->GetTime(), 0.0);
    this->window->SetSize(400, 300);
    importer->AddTo(this->renderer);
    const Snapshot& s = this->update();
    ASSERT_EQ(s.triangleCount + s.refusals.degenerateTriangles, 71708u);
    ASSERT_EQ(s.refusals.total(), s.refusals.degenerateTriangles + s.refusals.emptyParts);
    ASSERT_GT(s.parts.size(), 1800u);
    ASSERT_EQ(s.lights.size(), 1u);
    for (const Engine& engine : kEngines)
    {
      this->structures.push_back(engine.make());
      this->structures.back()->update(s);
    }
    this->truth.update(s);
  }

  // From the eye through points spread evenly over the picture; what is hit sends a ray to the light,
  // one from a mirror and one anywhere.
  void makeRays(std::size_t count)
  {
    const CameraRays view = this->snapshot->camera.worldRays(this->snapshot->origin);
    scenes::Random random(14);
    for (std::size_t i = 0; i < count; ++i)
    {
      const double x = random(-1.0, 1.0), y = random(-1.0, 1.0);
      Ray ray;
      ray.origin = view.origin(x, y);
      ray.direction = view.direction(x, y);
      this->rays[Primary].push_back(ray);
      const Hit hit = this->structures.front()->intersect(ray);
      if (hit.valid())
      {
        this->leave(ray, hit, random);
      }
    }
  }

  // The answers that differ between the structures, of each asked for one ray and for streams.
  int differences(Kind kind) const
  {
    return checks::wrongAnswers(*this->structures[0], *this->structures[1], this->rays[kind]) +
      checks::wrongAnswers(*this->structures[1], *this->structures[0], this->rays[kind]);
  }

  // The rays that any structure answers otherwise than a search of every triangle does; they are spread
  // over all of the kind.
  std::size_t differencesFromAll(Kind kind, std::size_t count) const
  {
    const std::vector<Ray>& all = this->rays[kind];
    return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 16), std::size_t(0),
      [&](const tbb::blocked_range<std::size_t>& range, std::size_t sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
        {
          const Ray& ray = all[i * all.size() / count];
          const Hit hit = this->truth.intersect(ray);
          const bool occluded = this->truth.occluded(ray);
          const bool same = std::all_of(this->structures.begin(), this->structures.end(),
            [&](const std::unique_ptr<Structure>& structure) {
              return checks::same(structure->intersect(ray), hit) &&
                structure->occluded(ray) == occluded;
            });
          sum += same ? 0 : 1;
        }
        return sum;
      },
      std::plus<std::size_t>());
  }

  std::vector<std::unique_ptr<Structure>> structures; // in the order of kEngines
  scenes::BruteForce truth;
  std::vector<Ray> rays[Kinds];

private:
  void leave(const Ray& arriving, const Hit& hit, scenes::Random& random)
  {
    const Corners c = checks::cornersOf(*this->snapshot, hit.triangle);
    Ray ray;
    ray.originTriangle = hit.triangle;
    ray.origin = c.a + hit.u * (c.b - c.a) + hit.v * (c.c - c.a);
    ray.direction = this->snapshot->lights[0].position - this->snapshot->origin - ray.origin;
    ray.tMaximum = 1.0;
    this->rays[Shadow].push_back(ray);
    ray.tMaximum = std::numeric_limits<double>::infinity();
    ray.direction =
      glm::reflect(arriving.direction, glm::normalize(glm::cross(c.b - c.a, c.c - c.a)));
    this->rays[Mirror].push_back(ray);
    ray.direction = random.direction();
    this->rays[Random].push_back(ray);
  }
};

} // namespace

TEST_F(Robots, Row14StructuresAndBruteForceAgree)
{
  const std::string path = robotsFile();
  if (path.empty())
  {
    GTEST_SKIP() << "scene data bart/robots/aff/Robot.aff is absent (see Data/README.md)";
  }
  ASSERT_NO_FATAL_FAILURE(this->read(path));
  ASSERT_EQ(std::size(kEngines), 2u) << "differences() compares two";
  this->makeRays(scaled(kCameraRays, 0.25 * kCameraRays));
  std::size_t total = 0, tried = 0, hits = 0;
  for (int k = 0; k < Kinds; ++k)
  {
    const auto kind = static_cast<Kind>(k);
    const std::size_t count = this->rays[kind].size();
    total += count;
    ASSERT_GT(count, this->rays[Primary].size() / 4) << kNames[kind];
    const int different = this->differences(kind);
    report(14, std::string("robots ") + kNames[kind],
      "%d of %zu rays differ between the structures (0 allowed)", different, count);
    EXPECT_EQ(different, 0) << kNames[kind];
    const std::size_t some = scaled(kBruteForceRays / Kinds, 50.0);
    tried += some;
    const std::size_t wrong = this->differencesFromAll(kind, some);
    report(14, std::string("robots ") + kNames[kind],
      "%zu of %zu rays differ from brute force over %u triangles of %zu parts (0 allowed)", wrong,
      some, this->snapshot->triangleCount, this->snapshot->parts.size());
    EXPECT_EQ(wrong, 0u) << kNames[kind];
    for (const Ray& ray : this->rays[kind])
    {
      hits += this->structures.front()->intersect(ray).valid() ? 1 : 0;
    }
  }
  report(14, "robots", "%zu rays in all, %zu of them hit, %zu tried against every triangle", total,
    hits, tried);
  EXPECT_GT(total, std::size_t(0.7 * kCameraRays));
  EXPECT_GT(hits, total / 2);
}
