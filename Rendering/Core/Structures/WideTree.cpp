// Implements the tree of boxes: Embree's generic builder, its result copied into nodes of our own.
#include "Rendering/Core/Structures/WideTree.h"

#include <algorithm>
#include <limits>
#include <new>

namespace hrt
{
namespace bvh
{

static_assert(sizeof(WideNode) == 256, "nodes are read by whole cache lines");

namespace
{

// What Embree's callbacks make, in Embree's own memory: a tree with two children to a node.
struct Made
{
  Made* child[2] = { nullptr, nullptr };
  float area[2] = { 0, 0 }; // of the children's boxes
  WideTree::Leaf leaf;      // if there are no children

  static Made* make(RTCThreadLocalAllocator allocator)
  {
    return new (rtcThreadLocalAlloc(allocator, sizeof(Made), alignof(Made))) Made;
  }
  static void* createNode(RTCThreadLocalAllocator allocator, unsigned int, void*)
  {
    return make(allocator);
  }
  static void setChildren(void* node, void** children, unsigned int count, void*)
  {
    for (unsigned int i = 0; i < count; ++i)
    {
      static_cast<Made*>(node)->child[i] = static_cast<Made*>(children[i]);
    }
  }
  static void setBounds(void* node, const RTCBounds** bounds, unsigned int count, void*)
  {
    for (unsigned int i = 0; i < count; ++i)
    {
      const float x = bounds[i]->upper_x - bounds[i]->lower_x;
      const float y = bounds[i]->upper_y - bounds[i]->lower_y;
      const float z = bounds[i]->upper_z - bounds[i]->lower_z;
      static_cast<Made*>(node)->area[i] = x * y + y * z + z * x;
    }
  }
  static void* createLeaf(
    RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* boxes, std::size_t count, void*)
  {
    Made* const made = make(allocator);
    made->leaf.count = static_cast<std::uint32_t>(count);
    std::transform(boxes, boxes + count, made->leaf.box,
      [](const RTCBuildPrimitive& box) { return box.primID; });
    return made;
  }
};

} // namespace

// Bounds of an unused child: inside out for every ray, and such that nobody's arithmetic leaves the
// numbers. Beyond kLargestCoordinate, and times kSteepest still a float.
constexpr float kBeyond = 1e19f;

// Gathers the nodes of the tree of two into nodes of eight such that the expected number of nodes
// that a ray meets, the sum of their areas, is the smallest possible: the dynamic programme of
// H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
// Wide BVHs", High-Performance Graphics 2017, section 3.1. Opening the largest child first, as
// Embree does, leaves nodes half empty where the leaves are.
class WideTree::Gathering
{
public:
  std::vector<Leaf> Leaves;

  explicit Gathering(HugePageVector<WideNode>& nodes)
    : Nodes(nodes)
  {
  }

  std::uint32_t run(const Made& root)
  {
    this->decide(root, 0.0f);
    return this->place(static_cast<std::uint32_t>(this->Choices.size() - 1));
  }

private:
  static constexpr int kWidth = WideNode::kWidth;

  // A subtree as so many children of one wide node: what that costs at least, and by how many of
  // them the first half is represented. One child: it is a wide node itself, which is divided so.
  struct Choice
  {
    float cost[kWidth] = {};                      // by the number of children that it may take
    std::uint8_t first[kWidth] = {};              // zero: as with one child fewer
    std::uint32_t half[2] = { kUnused, kUnused }; // numbers of choices; the second kUnused: a leaf
  };

  std::uint32_t decide(const Made& made, float area)
  {
    Choice choice;
    if (!made.child[0])
    {
      choice.half[0] = static_cast<std::uint32_t>(this->Leaves.size());
      this->Leaves.push_back(made.leaf);
    }
    else
    {
      choice.half[0] = this->decide(*made.child[0], made.area[0]);
      choice.half[1] = this->decide(*made.child[1], made.area[1]);
      this->divide(choice, kWidth, 1, area);
      for (int count = 2; count < kWidth; ++count)
      {
        choice.cost[count] = choice.cost[count - 1];
        this->divide(choice, count, count, 0.0f);
      }
    }
    this->Choices.push_back(choice);
    return static_cast<std::uint32_t>(this->Choices.size() - 1);
  }

  // The best division of `slots` between the halves, noted under `count`.
  void divide(Choice& choice, int slots, int count, float area) const
  {
    const Choice& a = this->Choices[choice.half[0]];
    const Choice& b = this->Choices[choice.half[1]];
    for (int first = 1; first < slots; ++first)
    {
      const float cost = area + a.cost[first] + b.cost[slots - first];
      if ((count == 1 && first == 1) || cost < choice.cost[count])
      {
        choice.cost[count] = cost;
        choice.first[count] = static_cast<std::uint8_t>(first);
      }
    }
  }

  // The subtrees that `number` becomes when it may take so many children.
  void collect(std::uint32_t number, int count, std::vector<std::uint32_t>& children) const
  {
    const Choice& choice = this->Choices[number];
    while (count > 1 && choice.first[count] == 0)
    {
      --count;
    }
    if (count == 1 || choice.half[1] == kUnused)
    {
      children.push_back(number);
      return;
    }
    this->collect(choice.half[0], choice.first[count], children);
    this->collect(choice.half[1], count - choice.first[count], children);
  }

  std::uint32_t place(std::uint32_t number)
  {
    const Choice& choice = this->Choices[number];
    if (choice.half[1] == kUnused)
    {
      return kLeaf | choice.half[0];
    }
    std::vector<std::uint32_t> children;
    this->collect(choice.half[0], choice.first[1], children);
    this->collect(choice.half[1], kWidth - choice.first[1], children);
    const std::size_t node = this->Nodes.size();
    this->Nodes.emplace_back();
    for (std::size_t i = 0; i < kWidth; ++i)
    {
      const std::uint32_t child = i < children.size() ? this->place(children[i]) : kUnused;
      this->Nodes[node].child[i] = child;
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Nodes[node].bound[0][axis][i] = kBeyond;
        this->Nodes[node].bound[1][axis][i] = -kBeyond;
      }
    }
    return static_cast<std::uint32_t>(node);
  }

  HugePageVector<WideNode>& Nodes;
  std::vector<Choice> Choices; // of the tree of two, children before parents
};

std::vector<WideTree::Leaf> WideTree::build(
  Device& device, std::vector<RTCBuildPrimitive>& boxes, unsigned int mostInLeaf, const char* doing)
{
  this->Nodes.clear();
  this->Root = kUnused;
  if (boxes.empty())
  {
    return {}; // Embree would make a leaf of nothing
  }
  Gathering gathering(this->Nodes);
  gathering.Leaves.reserve(boxes.size() / mostInLeaf); // no fewer
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxDepth = kDeepest;
  arguments.sahBlockSize = mostInLeaf;
  // So few boxes are a leaf, whatever the cost: a leaf is tested as a whole.
  arguments.minLeafSize = mostInLeaf;
  arguments.maxLeafSize = mostInLeaf;
  const RTCBVH tree = rtcNewBVH(device.handle());
  arguments.bvh = tree;
  arguments.primitives = boxes.data();
  arguments.primitiveCount = boxes.size();
  arguments.primitiveArrayCapacity = boxes.size();
  arguments.createNode = &Made::createNode;
  arguments.setNodeChildren = &Made::setChildren;
  arguments.setNodeBounds = &Made::setBounds;
  arguments.createLeaf = &Made::createLeaf;
  if (const void* const root = rtcBuildBVH(&arguments))
  {
    this->Root = gathering.run(*static_cast<const Made*>(root));
  }
  rtcReleaseBVH(tree);
  device.check(doing);
  return std::move(gathering.Leaves);
}

void WideTree::setBounds(std::size_t node, int child, const TraversalBox& box, double padding)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Nodes[node].bound[0][axis][child] = static_cast<float>(box.lower[axis] - padding);
    this->Nodes[node].bound[1][axis][child] = static_cast<float>(box.upper[axis] + padding);
  }
}

void WideTree::setBounds(std::size_t node, int child, std::uint32_t below)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto& lower = this->Nodes[below].bound[0][axis];
    const auto& upper = this->Nodes[below].bound[1][axis];
    this->Nodes[node].bound[0][axis][child] = *std::min_element(lower, lower + WideNode::kWidth);
    this->Nodes[node].bound[1][axis][child] = *std::max_element(upper, upper + WideNode::kWidth);
  }
}

double WideTree::cost() const
{
  const auto surfaceArea = [](const glm::dvec3& lower, const glm::dvec3& upper)
  {
    const glm::dvec3 d = upper - lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
  };
  double areas = 0.0;
  TraversalBox root;
  for (const WideNode& node : this->Nodes)
  {
    const bool isRoot = &node == this->Nodes.data();
    for (int i = 0; i < WideNode::kWidth && node.child[i] != kUnused; ++i)
    {
      const glm::dvec3 lower(node.bound[0][0][i], node.bound[0][1][i], node.bound[0][2][i]);
      const glm::dvec3 upper(node.bound[1][0][i], node.bound[1][1][i], node.bound[1][2][i]);
      areas += surfaceArea(lower, upper);
      if (isRoot)
      {
        root.include(lower);
        root.include(upper);
      }
    }
  }
  const double whole = this->Nodes.empty() ? 0.0 : surfaceArea(root.lower, root.upper);
  return whole > 0.0 ? areas / whole : 1.0;
}

} // namespace bvh
} // namespace hrt
