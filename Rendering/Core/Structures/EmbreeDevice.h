// An Embree device whose errors become exceptions with Embree's own words.
#pragma once

#include "Rendering/Core/Structures/EmbreeShim.h"
#include "Rendering/Core/Structures/InstructionSet.h"

#include <mutex>
#include <string>

namespace hrt
{
namespace bvh
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

  // That for which Embree itself runs code here: it looks at the processor and at the
  // configuration, so that one switch steers Embree's code and ours.
  InstructionSet instructionSet() const { return this->Set; }

  // Throws when a call since the last check failed on this thread.
  void check(const char* doing);

private:
  static void remember(void* self, RTCError, const char* message);

  RTCDevice Handle;
  InstructionSet Set = InstructionSet::Base;
  std::mutex Mutex;
  std::string Message;
};

} // namespace bvh
} // namespace hrt
