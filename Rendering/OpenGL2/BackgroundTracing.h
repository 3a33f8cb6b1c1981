// Rays that are traced while the GPU draws, in a pipelined frame while a whole further frame is
// drawn and render() has long returned. The snapshot that they read and the image that they write
// are held here for as long as they run, and here alone they are waited for: they have ended when
// finish() or abandon() returns, or when this object is gone. They touch neither GL nor VTK: they
// read an immutable snapshot and the ids, and write an image in host memory.
#pragma once

#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"
#include "Rendering/Core/Tracing/ImageTracer.h"
#include "Rendering/Core/Tracing/Tracer.h"

#include <cstdint>
#include <memory>

namespace hrt
{
namespace gl
{

struct Picture;

class BackgroundTracing
{
public:
  // Begins a picture; what is under way is abandoned. Nothing is traced before ids are announced.
  // The structure and the ids (as ImageTracer takes them) must stay until the rays have ended, the
  // picture until upload().
  void begin(const std::shared_ptr<const Snapshot>& scene, const Structure& structure,
    const TracerSettings& settings, Wanted wanted, const std::uint32_t* ids, Picture& picture);

  // The ids of rows [0, rows) have arrived. Returns at once.
  void idsReady(int rows) { this->Tracer->idsReady(rows); }

  // From begin() until finish() or abandon().
  bool underWay() const { return this->Tracer != nullptr; }
  // Whether what is under way is meant for this picture.
  bool fills(const Picture& picture) const { return this->underWay() && this->Target == &picture; }

  // All ids are there: traces what is left and waits for it. Throws what a ray's task threw; either
  // way nothing is under way any more.
  SecondaryResult finish();

  // Brings what was finished to the picture's texture; the number of bytes. The context must be
  // current.
  std::uint64_t upload() const;

  // Waits for what runs and drops the rest.
  void abandon() { this->Tracer.reset(); }

private:
  std::shared_ptr<const Snapshot> Scene;
  TracerSettings Settings;
  SecondaryImage Image;
  Picture* Target = nullptr;
  bool Everything = false;             // else reflections and refractions only
  std::unique_ptr<ImageTracer> Tracer; // destroyed first: it uses the others
};

} // namespace gl
} // namespace hrt
