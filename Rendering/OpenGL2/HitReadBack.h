// Brings the object intersection buffer's triangle numbers to host memory through a pixel buffer
// object (paper, section 3.1): the copy is queued right after the buffer is drawn, other work of the
// frame is issued, and only then are the numbers mapped.
#pragma once

#include "Rendering/OpenGL2/ObjectIntersectionBuffer.h"
#include "Rendering/OpenGL2/ObjectPool.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace hrt
{
namespace gl
{

class HitReadBack
{
public:
  explicit HitReadBack(ObjectPool& pool);

  // Queues the copy.
  void begin(const ObjectIntersectionBuffer& hits);
  // Waits for it. width x height numbers plus one (0: no hit), row 0 at the bottom. False when the
  // driver would not map the buffer.
  bool finish(std::vector<std::uint32_t>& ids);

  // The (u, v) that direct rendering stored, at once. False when the buffer is an item buffer.
  static bool readBarycentrics(
    const ObjectIntersectionBuffer& hits, std::vector<glm::dvec2>& barycentrics);

  std::uint64_t bytes() const { return this->Bytes; }

private:
  GLuint Buffer;
  std::uint64_t Bytes = 0;
};

} // namespace gl
} // namespace hrt
