// See Stage.h.
#include "Rendering/Core/Plan/Stage.h"

namespace hrt
{

const char* stageName(Stage stage)
{
  switch (stage)
  {
    case Stage::GeometryUpload:
      return "geometry_upload";
    case Stage::ShadowMaps:
      return "shadow_maps";
    case Stage::Visibility:
      return "visibility";
    case Stage::PrimaryShading:
      return "primary_shading";
    case Stage::ShadowReadBack:
      return "shadow_read_back";
    case Stage::ReadBack:
      return "read_back";
    case Stage::Structure:
      return "structure";
    case Stage::SecondaryRays:
      return "secondary_rays";
    case Stage::Blit:
      return "blit";
    case Stage::Count:
      break;
  }
  return "";
}

} // namespace hrt
