// Bounds what a rasteriser in software remembers. It sorts triangles into tiles, some 150 bytes each,
// for threads that draw them later, and takes and keeps more memory as long as these are behind: a
// million triangles could cost more there than everywhere else. So a pass is cut into pieces, of which
// at most two are on their way: one is drawn while the next is sorted. A graphics card is left alone.
#pragma once

#include "Rendering/OpenGL2/GLHeader.h"

#include <algorithm>
#include <cstddef>

namespace hrt
{
namespace gl
{

// For one pass; the context must be current as long as it lives.
class DrawThrottle
{
public:
  // Small enough for the processor's caches.
  static constexpr std::size_t kTrianglesOfPiece = 1 << 15;
  // Of fewer triangles the memory is not worth the waiting, which takes some milliseconds.
  static constexpr std::size_t kTrianglesOfScene = 1 << 18;

  // `triangles`: of the scene.
  explicit DrawThrottle(std::size_t triangles);
  ~DrawThrottle();
  DrawThrottle(const DrawThrottle&) = delete;
  DrawThrottle& operator=(const DrawThrottle&) = delete;

  // Calls draw(first, count) once or in pieces, which together are all of so many meshes in their order.
  template <class Draw>
  void draw(std::size_t meshes, std::size_t trianglesOfMesh, Draw draw)
  {
    std::size_t first = 0;
    while (first < meshes)
    {
      const std::size_t fit =
        std::max<std::size_t>(this->Room / std::max<std::size_t>(trianglesOfMesh, 1), 1);
      const std::size_t count = this->Active ? std::min(fit, meshes - first) : meshes - first;
      draw(first, count);
      this->drawn(count * trianglesOfMesh);
      first += count;
    }
  }

private:
  void drawn(std::size_t triangles);
  void finishPiece();

  bool Active;
  std::size_t Room = kTrianglesOfPiece; // triangles that the piece still takes
  GLsync Before = nullptr;              // reached when the piece before is drawn
};

} // namespace gl
} // namespace hrt
