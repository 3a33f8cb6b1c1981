// The kd-tree's build: the same tree as the naive builder makes, whatever the mesh and the threads; what
// it promises about its cells; how it is watched and called off.
#include "KdTreeScenes.h"
#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Structures/KdTreeCost.h"
#include "Rendering/Core/Structures/KdTreeEvents.h"
#include "Rendering/Core/Structures/KdTreeTraversal.h"
#include "Testing/Cxx/Reference/NaiveKdTree.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <sstream>
#include <thread>

namespace
{

using namespace hrt;
using scenes::Random;

using Triangles = std::vector<std::uint32_t>;

Triangles sortedList(const KdNode& leaf, const std::vector<std::uint32_t>& references)
{
  Triangles list(references.begin() + leaf.first(),
    references.begin() + leaf.first() + leaf.count());
  std::sort(list.begin(), list.end());
  return list;
}

// Counts the nodes that differ; both trees are walked together, for their numbers may differ.
int differences(const KdTree& tree, std::size_t node, const reference::NaiveKdTree& naive,
  std::size_t naiveNode)
{
  const KdNode &a = tree.nodes()[node], &b = naive.nodes[naiveNode];
  if (a.isLeaf() || b.isLeaf())
  {
    return a.isLeaf() == b.isLeaf() &&
        sortedList(a, tree.references()) == sortedList(b, naive.references)
      ? 0
      : 1;
  }
  if (a.axis() != b.axis() || a.split() != b.split())
  {
    return 1;
  }
  return differences(tree, a.children(), naive, b.children()) +
    differences(tree, a.children() + 1, naive, b.children() + 1);
}

TEST(KdTreeBuild, SplitForSplitAsTheNaiveBuilder)
{
  for (int size : { 12, 300, 5000 })
  {
    for (const auto& [name, mesh] : scenes::hardMeshes(size))
    {
      SCOPED_TRACE(name);
      const auto tree = KdTree::build(*mesh);
      const reference::NaiveKdTree naive = reference::naiveKdTree(*mesh);
      EXPECT_EQ(differences(*tree, 0, naive, 0), 0);
      EXPECT_EQ(tree->references().size(), naive.references.size());
    }
  }
}

// Among ordinary coordinates some of random bits: cells may be as thin as 10^-63 of their length. Beside
// the rest of a split's cost that of a side without area vanishes in rounding, and must not hide how
// many triangles lie on it.
TEST(KdTreeBuild, SidesWithoutAreaCountTheirTriangles)
{
  scenes::Random random(83);
  const auto coordinate = [&random] {
    float value = static_cast<float>(random(-1.0, 1.0));
    if (random.below(32) == 0)
    {
      do
      {
        const auto bits = static_cast<std::uint32_t>(random(0.0, 0x1p32));
        std::memcpy(&value, &bits, sizeof(value));
      } while (!isAdmissible(glm::vec3(value)));
    }
    return value;
  };
  for (int i = 0; i < 2000; ++i)
  {
    std::vector<glm::vec3> points(3 + random.below(100)), positions;
    for (glm::vec3& point : points)
    {
      point = { coordinate(), coordinate(), coordinate() };
    }
    for (std::size_t k = 3 * (1 + random.below(250)); k > 0; --k)
    {
      positions.push_back(points[random.below(points.size())]);
    }
    const auto mesh = scenes::makeGeometry(positions);
    const auto tree = KdTree::build(*mesh);
    const reference::NaiveKdTree naive = reference::naiveKdTree(*mesh);
    ASSERT_EQ(differences(*tree, 0, naive, 0), 0) << i;
    ASSERT_EQ(tree->references().size(), naive.references.size()) << i;
  }
}

TEST(KdTreeBuild, EventsSortAsTheirPositions)
{
  Random random(31);
  for (const float big : { 1e-40f, 1.0f, 1e30f })
  {
    // Enough for the radix sort; multiples of a quarter, so that many are equal.
    std::vector<KdEvent> events(6000), scratch(6000);
    KdEventList list{ events.data(), 0 };
    for (std::uint32_t i = 0; i < 3000; ++i)
    {
      const float lower = big * (float(random.below(64)) / 4.0f - 8.0f) + 0.0f;
      list.add(lower, lower + big * float(random.below(3)), i);
    }
    Triangles count(3000, 0);
    sortEvents(list, scratch.data());
    for (std::uint32_t i = 0; i < list.count; ++i)
    {
      ++count[triangleOf(list.events[i])];
      if (i > 0)
      {
        const KdEvent before = list.events[i - 1], now = list.events[i];
        EXPECT_LT(before, now);
        EXPECT_LE(positionOf(before), positionOf(now));
      }
    }
    EXPECT_EQ(std::count(count.begin(), count.end(), 0u), 0);
  }
}

// --- What the tree promises -------------------------------------------------------------------------

// Whether some leaf whose cell, grown by the padding, holds the point lists the triangle.
bool listedAt(const KdTree& tree, std::size_t index, const glm::dvec3& point, std::uint32_t triangle)
{
  const KdNode& node = tree.nodes()[index];
  if (node.isLeaf())
  {
    const Triangles list = sortedList(node, tree.references());
    return std::binary_search(list.begin(), list.end(), triangle);
  }
  const double x = point[static_cast<int>(node.axis())];
  return (x <= node.split() + tree.padding() &&
           listedAt(tree, node.children(), point, triangle)) ||
    (x >= node.split() - tree.padding() && listedAt(tree, node.children() + 1, point, triangle));
}

// The same of the groups that rays go through.
bool blockedAt(const KdTree& tree, std::size_t group, const glm::dvec3& point, std::uint32_t triangle)
{
  const KdCells& cells = tree.groups()[group];
  bool found = false;
  for (int lane = 0; lane < KdCells::kLanes && !found; ++lane)
  {
    const KdBox box = cells.box(lane);
    const double p = tree.padding();
    const bool inside = glm::all(glm::greaterThanEqual(point, glm::dvec3(box.lower) - p)) &&
      glm::all(glm::lessThanEqual(point, glm::dvec3(box.upper) + p));
    if (inside && !cells.isLeaf(lane))
    {
      found = blockedAt(tree, cells.child[lane], point, triangle);
    }
    for (std::uint32_t i = 0; inside && cells.isLeaf(lane) && i < cells.blocks[lane]; ++i)
    {
      const auto& numbers = tree.blocks()[cells.firstBlock(lane) + i].triangle;
      found = found || std::find(std::begin(numbers), std::end(numbers), triangle) != std::end(numbers);
    }
  }
  return found;
}

TEST(KdTreeBuild, EveryPointOfATriangleIsInALeafThatListsIt)
{
  Random random(32);
  for (const auto& [name, mesh] : scenes::hardMeshes(2000))
  {
    SCOPED_TRACE(name);
    const auto tree = KdTree::build(*mesh);
    int lost = 0;
    for (std::uint32_t i = 0; i < mesh->triangleCount(); ++i)
    {
      const auto p = mesh->cornerPositions(i);
      for (int sample = 0; sample < 8; ++sample)
      {
        double u = sample < 3 ? double(sample == 1) : random(0.0, 1.0);
        double v = sample < 3 ? double(sample == 2) : random(0.0, 1.0);
        if (u + v > 1.0)
        {
          u = 1.0 - u;
          v = 1.0 - v;
        }
        const glm::dvec3 a(p[0]), b(p[1]), c(p[2]);
        const glm::dvec3 point = (1.0 - u - v) * a + u * b + v * c;
        lost += !listedAt(*tree, 0, point, i);
        lost += !blockedAt(*tree, 0, point, i);
      }
    }
    EXPECT_EQ(lost, 0);
  }
}

TEST(KdTreeBuild, DepthIsLimited)
{
  EXPECT_EQ(kdcost::depthLimit(0), 48);
  EXPECT_EQ(kdcost::depthLimit(1), 48);
  EXPECT_EQ(kdcost::depthLimit(std::size_t(1) << 34), 52);
  EXPECT_EQ(kdcost::depthLimit(std::numeric_limits<std::size_t>::max()), 64);
  for (const auto& [name, mesh] : scenes::hardMeshes(3000))
  {
    SCOPED_TRACE(name);
    const KdTreeQuality quality = KdTree::build(*mesh)->quality();
    EXPECT_LE(quality.depth, quality.depthLimit);
  }
}

// Nothing can tell identical triangles apart: the tree must not try.
TEST(KdTreeBuild, IdenticalTrianglesStayTogether)
{
  const glm::vec3 tilted[3] = { { 0, 0, 0 }, { 1, 0, 0.5f }, { 0, 1, 0.25f } };
  for (int count : { 1000, 100000 })
  {
    const KdTreeQuality quality = KdTree::build(*scenes::repeated(tilted, count))->quality();
    EXPECT_LE(quality.innerNodes, 8u);
    EXPECT_LT(quality.references, 2u * static_cast<unsigned>(count));
  }
}

TEST(KdTreeBuild, QualityCountsWhatIsThere)
{
  // Two parallel squares, five times each, one at each end of their box: both become flat leaves.
  std::vector<glm::vec3> positions;
  for (int copy = 0; copy < 10; ++copy)
  {
    const float z = copy % 2 ? 8.0f : 0.0f;
    positions.insert(positions.end(),
      { { 0, 0, z }, { 1, 0, z }, { 1, 1, z }, { 0, 0, z }, { 1, 1, z }, { 0, 1, z } });
  }
  const auto tree = KdTree::build(*scenes::makeGeometry(positions));
  const KdTreeQuality q = tree->quality();
  EXPECT_EQ(q.triangles, 20u);
  EXPECT_EQ(q.leaves, q.innerNodes + 1);
  EXPECT_EQ(q.references, 20u);
  EXPECT_EQ(q.emptyLeaves, 1u);
  EXPECT_EQ(q.longestList, 10u);
  EXPECT_EQ(q.depth, 2);
  // Surfaces: the box 34, a flat leaf 2; a line meets the second node always, for it is the whole box.
  EXPECT_DOUBLE_EQ(q.expectedInnerVisits, 2.0);
  EXPECT_DOUBLE_EQ(q.expectedLeafVisits, 1.0 + 2.0 * 2.0 / 34.0);
  EXPECT_DOUBLE_EQ(q.expectedTriangleTests, 20.0 * 2.0 / 34.0);
  EXPECT_DOUBLE_EQ(q.cost,
    2.0 * kdcost::kStep + 2.0 * kdcost::testCost(10) * 2.0 / 34.0 + kdcost::testCost(0));
  // The empty cell between the leaves is in no group; ten triangles take two blocks.
  EXPECT_EQ(q.groups, 1u);
  EXPECT_EQ(q.blocks, 4u);
  EXPECT_DOUBLE_EQ(q.expectedSteps, 1.0);
  EXPECT_DOUBLE_EQ(q.expectedLeaves, 2.0 * 2.0 / 34.0);
  EXPECT_DOUBLE_EQ(q.expectedBlockTests, 4.0 * 2.0 / 34.0);
  std::ostringstream text;
  text << q;
  EXPECT_NE(text.str().find("20 triangles, 20 references, 2 inner nodes, 3 leaves"), std::string::npos)
    << text.str();
}

// Every triangle of the lists once, in the blocks of its leaf, bit by bit.
TEST(KdTreeBuild, BlocksHoldTheListedTriangles)
{
  for (const auto& [name, mesh] : scenes::hardMeshes(2000))
  {
    SCOPED_TRACE(name);
    const auto tree = KdTree::build(*mesh);
    Triangles listed = tree->references(), held;
    for (const TriangleBlock& block : tree->blocks())
    {
      // Unused lanes, at the end, repeat the last triangle.
      std::uint32_t before = ~0u;
      for (int lane = 0; lane < TriangleBlock::kLanes; ++lane)
      {
        const std::uint32_t number = block.triangle[lane];
        if (number != before)
        {
          held.push_back(number);
        }
        before = number;
        const auto p = mesh->cornerPositions(number);
        for (int k = 0; k < 9; ++k)
        {
          ASSERT_EQ(std::memcmp(&block.corner[k / 3][k % 3][lane], &p[k / 3][k % 3], 4), 0);
        }
      }
    }
    std::sort(listed.begin(), listed.end());
    std::sort(held.begin(), held.end());
    EXPECT_TRUE(listed == held);
  }
}

// Random lines through the box, each met with the probability that the report's expectations rest on.
TEST(KdTreeBuild, ExpectedVisitsAreWhatLinesTake)
{
  const auto mesh = scenes::bumpySphere(20000);
  const auto tree = KdTree::build(*mesh);
  const glm::dvec3 lower(tree->box().lower), upper(tree->box().upper);
  const double radius = 0.5 * glm::length(upper - lower);
  Random random(33);
  KdCounters counters;
  int lines = 0;
  for (int i = 0; i < 60000; ++i)
  {
    // A direction, and a place in the disc that it looks at through the box' middle.
    const glm::dvec3 direction = random.direction();
    glm::dvec3 across = glm::cross(direction, random.direction());
    across = std::sqrt(random(0.0, 1.0)) * radius * glm::normalize(across);
    const glm::dvec3 origin = 0.5 * (lower + upper) + across - 2.0 * radius * direction;
    KdRay ray;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (ray.enter(*tree, origin, direction, kInfinity, tree->padding()) == KdRay::Entry::Entered)
    {
      ++lines;
      ray.traverse(
        *tree, kInfinity, [](const TriangleBlock&, const SieveResult&) { return kInfinity; }, counters);
    }
  }
  ASSERT_GT(lines, 20000);
  const KdTreeQuality quality = tree->quality();
  const auto expectNear = [&](std::uint64_t counted, double expected) {
    EXPECT_NEAR(double(counted) / lines, expected, 0.02 * expected);
  };
  expectNear(counters.steps, quality.expectedSteps);
  expectNear(counters.leaves, quality.expectedLeaves);
  expectNear(counters.blockTests, quality.expectedBlockTests);
}

// --- Threads, progress, abort -----------------------------------------------------------------------

template <class T>
bool sameBytes(const HugePageVector<T>& a, const HugePageVector<T>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(KdTreeBuild, ThreadsDoNotShow)
{
  const auto mesh = scenes::bumpySphere(30000); // several tasks
  // More threads than cores, if need be.
  const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
  std::vector<std::unique_ptr<const KdTree>> trees;
  for (int threads : { 1, 2, 8 })
  {
    tbb::task_arena(threads).execute([&] { trees.push_back(KdTree::build(*mesh)); });
    const KdTreeQuality quality = trees.back()->quality();
    ASSERT_EQ(quality.innerNodes, trees.front()->quality().innerNodes);
    const KdNode* nodes = trees.back()->nodes();
    EXPECT_TRUE(std::equal(nodes, nodes + 2 + quality.innerNodes * 2, trees.front()->nodes()));
    EXPECT_TRUE(trees.back()->references() == trees.front()->references());
    EXPECT_TRUE(sameBytes(trees.back()->groups(), trees.front()->groups()));
    EXPECT_TRUE(sameBytes(trees.back()->blocks(), trees.front()->blocks()));
  }
}

TEST(KdTreeBuild, ProgressGrowsToOneOnTheCallersThread)
{
  const auto mesh = scenes::bumpySphere(30000);
  for (int threads : { 1, 4 })
  {
    std::vector<double> shares;
    bool elsewhere = false;
    const std::thread::id caller = std::this_thread::get_id();
    KdTreeBuildControl control;
    control.progress = [&](double share) {
      shares.push_back(share);
      elsewhere = elsewhere || std::this_thread::get_id() != caller;
    };
    tbb::task_arena(threads).execute([&] { EXPECT_TRUE(KdTree::build(*mesh, control)); });
    EXPECT_FALSE(elsewhere);
    EXPECT_TRUE(threads > 1 || shares.size() > 10);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1.0);
    EXPECT_EQ(std::count(shares.begin(), shares.end(), 1.0), 1);
  }
}

TEST(KdTreeBuild, AbortGivesNoTree)
{
  const auto mesh = scenes::bumpySphere(30000);
  std::atomic<bool> abort{ true };
  KdTreeBuildControl control;
  control.abort = &abort;
  EXPECT_FALSE(KdTree::build(*mesh, control));
  // In the middle.
  abort = false;
  int calls = 0;
  control.progress = [&](double) {
    ++calls;
    abort = true;
  };
  tbb::task_arena(1).execute([&] { EXPECT_FALSE(KdTree::build(*mesh, control)); });
  EXPECT_EQ(calls, 1);
  abort = false;
  control.progress = nullptr;
  EXPECT_TRUE(KdTree::build(*mesh, control));
}

} // namespace
