// A tree of boxes, eight to a node, in single precision: one node is one step of eight lanes
// (BvhKernels.inl). Embree's builder decides by the surface area heuristic what lies with what;
// the boxes are ours, grown by the bound of TraversalRay.h, and can be moved without building anew.
//
// Why not Embree's own traversal: a hierarchy over our triangles would be user geometry to it,
// whose callbacks cost more than the traversal itself, and its box test pays at every node for a
// rounding that TraversalBox::padding has covered once and for all.
#pragma once

#include "Rendering/Core/Structures/EmbreeDevice.h"
#include "Rendering/Core/Structures/HugePages.h"
#include "Rendering/Core/Structures/TraversalRay.h"

#include <cstdint>
#include <vector>

namespace hrt
{
namespace bvh
{

struct alignas(64) WideNode // four cache lines
{
  static constexpr int kWidth = 8;
  float bound[2][3][kWidth]; // lower and upper, axis, child; an unused child's is inside out
  std::uint32_t child[kWidth];
};

class WideTree
{
public:
  // A child is a node's number, or with this bit that of a leaf.
  static constexpr std::uint32_t kLeaf = 0x80000000u;
  // Nodes on the way down at most: far beyond what the builder's own cost allows. It splits evenly
  // in the last levels before it, and fails when they do not suffice.
  static constexpr unsigned int kDeepest = 512;

  // The boxes' numbers (RTCBuildPrimitive::primID) in each leaf, at most kMostInLeaf. `boxes` is
  // used up. The nodes' bounds are set by fit.
  static constexpr unsigned int kMostInLeaf = 8;
  struct Leaf
  {
    std::uint32_t count = 0;
    std::uint32_t box[kMostInLeaf];
  };
  std::vector<Leaf> build(Device& device, std::vector<RTCBuildPrimitive>& boxes,
    unsigned int mostInLeaf, const char* doing);

  // Sets all bounds from those of the leaves: `boundsOf(i)` is the TraversalBox of the i-th leaf.
  template <class BoundsOf>
  void fit(double padding, BoundsOf boundsOf)
  {
    for (std::size_t i = this->Nodes.size(); i-- > 0;)
    {
      for (int child = 0; child < WideNode::kWidth; ++child)
      {
        const std::uint32_t number = this->Nodes[i].child[child];
        if (number == kUnused)
        {
          continue;
        }
        if ((number & kLeaf) != 0)
        {
          this->setBounds(i, child, boundsOf(number & ~kLeaf), padding);
        }
        else
        {
          this->setBounds(i, child, number);
        }
      }
    }
  }

  // How many children a ray that meets the root is expected to meet: the surface area heuristic's
  // measure.
  double cost() const;

  bool empty() const { return this->Root == kUnused; }
  std::uint32_t root() const { return this->Root; }
  const WideNode* nodes() const { return this->Nodes.data(); }

private:
  static constexpr std::uint32_t kUnused = 0xffffffffu;
  class Gathering;

  void setBounds(std::size_t node, int child, const TraversalBox& box, double padding);
  void setBounds(std::size_t node, int child, std::uint32_t below);

  HugePageVector<WideNode> Nodes; // parents before children
  std::uint32_t Root = kUnused;
};

} // namespace bvh
} // namespace hrt
