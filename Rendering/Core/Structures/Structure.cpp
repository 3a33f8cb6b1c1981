// Streams for implementations that gain nothing from neighbouring rays: one ray after the other.
#include "Rendering/Core/Structures/Structure.h"

namespace hrt
{

void Structure::intersect(const Ray* rays, Hit* hits, std::size_t count, RayOrder) const
{
  for (std::size_t i = 0; i < count; ++i)
  {
    hits[i] = this->intersect(rays[i]);
  }
}

void Structure::occluded(
  const Ray* rays, std::uint8_t* occluded, std::size_t count, RayOrder) const
{
  for (std::size_t i = 0; i < count; ++i)
  {
    occluded[i] = this->occluded(rays[i]) ? 1 : 0;
  }
}

} // namespace hrt
