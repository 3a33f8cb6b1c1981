// The paper's ray structure: kd-trees by the surface area heuristic over the exact kernel. It is the
// mode "as published" and the second oracle beside BvhStructure: nothing but the kernel and the tie
// rule is common to both, and the answers are equal bit by bit.
//
// Two levels: one tree per Geometry, kept by its version and shared by all parts that show it, below one
// small tree of the parts. A moved part costs only the latter.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"
#include "Rendering/Core/Structures/KdTreeTraversal.h"
#include "Rendering/Core/Structures/Structure.h"

#include <memory>
#include <stdexcept>
#include <vector>

namespace hrt
{

// Thrown by update when the control's abort flag was seen.
class KdTreeAborted : public std::runtime_error
{
public:
  KdTreeAborted()
    : std::runtime_error("kd-tree: the build was aborted")
  {
  }
};

struct KdTreeSettings
{
  // Of a build; 0: those of the caller's TBB arena. The trees do not depend on it.
  int threads = 0;
  KdTreeBuildControl control;
};

class KdTreeStructure final : public Structure
{
public:
  explicit KdTreeStructure(const KdTreeSettings& settings = {});
  ~KdTreeStructure() override;

  KdTreeStructure(const KdTreeStructure&) = delete;
  KdTreeStructure& operator=(const KdTreeStructure&) = delete;

  // An aborted update throws KdTreeAborted and leaves the structure as it was; trees that were finished
  // are kept for the next one.
  StructureReport update(const Snapshot& snapshot) override;

  using Structure::intersect; // the streams, which the overloads here would hide
  using Structure::occluded;
  Hit intersect(const Ray& ray) const override;
  void intersectAll(const Ray& ray, std::vector<Hit>& hits) const override;
  bool occluded(const Ray& ray) const override;

  // The same answers, and what it took.
  Hit intersect(const Ray& ray, KdCounters& counters) const;
  bool occluded(const Ray& ray, KdCounters& counters) const;

  // Of the trees, one a geometry, in the order of the parts that first show them.
  std::vector<KdTreeQuality> quality() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl;
};

} // namespace hrt
