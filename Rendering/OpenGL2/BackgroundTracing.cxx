// See BackgroundTracing.h.
#include "Rendering/OpenGL2/BackgroundTracing.h"

#include "Rendering/OpenGL2/Picture.h"

#include <utility>

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
void BackgroundTracing::begin(const std::shared_ptr<const Snapshot>& scene,
  const Structure& structure, const TracerSettings& settings, Wanted wanted,
  const std::uint32_t* ids, Picture& picture)
{
  this->abandon();
  this->Scene = scene;
  this->Settings = settings;
  this->Target = &picture;
  this->Everything = wanted == Wanted::Everything;
  this->Tracer = std::make_unique<ImageTracer>(
    *this->Scene, structure, this->Settings, wanted, ids, this->Image);
}

//------------------------------------------------------------------------------
SecondaryResult BackgroundTracing::finish()
{
  const std::unique_ptr<ImageTracer> tracer = std::move(this->Tracer);
  return tracer->finish();
}

//------------------------------------------------------------------------------
std::uint64_t BackgroundTracing::upload() const
{
  Image2D& texture = this->Everything ? this->Target->primary : this->Target->secondary;
  texture.allocate(this->Image.width, this->Image.height, GL_RGBA32F, GL_RGBA, GL_FLOAT);
  const PixelBounds& bounds = this->Settings.bounds;
  texture.upload(this->Image.pixels.data(), bounds);
  return bounds.pixels() * sizeof(this->Image.pixels[0]);
}

} // namespace gl
} // namespace hrt
