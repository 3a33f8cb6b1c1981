// From vtkTexture to the texels and rules of hrt::Texture, as vtkOpenGLTexture hands them to OpenGL:
// images of colours as they are, all else through the texture's lookup table.
#pragma once

#include "Rendering/Core/Scene/Texture.h"

#include "vtkTexture.h"
#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <cstddef>
#include <memory>
#include <tuple>
#include <unordered_map>

class vtkActor;

namespace hrt
{
namespace scene
{

// What an actor's textures come to.
struct TextureReading
{
  enum class State
  {
    Good,
    MipMapped,  // VTK shows images of several sizes
    Unreadable  // no image of two dimensions in the host's memory, or of too many components
  };
  State state = State::Good;
  Textures textures;
};

// Keeps what was read from frame to frame. A Texture is replaced only when its texels or rules differ.
class TextureCache
{
public:
  // The textures that VTK's mapper multiplies an actor's shaded colour with, in its order: the actor's,
  // then those of its property by their names, without the ones that physically based shading uses.
  // Pipelines are brought up to date.
  TextureReading read(vtkActor* actor);

  // Forgets the textures that were not read since the last call.
  void endFrame();

private:
  using Signature = std::tuple<vtkMTimeType, const void*, vtkMTimeType, vtkMTimeType>;
  struct Record
  {
    vtkWeakPointer<vtkTexture> source; // another one may come to live at its address
    Signature signature;
    std::shared_ptr<const Texture> texture; // null: cannot be read
    bool used = false;
  };

  std::shared_ptr<const Texture> get(vtkTexture* source);

  std::unordered_map<const vtkTexture*, Record> Records;
};

} // namespace scene
} // namespace hrt
