// Rows 9 to 11: too many triangles in one place, too many parts, too many triangles altogether.
#include "Testing/Cxx/TracedImages.h"
#include "Testing/Stress/Stress.h"


#include <ctime>

using namespace hrt;
using namespace hrt::stress;

namespace
{

class Scale : public EveryEngine
{
};

std::vector<glm::vec3> stacked(std::size_t count)
{
  std::vector<glm::vec3> positions;
  for (std::size_t i = 0; i < count; ++i)
  {
    positions.insert(positions.end(), { { -1, -1, 0 }, { 1, -1, 0 }, { 0, 1, 0 } });
  }
  return positions;
}

Snapshot overlapping(std::size_t count)
{
  Snapshot s;
  scenes::addPart(s, scenes::makeGeometry(stacked(count)));
  return s;
}

// Processor seconds to build, of all threads; the best of a few.
double secondsToBuild(const Engine& engine, const Snapshot& snapshot)
{
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i)
  {
    const auto structure = engine.make();
    const std::clock_t start = std::clock();
    structure->update(snapshot);
    least = std::min(least, double(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

} // namespace

TEST_P(Scale, Row09TheLastOfManyEqualTriangles)
{
  for (const std::size_t count : { 1000u, 10000u, 100000u })
  {
    const Snapshot s = overlapping(count);
    const auto structure = built(s);
    const Ray ray = rayTo({ 0.1, -0.2, 3.0 }, { 0.1, -0.2, 0.0 });
    Ray leaving = ray;
    leaving.originTriangle = static_cast<TriangleId>(count - 1);
    EXPECT_EQ(structure->intersect(ray).triangle, count - 1) << count;
    EXPECT_EQ(structure->intersect(leaving).triangle, count - 2) << count;
    EXPECT_TRUE(structure->occluded(ray));
    EXPECT_FALSE(structure->intersect(rayTo({ 3, 0, 3 }, { 3, 0, 0 })).valid());
  }
  report(9, std::string("overlap ") + GetParam().name,
    "the largest number of 1,000, 10,000 and 100,000 equal triangles is hit (required)");
}

TEST_P(Scale, Row09BuildingThemIsNearlyLinear)
{
  constexpr std::size_t kFew = 10000, kMany = 100000;
  constexpr double kMostOverLinear = 2.0;
  const double few = secondsToBuild(GetParam(), overlapping(kFew));
  const double many = secondsToBuild(GetParam(), overlapping(kMany));
  const double ratio = (many / kMany) / (few / kFew);
  report(9, std::string("overlap's building ") + GetParam().name,
    "%.2f times the time a triangle at 100,000 as at 10,000 (2 allowed)", ratio);
  EXPECT_LT(ratio, kMostOverLinear);
}

TEST_P(Scale, Row10ManyTinyParts)
{
  const std::size_t side = static_cast<std::size_t>(std::sqrt(double(scaled(1e5, 4096.0))));
  Snapshot s;
  for (std::size_t i = 0; i < side * side; ++i)
  {
    const auto x = static_cast<float>(i % side), y = static_cast<float>(i / side);
    scenes::addPart(s,
      i % 1000 == 999 ? scenes::makeGeometry({})
                      : scenes::makeGeometry({ { x, y, 0 }, { x + 0.9f, y, 0 }, { x, y + 0.9f, 0 } }));
  }
  const auto structure = built(s);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < side * side; ++i)
  {
    const glm::dvec3 at(double(i % side) + 0.2, double(i / side) + 0.2, 0.0);
    const Hit hit = structure->intersect(rayTo(at + glm::dvec3(0, 0, 5), at));
    wrong += hit.triangle == (i % 1000 == 999 ? kNoTriangle : s.parts[i].firstTriangle) ? 0 : 1;
  }
  report(10, std::string("tiny parts ") + GetParam().name,
    "%zu of %zu parts of one triangle, or none, are missed or taken for others (0 allowed)", wrong,
    side * side);
  EXPECT_EQ(wrong, 0u);
}

TEST_P(Scale, Row10NothingToSee)
{
  Snapshot empty;
  Snapshot hollow; // parts without triangles
  scenes::addPart(hollow, scenes::makeGeometry({}));
  scenes::addPart(hollow, scenes::makeGeometry({}));
  Snapshot dark; // no light
  scenes::addPart(dark, scenes::sphere(8, 6));
  for (Snapshot* s : { &empty, &hollow, &dark })
  {
    const auto structure = built(*s);
    for (const glm::ivec2 size : { glm::ivec2(0, 0), { 0, 5 }, { 5, 0 }, { 1, 1 }, { 33, 7 } })
    {
      s->camera = scenes::perspective({ 0, 0, 5 }, { 0, 0, 0 }, 1, 1);
      s->camera.width = size.x;
      s->camera.height = size.y;
      const std::size_t pixels = std::size_t(size.x) * size.y;
      PrimaryHits hits;
      castPrimaryRays(*s, *structure, {}, hits);
      SecondaryImage image;
      traceImage(*s, *structure, TracerSettings(), hits.ids.data(), image);
      ASSERT_EQ(hits.ids.size(), pixels);
      ASSERT_EQ(image.pixels.size(), pixels);
      const auto seen = std::count_if(
        hits.ids.begin(), hits.ids.end(), [](std::uint32_t id) { return id != 0; });
      EXPECT_EQ(seen > 0, s == &dark && pixels > 0);
    }
  }
  report(10, std::string("nothing ") + GetParam().name,
    "empty scenes, hollow parts, no light and viewports without pixels are drawn (required)");
}

namespace
{

// Numbers that neither 24 bits of colour nor a float can tell apart begin here.
constexpr TriangleId kOldLimit = 1u << 24;

// A strip of `count` unit cells' lower triangles along x.
std::shared_ptr<Geometry> comb(std::size_t count, std::size_t rows)
{
  auto geometry = std::make_shared<Geometry>(*scenes::makeGeometry({}));
  geometry->version = scenes::makeGeometry({})->version;
  geometry->positions.reserve(3 * count);
  geometry->triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto x = static_cast<float>(i / rows), y = static_cast<float>(i % rows);
    geometry->positions.insert(
      geometry->positions.end(), { { x, y, 0 }, { x + 0.9f, y, 0 }, { x, y + 0.9f, 0 } });
    const auto first = static_cast<std::uint32_t>(3 * i);
    geometry->triangles.push_back({ first, first + 1, first + 2 });
    geometry->cellIds.push_back(static_cast<std::int64_t>(i));
  }
  return geometry;
}

// The triangle that a part's comb has over a cell.
std::size_t wrongIds(
  const Structure& structure, const Snapshot& s, std::size_t rows, std::size_t rays)
{
  scenes::Random random(11);
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < rays; ++k)
  {
    // The last ones, the first ones, and any.
    const TriangleId id = k < 10 ? static_cast<TriangleId>(k)
      : k < 20                   ? static_cast<TriangleId>(s.triangleCount - (k - 9))
                                 : static_cast<TriangleId>(random(0.0, s.triangleCount));
    const Part& part = s.parts[s.partOf(id)];
    const std::size_t i = id - part.firstTriangle;
    const glm::dvec3 local(double(i / rows) + 0.2, double(i % rows) + 0.2, 0.0);
    const glm::dvec3 at(part.localToWorld * glm::dvec4(local, 1.0));
    wrong += structure.intersect(rayTo(at + glm::dvec3(0, 0, 5), at)).triangle == id ? 0 : 1;
  }
  return wrong;
}

} // namespace

TEST_P(Scale, Row11NumbersBeyond24BitsOfManyParts)
{
  // One geometry in many places: its triangles are stored once and numbered each time.
  constexpr std::size_t kEach = 1u << 16, kRows = 256, kParts = 260, kRays = 2000;
  const auto geometry = comb(kEach, kRows);
  Snapshot s;
  for (std::size_t i = 0; i < kParts; ++i)
  {
    scenes::addPart(s, geometry,
      glm::translate(
        glm::dmat4(1.0), glm::dvec3(300.0 * double(i % 16), 300.0 * double(i / 16), 0.0)));
  }
  ASSERT_GT(s.triangleCount, kOldLimit);
  const std::size_t wrong = wrongIds(*built(s), s, kRows, kRays);
  report(11, std::string("ids over 2^24 in parts ") + GetParam().name,
    "%zu of %zu ids wrong, %u triangles (0 allowed)", wrong, kRays, s.triangleCount);
  EXPECT_EQ(wrong, 0u);
}

// Gigabytes and minutes: at full intensity all of the 17 million, else their thousandth part.
TEST_P(Scale, Row11SeventeenMillionTrianglesInOnePart)
{
  const std::size_t count = isFull() ? 17000000 : 17000;
  constexpr std::size_t kRows = 4096, kRays = 20000;
  Snapshot s;
  scenes::addPart(s, comb(count, kRows));
  ASSERT_EQ(s.triangleCount > kOldLimit, isFull());
  const std::size_t wrong = wrongIds(*built(s), s, kRows, kRays);
  report(11, std::string("triangles of one part ") + GetParam().name,
    "%zu of %zu ids wrong, %u triangles (0 allowed)", wrong, kRays, s.triangleCount);
  EXPECT_EQ(wrong, 0u);
}

HRT_STRESS_EVERY_ENGINE(Scale);
