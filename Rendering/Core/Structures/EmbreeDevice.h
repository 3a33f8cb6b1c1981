// An Embree device whose errors become exceptions with Embree's own words.
#pragma once

#include "Rendering/Core/Structures/EmbreeShim.h"

#include <mutex>
#include <string>

namespace hrt
{
namespace embree
{

class Device
{
public:
  // Throws std::runtime_error; so do all that take a device.
  explicit Device(const std::string& configuration);
  ~Device() { rtcReleaseDevice(this->Handle); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  RTCDevice handle() const { return this->Handle; }

  // Whether Embree itself runs code for AVX2 here: it looks at the processor and at the
  // configuration, so that one switch steers Embree's code and ours.
  bool wide() const { return this->Wide; }

  // Throws when a call since the last check failed on this thread.
  void check(const char* doing);

private:
  static void remember(void* self, RTCError, const char* message);

  RTCDevice Handle;
  bool Wide = false;
  std::mutex Mutex;
  std::string Message;
};

} // namespace embree
} // namespace hrt
