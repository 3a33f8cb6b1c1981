// The reference renderer behind plain C functions, so that a Python test can ask for the reference
// picture of the very vtkRenderer that it has just drawn with the pass. Python hands over the
// renderer's address (vtkObject's __this__); nothing of this is wrapped, installed or shipped.
#include "Testing/Cxx/Reference/ReferenceRenderer.h"

#include "Rendering/Scene/vtkHybridScene.h"

#include "vtkNew.h"
#include "vtkRenderer.h"

#include <cstdint>
#include <memory>

#if defined(_WIN32)
#define HRT_REFERENCE_EXPORT extern "C" __declspec(dllexport)
#else
#define HRT_REFERENCE_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace
{

struct Result
{
  hrt::reference::Picture picture;
  // Admissible ids of all pixels in a row, -1 for "nothing"; pixel i's start at starts[i].
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> starts;
};

std::int64_t idOf(hrt::TriangleId triangle)
{
  return triangle == hrt::kNoTriangle ? -1 : static_cast<std::int64_t>(triangle);
}

} // namespace

// Draws the renderer as it stands; the caller owns the result and gives it back to
// hrtReferenceDelete. The renderer must have been rendered before, so that its camera, lights and
// default light are settled. `flags`: 1 shadows, 2 tinted shadows, 4 reflections, 8 refractions.
HRT_REFERENCE_EXPORT void* hrtReferenceRender(void* renderer, int maximumDepth, int flags)
{
  vtkNew<vtkHybridScene> scene;
  scene->Update(static_cast<vtkRenderer*>(renderer));
  hrt::TracerSettings settings;
  settings.maximumDepth = maximumDepth;
  settings.shadows = (flags & 1) != 0;
  settings.tintedShadows = (flags & 2) != 0;
  settings.reflections = (flags & 4) != 0;
  settings.refractions = (flags & 8) != 0;
  auto result = std::make_unique<Result>();
  result->picture = hrt::reference::render(*scene->GetSnapshot(), settings);
  for (const auto& ids : result->picture.admissible)
  {
    result->starts.push_back(static_cast<std::int64_t>(result->ids.size()));
    for (const hrt::TriangleId id : ids)
    {
      result->ids.push_back(idOf(id));
    }
  }
  result->starts.push_back(static_cast<std::int64_t>(result->ids.size()));
  return result.release();
}

HRT_REFERENCE_EXPORT void hrtReferenceDelete(void* result)
{
  delete static_cast<Result*>(result);
}

HRT_REFERENCE_EXPORT int hrtReferenceWidth(const void* result)
{
  return static_cast<const Result*>(result)->picture.width;
}

HRT_REFERENCE_EXPORT int hrtReferenceHeight(const void* result)
{
  return static_cast<const Result*>(result)->picture.height;
}

// 4 doubles a pixel.
HRT_REFERENCE_EXPORT const double* hrtReferenceColors(const void* result)
{
  return &static_cast<const Result*>(result)->picture.colors.data()->x;
}

// 3 doubles a pixel.
HRT_REFERENCE_EXPORT const double* hrtReferenceOmitted(const void* result)
{
  return &static_cast<const Result*>(result)->picture.omitted.data()->x;
}

HRT_REFERENCE_EXPORT const std::uint8_t* hrtReferenceFragile(const void* result)
{
  return static_cast<const Result*>(result)->picture.fragile.data();
}

HRT_REFERENCE_EXPORT const std::int64_t* hrtReferenceAdmissible(const void* result)
{
  return static_cast<const Result*>(result)->ids.data();
}

// One more than there are pixels.
HRT_REFERENCE_EXPORT const std::int64_t* hrtReferenceStarts(const void* result)
{
  return static_cast<const Result*>(result)->starts.data();
}
