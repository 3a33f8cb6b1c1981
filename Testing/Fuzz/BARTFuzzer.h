// One input of fuzzing as a scene: up to the first zero byte it is the main file, after it a file
// that the main one may include. Used by the libFuzzer target and by the mutations of ctest, so
// that both test the same thing.
#pragma once

#include "IO/BART/AFF/Error.h"
#include "IO/BART/AFF/Parser.h"

#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

namespace hrt
{
namespace bart
{

// Small, so that no input takes long for what larger limits would allow.
inline Limits fuzzLimits()
{
  Limits limits;
  limits.bytes = 1 << 20;
  limits.includes = limits.instances = limits.transforms = 1000;
  limits.includeDepth = 8;
  limits.braceDepth = 50;
  return limits;
}

// True for a scene, false for a text that is refused as it should be. Anything else ends the
// program.
inline bool readFuzzed(std::string_view input)
{
  MemoryFiles files;
  const std::size_t end = std::min(input.find('\0'), input.size());
  files.files["main.aff"] = std::string(input.substr(0, end));
  files.files["part.aff"] = std::string(input.substr(std::min(end + 1, input.size())));
  try
  {
    const Scene scene = readScene("main.aff", files, fuzzLimits());
    for (double time : { scene.startTime, 0.5 * (scene.startTime + scene.endTime), 1e9 })
    {
      const Pose pose = poseAt(scene, time);
      for (const PointLight& light : scene.lights)
      {
        lightPositionAt(scene, pose, light, time);
      }
      for (const AnimatedTriangles& triangles : scene.animatedTriangles)
      {
        for (const AnimatedTriangle& triangle : triangles)
        {
          cornersAt(triangle, time);
        }
      }
      viewpointAt(scene, time);
    }
    return countTriangles(scene).all >= countTriangles(scene).textured || (std::abort(), false);
  }
  catch (const ReadError& error)
  {
    // Every complaint says where.
    if (error.where().file.empty() || error.where().line == 0)
    {
      std::abort();
    }
    return false;
  }
}

} // namespace bart
} // namespace hrt
