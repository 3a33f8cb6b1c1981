// Implements the device.
#include "Rendering/Core/Structures/EmbreeDevice.h"

#include "Rendering/Core/Surface/SurfaceKernels.h"

#include <algorithm>
#include <stdexcept>

namespace hrt
{
namespace bvh
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

// Embree answers "8 rays natively" from AVX on, 16 from AVX-512 on, as it is configured; what the processor has
// is asked elsewhere.
InstructionSet setOf(RTCDevice device)
{
  const auto has = [device](RTCDeviceProperty property)
  { return rtcGetDeviceProperty(device, property) != 0; };
  const InstructionSet most = has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) ? InstructionSet::Avx512
    : has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)                          ? InstructionSet::Avx2
                                                                              : InstructionSet::Base;
  return std::min(most, bestInstructionSet());
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
    this->Set = setOf(this->Handle);
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

} // namespace bvh
} // namespace hrt
