// What one frame is composed of on the GPU. There are two of them, so that one can be shown while the
// rays of the other are still traced (FrameRenderer.h).
#pragma once

#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/DepthMargin.h"
#include "Rendering/OpenGL2/ObjectIntersectionBuffer.h"
#include "Rendering/OpenGL2/ObjectPool.h"

#include "Rendering/Core/Plan/Settings.h"

namespace hrt
{
namespace gl
{

struct Picture
{
  Picture(ObjectPool& pool, const DepthConvention& convention)
    : hits(pool, convention)
    , primary(pool)
    , secondary(pool)
  {
  }

  ObjectIntersectionBuffer hits;
  DepthMargin margin; // of the hits' depths
  Image2D primary;
  Image2D secondary;
  bool useSecondary = false; // composite it over the primary image

  // Makes the buffers of every frame fit; true when what they held is lost.
  bool resize(int width, int height, Visibility visibility)
  {
    const bool hitsLost = this->hits.resize(width, height, visibility);
    return this->primary.allocate(width, height, GL_RGBA32F, GL_RGBA, GL_FLOAT) || hitsLost;
  }
};

} // namespace gl
} // namespace hrt
