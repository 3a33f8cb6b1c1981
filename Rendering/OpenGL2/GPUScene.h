// The scene as the GPU holds it, triangles, tables of materials and lights and shadow maps, and the
// shading of pictures from them. These belong together: the primary shader reads them all at
// once, and what of them is up to date decides whether they are made again.
#pragma once

#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/DepthPrograms.h"
#include "Rendering/OpenGL2/FrameStatistics.h"
#include "Rendering/OpenGL2/GeometryBuffers.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/PartTables.h"
#include "Rendering/OpenGL2/Picture.h"
#include "Rendering/OpenGL2/PrimaryShader.h"
#include "Rendering/OpenGL2/ShadowMaps.h"
#include "Rendering/OpenGL2/TextureBuffers.h"

#include "Rendering/Core/PixelBounds.h"
#include "Rendering/Core/Plan/Caches.h"
#include "Rendering/Core/Plan/Facts.h"
#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Snapshot.h"

#include <string>
#include <vector>

namespace hrt
{
namespace gl
{

// Text that is returned says what went wrong; empty when nothing did.
class GPUScene
{
public:
  GPUScene(ObjectPool& pool, const DepthConvention& convention);

  // Makes room for the shadow maps that may be wanted, and takes from the caches what is not there.
  void prepare(const Snapshot& snapshot, const Facts& facts, const Settings& settings,
    FrameStatistics& statistics, Caches& caches);

  std::string uploadGeometry(const Snapshot& snapshot, FrameStatistics& statistics);
  // Before parts are rasterised: what those with holes look up.
  std::string prepareDrawing(const Snapshot& snapshot, FrameStatistics& statistics);
  // The maps that the statistics' plan asks for.
  std::string drawShadowMaps(const Snapshot& snapshot, FrameStatistics& statistics);
  std::string readBackShadowMaps(FrameStatistics& statistics);

  // Shades the primary image from the picture's hits.
  std::string shade(const Snapshot& snapshot, const PixelBounds& bounds, Picture& picture,
    FrameStatistics& statistics);
  // The visible share of one light per pixel: see PrimaryShader.
  bool readShadow(const Snapshot& snapshot, const PixelBounds& bounds, const Picture& picture,
    int light, std::vector<float>& share);

  DepthPrograms::Tables tables() const
  {
    return { this->Geometry, this->Tables, this->Images };
  }
  const ShadowMaps& shadowMaps() const { return this->Shadows; }

private:
  // Textures and parts' tables, as drawing and shading look them up.
  std::string updateParts(const Snapshot& snapshot, FrameStatistics& statistics);
  PrimaryShader::Inputs inputs(const Snapshot& snapshot, const PixelBounds& bounds,
    const Picture& picture, const SurfaceFeatures& features) const;

  const ObjectPool& Pool;
  GeometryBuffers Geometry;
  TextureBuffers Images;
  PartTables Tables;
  ShadowMaps Shadows;
  PrimaryShader Caster;
};

} // namespace gl
} // namespace hrt
