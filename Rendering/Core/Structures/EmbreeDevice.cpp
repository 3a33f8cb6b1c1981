// Implements device and scene: the only calls to Embree that can fail.
#include "Rendering/Core/Structures/EmbreeDevice.h"

#include <stdexcept>

namespace hrt
{
namespace embree
{

namespace
{

std::string describe(RTCError error)
{
  switch (error)
  {
    case RTC_ERROR_INVALID_ARGUMENT:
      return " (invalid argument)";
    case RTC_ERROR_INVALID_OPERATION:
      return " (invalid operation)";
    case RTC_ERROR_OUT_OF_MEMORY:
      return " (out of memory)";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return " (unsupported processor)";
    case RTC_ERROR_CANCELLED:
      return " (cancelled)";
    default:
      return " (unknown error)";
  }
}

// Embree answers "8 rays natively" from AVX on; AVX2 and fused operations are asked of the
// processor.
bool runsWide(RTCDevice device)
{
#if defined(__GNUC__) && defined(__x86_64__)
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0 &&
    __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  (void)device;
  return false;
#endif
}

} // namespace

Device::Device(const std::string& configuration)
  : Handle(rtcNewDevice(configuration.empty() ? nullptr : configuration.c_str()))
{
  if (!this->Handle)
  {
    throw std::runtime_error("Embree: no device" + describe(rtcGetDeviceError(nullptr)));
  }
  rtcSetDeviceErrorFunction(this->Handle, &Device::remember, this);
  try
  {
    this->check("creating the device");
    this->Wide = runsWide(this->Handle);
  }
  catch (...)
  {
    rtcReleaseDevice(this->Handle);
    throw;
  }
}

void Device::check(const char* doing)
{
  const RTCError error = rtcGetDeviceError(this->Handle);
  if (error == RTC_ERROR_NONE)
  {
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Mutex);
  throw std::runtime_error(
    "Embree: " + std::string(doing) + " failed" + describe(error) + " " + this->Message);
}

void Device::remember(void* self, RTCError, const char* message)
{
  Device& device = *static_cast<Device*>(self);
  const std::lock_guard<std::mutex> lock(device.Mutex);
  device.Message = message ? message : "";
}

Scene::Scene(Device& device, const UserGeometry& primitives, Kind kind, const char* doing)
  : Handle(rtcNewScene(device.handle()))
  , Primitives(rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_USER))
{
  rtcSetSceneFlags(this->Handle, RTC_SCENE_FLAG_ROBUST);
  if (kind == Kind::Refittable)
  {
    // Only scenes of this quality look at the quality that a geometry asks for.
    rtcSetSceneFlags(
      this->Handle, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    rtcSetSceneBuildQuality(this->Handle, RTC_BUILD_QUALITY_LOW);
  }
  rtcSetGeometryUserData(this->Primitives, primitives.data);
  rtcSetGeometryBoundsFunction(this->Primitives, primitives.bounds, nullptr);
  rtcSetGeometryIntersectFunction(this->Primitives, primitives.intersect);
  rtcSetGeometryOccludedFunction(this->Primitives, primitives.occluded);
  rtcSetGeometryUserPrimitiveCount(this->Primitives, static_cast<unsigned int>(primitives.count));
  rtcCommitGeometry(this->Primitives);
  rtcAttachGeometry(this->Handle, this->Primitives);
  rtcCommitScene(this->Handle);
  try
  {
    device.check(doing);
  }
  catch (...)
  {
    rtcReleaseGeometry(this->Primitives);
    rtcReleaseScene(this->Handle);
    throw;
  }
}

Scene::~Scene()
{
  rtcReleaseGeometry(this->Primitives);
  rtcReleaseScene(this->Handle);
}

void Scene::refit(Device& device)
{
  rtcSetGeometryBuildQuality(this->Primitives, RTC_BUILD_QUALITY_REFIT);
  rtcCommitGeometry(this->Primitives);
  rtcCommitScene(this->Handle);
  device.check("refitting a hierarchy");
}

void Scene::rebuild(Device& device, std::size_t count, const char* doing)
{
  rtcSetGeometryBuildQuality(this->Primitives, RTC_BUILD_QUALITY_MEDIUM);
  rtcSetGeometryUserPrimitiveCount(this->Primitives, static_cast<unsigned int>(count));
  rtcCommitGeometry(this->Primitives);
  rtcCommitScene(this->Handle);
  device.check(doing);
}

} // namespace embree
} // namespace hrt
