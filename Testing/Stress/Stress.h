// What every row of the stress suite needs: which ray structures there are, how much work to do, and
// how a row reports its figure. The rows are the classic failures of ray tracers, gathered from the
// regression tests of Embree, pbrt and Mitsuba and from their bug trackers; each has a number, a
// figure and a rule, and each runs over every structure.
#pragma once

#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Testing/Cxx/Core/Scenes.h"

#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace hrt
{
namespace stress
{

struct Engine
{
  const char* name;
  std::unique_ptr<Structure> (*make)();
};

template <class Kind>
std::unique_ptr<Structure> makeStructure()
{
  return std::make_unique<Kind>();
}

// One line a structure.
inline const Engine kEngines[] = {
  { "Embree", &makeStructure<BvhStructure> },
  { "KdTree", &makeStructure<KdTreeStructure> },
};

inline std::ostream& operator<<(std::ostream& out, const Engine& engine)
{
  return out << engine.name;
}

class EveryEngine : public ::testing::TestWithParam<Engine>
{
protected:
  std::unique_ptr<Structure> built(const Snapshot& snapshot) const
  {
    auto structure = GetParam().make();
    structure->update(snapshot);
    return structure;
  }
};

// Each file of the suite has one fixture of its own, derived from EveryEngine.
#define HRT_STRESS_EVERY_ENGINE(Fixture)                                                          \
  INSTANTIATE_TEST_SUITE_P(All, Fixture, ::testing::ValuesIn(kEngines),                           \
    [](const ::testing::TestParamInfo<Engine>& info) { return std::string(info.param.name); })

// Share of a row's full work: HRT_STRESS_INTENSITY, from 0 to 1. By default so little that the whole
// suite takes less than a minute on two cores.
constexpr double kDefaultIntensity = 0.01;
inline double intensity()
{
  const char* given = std::getenv("HRT_STRESS_INTENSITY");
  const double value = given ? std::atof(given) : kDefaultIntensity;
  return value > 0.0 ? std::min(value, 1.0) : kDefaultIntensity;
}

inline bool isFull()
{
  return intensity() >= 1.0;
}

// The work at the present intensity of a row whose full work is `full`.
inline std::size_t scaled(double full, double atLeast = 1.0)
{
  return static_cast<std::size_t>(std::max(atLeast, full * intensity()));
}

// The row's line in the report.
template <class... Arguments>
void report(int row, const std::string& name, const char* format, Arguments... arguments)
{
  std::printf("row %d %s: ", row, name.c_str());
  std::printf(format, arguments...);
  std::printf("\n");
  std::fflush(stdout);
}

// Sums work(random, count) over `total` trials in chunks, on all threads. A chunk's random numbers
// depend on its place only, so that every run on every machine makes the same trials.
constexpr std::size_t kChunk = 8192;
template <class Sum, class Work>
Sum overChunks(std::size_t total, std::uint32_t seed, Work work)
{
  const std::size_t chunks = (total + kChunk - 1) / kChunk;
  return tbb::parallel_reduce(
    tbb::blocked_range<std::size_t>(0, chunks, 1), Sum(),
    [&](const tbb::blocked_range<std::size_t>& range, Sum sum) {
      for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk)
      {
        // Odd multiplier: neighbouring chunks get seeds far apart, and no two the same.
        scenes::Random random(seed + static_cast<std::uint32_t>(chunk) * 2654435761u);
        sum += work(random, std::min(kChunk, total - chunk * kChunk));
      }
      return sum;
    },
    [](Sum a, const Sum& b) {
      a += b;
      return a;
    });
}

// Where Embree's own test and ours put things that must not depend on where they are.
inline const glm::dvec3 kFarAway(148376.0, 1234.0, -223423.0);

inline Ray rayTo(const glm::dvec3& origin, const glm::dvec3& target)
{
  Ray ray;
  ray.origin = origin;
  ray.direction = target - origin;
  return ray;
}

inline bool sameHit(const Hit& a, const Hit& b)
{
  return a.triangle == b.triangle &&
    (!a.valid() || (a.t == b.t && a.u == b.u && a.v == b.v));
}

} // namespace stress
} // namespace hrt
