// See GPUScene.h.
#include "Rendering/OpenGL2/GPUScene.h"

#include "vtkOpenGLRenderWindow.h"

#include <algorithm>

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
GPUScene::GPUScene(ObjectPool& pool, const DepthConvention& convention)
  : Pool(pool)
  , Geometry(pool)
  , Images(pool)
  , Tables(pool)
  , Shadows(pool, convention)
  , Caster(pool)
{
}

//------------------------------------------------------------------------------
void GPUScene::prepare(const Snapshot& snapshot, const Facts& facts, const Settings& settings,
  FrameStatistics& statistics, Caches& caches)
{
  caches.geometryUploaded = this->Geometry.holds(snapshot);
  std::vector<bool> wanted = facts.lightCanCast;
  for (std::size_t i = 0; i < wanted.size(); ++i)
  {
    wanted[i] = wanted[i] && settings.usesShadowMaps() && facts.anyCaster;
  }
  const std::vector<bool> present =
    this->Shadows.prepare(snapshot, wanted, settings.shadowMapResolution);
  statistics.shadowMapResolution = this->Shadows.resolution();
  caches.shadowMaps.resize(present.size(), false);
  for (std::size_t i = 0; i < present.size(); ++i)
  {
    caches.shadowMaps[i] = caches.shadowMaps[i] && present[i];
  }
}

//------------------------------------------------------------------------------
std::string GPUScene::uploadGeometry(const Snapshot& snapshot, FrameStatistics& statistics)
{
  std::string error;
  this->Geometry.update(snapshot, error);
  statistics.bytesUploaded += this->Geometry.uploadedBytes();
  return error;
}

//------------------------------------------------------------------------------
std::string GPUScene::prepareDrawing(const Snapshot& snapshot, FrameStatistics& statistics)
{
  const bool holes = std::any_of(snapshot.parts.begin(), snapshot.parts.end(),
    [](const Part& part) { return part.perforated; });
  return holes ? this->updateParts(snapshot, statistics) : std::string();
}

//------------------------------------------------------------------------------
std::string GPUScene::drawShadowMaps(const Snapshot& snapshot, FrameStatistics& statistics)
{
  const std::string error = this->prepareDrawing(snapshot, statistics);
  if (!error.empty())
  {
    return error;
  }
  std::vector<bool> draw;
  for (const StageDecision& decision : statistics.plan.shadowMaps)
  {
    draw.push_back(decision.run);
  }
  if (!this->Shadows.draw(this->Pool.window(), snapshot, this->tables(), draw))
  {
    return "the shadow maps could not be drawn";
  }
  statistics.trianglesDrawn += this->Shadows.trianglesDrawn();
  return {};
}

//------------------------------------------------------------------------------
std::string GPUScene::readBackShadowMaps(FrameStatistics& statistics)
{
  return this->Shadows.readBack(this->Pool.window(), statistics.bytesReadBack)
    ? std::string()
    : "the shadow maps could not be read back";
}

//------------------------------------------------------------------------------
std::string GPUScene::updateParts(const Snapshot& snapshot, FrameStatistics& statistics)
{
  std::string error;
  if (this->Images.update(snapshot, error))
  {
    this->Tables.updateParts(snapshot, this->Images);
  }
  statistics.bytesUploaded += this->Images.uploadedBytes();
  return error;
}

//------------------------------------------------------------------------------
PrimaryShader::Inputs GPUScene::inputs(const Snapshot& snapshot, const PixelBounds& bounds,
  const Picture& picture, const SurfaceFeatures& features) const
{
  return { snapshot, this->Geometry, this->Tables, this->Images, this->Shadows, picture.hits, bounds,
    features };
}

//------------------------------------------------------------------------------
std::string GPUScene::shade(const Snapshot& snapshot, const PixelBounds& bounds, Picture& picture,
  FrameStatistics& statistics)
{
  const std::string error = this->updateParts(snapshot, statistics);
  if (!error.empty())
  {
    return error;
  }
  this->Shadows.updateTable(snapshot);
  this->Tables.updateLights(snapshot, this->Shadows.slots());
  return this->Caster.draw(this->Pool.window(),
           this->inputs(snapshot, bounds, picture, statistics.plan.features), picture.primary)
    ? std::string()
    : "the primary image could not be shaded";
}

//------------------------------------------------------------------------------
bool GPUScene::readShadow(const Snapshot& snapshot, const PixelBounds& bounds,
  const Picture& picture, int light, std::vector<float>& share)
{
  // Light falls on a surface whatever its colours are.
  return this->Caster.readShadow(
    this->Pool.window(), this->inputs(snapshot, bounds, picture, {}), light, share);
}

} // namespace gl
} // namespace hrt
