// Carries out a frame plan: owns the GL side of the pass and the ray structure, runs the stages
// that the plan asks for, in order, and keeps count of what was done. It decides nothing itself.
//
// A pipelined frame (paper, section 3.3) is drawn into the picture that is not shown, while the
// rays of the frame before are traced in the background; then that one is finished and shown, and
// the new frame's rays are started. They go on when render() has returned (BackgroundTracing.h).
#pragma once

#include "Rendering/OpenGL2/BackgroundTracing.h"
#include "Rendering/OpenGL2/Blit.h"
#include "Rendering/OpenGL2/DepthConvention.h"
#include "Rendering/OpenGL2/FrameStatistics.h"
#include "Rendering/OpenGL2/GPUScene.h"
#include "Rendering/OpenGL2/HitReadBack.h"
#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/Picture.h"
#include "Rendering/OpenGL2/RayStructure.h"

#include "Rendering/Core/Plan/FramePlan.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkOpenGLRenderWindow;

namespace hrt
{
namespace gl
{

class FrameRenderer
{
public:
  // The window's context must be current.
  explicit FrameRenderer(vtkOpenGLRenderWindow* window);

  // Renders a frame into the bound framebuffer at (x, y). The settings' bounds have been set for
  // the camera's viewport. Empty when done, else what went wrong.
  std::string render(const std::shared_ptr<const Snapshot>& snapshot, const Changes& changes,
    const Settings& settings, const FrameConditions& conditions, int x, int y);

  const FrameStatistics& statistics() const { return this->Statistics; }
  const ObjectPool& pool() const { return this->Pool; }
  // Whether the context is a graphics card's and not a software rasteriser's.
  bool onHardware() const { return this->Hardware; }

  // For the user's buffers, after render().
  // The pixels that the last frame shows. What the others hold below is left undefined.
  const PixelBounds& bounds() const { return this->LastSettings.bounds; }
  // Triangle numbers plus one of the last frame, row 0 at the bottom. Empty when they cannot be
  // had.
  const std::vector<std::uint32_t>& ids();
  bool readBarycentrics(std::vector<glm::dvec2>& barycentrics); // direct rendering only
  bool readShadow(int light, std::vector<float>& share);

private:
  Caches currentCaches(
    const Snapshot& snapshot, const Facts& facts, const Settings& settings);
  std::string runStage(Stage stage, const Settings& settings);
  std::string drawVisibility(const Snapshot& snapshot, const Settings& settings);
  std::string updateStructure(const Snapshot& snapshot, const Settings& settings);
  std::string castPrimary(const Snapshot& snapshot, const Settings& settings);
  std::string readBackAndTrace(const Settings& settings);
  void beginTracing(const Settings& settings);
  std::string trace(const Settings& settings);
  std::string finishTracing();
  std::string finishFrameBefore();
  std::string show(std::size_t picture, const PixelBounds& bounds, int x, int y);
  Picture& picture() { return this->Pictures[this->Current]; }
  bool castShadows(int light, std::vector<float>& share);
  bool readIds(const PixelBounds& bounds, const std::function<void(int)>& rowsReady);
  TracerSettings tracerSettings(const Settings& settings) const;

  // Destroyed last: all others hold names that it owns.
  ObjectPool Pool;
  DepthConvention Convention;
  bool Hardware;
  bool OthersDraw = true; // in this frame, besides what is traced
  GPUScene OnGPU;
  HitReadBack ReadBack;
  Blit ToWindow;
  std::array<Picture, 2> Pictures;
  std::size_t Current = 0; // the picture of the last frame that was drawn
  RayStructure Rays;
  PrimaryHits Host; // ids in host memory, by rays or read back
  BackgroundTracing Background; // destroyed before the structure and the ids, which it reads

  std::shared_ptr<const Snapshot> Scene; // of the last frame
  Settings LastSettings;
  Caches Valid; // what of the last frame's products may be used again
  FrameStatistics Statistics;
};

} // namespace gl
} // namespace hrt
