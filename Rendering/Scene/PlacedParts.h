// Two small decisions about a part's place in the snapshot that are worth testing alone: whether
// its matrix can be used, and whether its triangles still fit into the numbering.
#pragma once

#include "Rendering/Core/Snapshot.h"

namespace hrt
{
namespace scene
{

enum class MatrixState
{
  Good,
  Projective, // the last row is not (0, 0, 0, w)
  Singular    // not finite or not invertible
};

// Divides the matrix by w. The result is for use when it is Good.
MatrixState normaliseMatrix(glm::dmat4& localToWorld);

// Counts triangles up to as many as can be numbered.
class TriangleNumbers
{
public:
  explicit TriangleNumbers(std::uint64_t limit = kMaximumTriangles)
    : Limit(limit)
  {
  }

  // False, and nothing taken, when so many do not fit any more.
  bool take(std::uint64_t count)
  {
    if (count > this->Limit - this->Taken)
    {
      return false;
    }
    this->Taken += count;
    return true;
  }

private:
  std::uint64_t Limit;
  std::uint64_t Taken = 0;
};

} // namespace scene
} // namespace hrt
