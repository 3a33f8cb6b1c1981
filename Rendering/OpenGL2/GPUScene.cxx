// See GPUScene.h.
#include "Rendering/OpenGL2/GPUScene.h"

#include "vtkOpenGLRenderWindow.h"

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
GPUScene::GPUScene(ObjectPool& pool, const DepthConvention& convention)
  : Pool(pool)
  , Geometry(pool)
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
std::string GPUScene::drawShadowMaps(const Snapshot& snapshot, FrameStatistics& statistics)
{
  std::vector<bool> draw;
  for (const StageDecision& decision : statistics.plan.shadowMaps)
  {
    draw.push_back(decision.run);
  }
  if (!this->Shadows.draw(this->Pool.window(), snapshot, this->Geometry, draw))
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
RayCaster::Inputs GPUScene::inputs(
  const Snapshot& snapshot, const PixelBounds& bounds, const Picture& picture) const
{
  return { snapshot, this->Geometry, this->Tables, this->Shadows, picture.hits, bounds };
}

//------------------------------------------------------------------------------
std::string GPUScene::shade(const Snapshot& snapshot, const PixelBounds& bounds, Picture& picture)
{
  this->Shadows.updateTable(snapshot);
  this->Tables.update(snapshot, this->Shadows.slots());
  return this->Caster.draw(
           this->Pool.window(), this->inputs(snapshot, bounds, picture), picture.primary)
    ? std::string()
    : "the ray caster could not be drawn";
}

//------------------------------------------------------------------------------
bool GPUScene::readShadow(const Snapshot& snapshot, const PixelBounds& bounds,
  const Picture& picture, int light, std::vector<float>& share)
{
  return this->Caster.readShadow(
    this->Pool.window(), this->inputs(snapshot, bounds, picture), light, share);
}

} // namespace gl
} // namespace hrt
