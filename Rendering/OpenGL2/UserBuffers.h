// Per-pixel results for scripts ("which triangle, which cell, where, how deep, how lit"): made from
// the triangle numbers of the object intersection buffer by intersecting each pixel's ray with its
// triangle in double precision, so that they are more exact than anything a rasteriser interpolates
// (in the paper's direct rendering: with the rasteriser's own (u, v), which is that mode's answer).
// Nothing is computed that was not asked for.
#pragma once

#include "Rendering/OpenGL2/FrameRenderer.h"

#include "Rendering/Core/Snapshot.h"

#include "vtkSmartPointer.h"

#include <map>
#include <string>
#include <vector>

class vtkImageData;

namespace hrt
{
namespace gl
{

class UserBuffers
{
public:
  // Every valid name.
  static const std::vector<std::string>& knownNames();

  void setNames(const std::vector<std::string>& names);
  const std::vector<std::string>& names() const { return this->Names; }

  // Fills the buffers that were asked for from the last frame. Empty, or what went wrong.
  std::string update(FrameRenderer& frame, const Snapshot& snapshot);
  // False after a change that the buffers do not show yet.
  bool current() const { return this->Current; }
  void invalidate() { this->Current = false; }

  // Null when it was not asked for or not made yet.
  vtkImageData* image(const std::string& name) const;

private:
  std::vector<std::string> Names;
  std::map<std::string, vtkSmartPointer<vtkImageData>> Images;
  bool Current = false;
};

} // namespace gl
} // namespace hrt
