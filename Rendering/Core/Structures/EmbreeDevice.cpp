// Implements the device.
#include "Rendering/Core/Structures/EmbreeDevice.h"

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

// Embree answers "8 rays natively" from AVX on, 16 from AVX-512 on; what exactly we need of them is
// asked of the processor.
InstructionSet setOf(RTCDevice device)
{
#if defined(__GNUC__) && defined(__x86_64__)
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) == 0 ||
    !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
  {
    return InstructionSet::Base;
  }
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0 &&
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")
    ? InstructionSet::Avx512
    : InstructionSet::Avx2;
#else
  (void)device;
  return InstructionSet::Base;
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
