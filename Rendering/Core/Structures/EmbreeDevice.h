// An Embree device whose errors become exceptions with Embree's own words, and the one kind of
// scene that the structure builds on it.
#pragma once

#include "Rendering/Core/Structures/EmbreeShim.h"

#include <cstddef>
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

// A scene with one user geometry of `count` primitives.
struct UserGeometry
{
  void* data = nullptr;
  std::size_t count = 0;
  RTCBoundsFunction bounds = nullptr;
  RTCIntersectFunctionN intersect = nullptr;
  RTCOccludedFunctionN occluded = nullptr;
};

class Scene
{
public:
  enum class Kind
  {
    Static, // built well, for good
    Refittable
  };

  Scene(Device& device, const UserGeometry& primitives, Kind kind, const char* doing);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  RTCScene handle() const { return this->Handle; }

  // New bounds for the same primitives; for a refittable scene.
  void refit(Device& device);
  // New bounds and perhaps another number of primitives.
  void rebuild(Device& device, std::size_t count, const char* doing);

private:
  RTCScene Handle = nullptr;
  RTCGeometry Primitives = nullptr;
};

} // namespace embree
} // namespace hrt
