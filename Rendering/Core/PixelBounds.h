// The rectangle of the picture that a frame is restricted to. Workers that share a picture by tiles
// (sort first, the paper's section 2.1) each trace one: with the whole picture's camera, viewport and
// buffer sizes, so that a pixel does not depend on who draws it. The name is pbrt's.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace hrt
{

// Columns [x0, x1) and rows [y0, y1) of the camera's viewport, row 0 at the bottom. As it is made:
// everything, whatever the viewport's size.
struct PixelBounds
{
  int x0 = 0;
  int x1 = std::numeric_limits<int>::max();
  int y0 = 0;
  int y1 = std::numeric_limits<int>::max();

  bool operator==(const PixelBounds& o) const
  {
    return this->x0 == o.x0 && this->x1 == o.x1 && this->y0 == o.y0 && this->y1 == o.y1;
  }
  bool operator!=(const PixelBounds& o) const { return !(*this == o); }

  bool empty() const { return this->x0 >= this->x1 || this->y0 >= this->y1; }
  int width() const { return this->empty() ? 0 : this->x1 - this->x0; }
  int height() const { return this->empty() ? 0 : this->y1 - this->y0; }
  std::size_t pixels() const { return std::size_t(this->width()) * std::size_t(this->height()); }

  // With a margin around it, for bounds that lie within a picture; nothing has no margin.
  PixelBounds grownBy(int margin) const
  {
    return this->empty() ? *this
                         : PixelBounds{ this->x0 - margin, this->x1 + margin, this->y0 - margin,
                             this->y1 + margin };
  }

  // What of it lies in a picture of that size; all zero when nothing does.
  PixelBounds within(int pictureWidth, int pictureHeight) const
  {
    PixelBounds inside;
    inside.x0 = std::max(this->x0, 0);
    inside.x1 = std::min(this->x1, pictureWidth);
    inside.y0 = std::max(this->y0, 0);
    inside.y1 = std::min(this->y1, pictureHeight);
    return inside.empty() ? PixelBounds{ 0, 0, 0, 0 } : inside;
  }
};

// Lays the rows of a rectangle, packed without gaps, into their place in a picture of that width.
template <class Value>
void placeRows(const Value* packed, const PixelBounds& bounds, int pictureWidth,
  std::vector<Value>& picture)
{
  for (int row = 0; row < bounds.height(); ++row)
  {
    const std::size_t target =
      std::size_t(bounds.y0 + row) * std::size_t(pictureWidth) + std::size_t(bounds.x0);
    std::copy_n(packed + std::size_t(row) * std::size_t(bounds.width()), bounds.width(),
      picture.begin() + static_cast<std::ptrdiff_t>(target));
  }
}

} // namespace hrt
