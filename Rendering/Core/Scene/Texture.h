// An image on a surface: texels, and how one is found at (s, t). The GPU and the CPU look up the very
// same texels by the same source (Surface/TextureLookup.glsl), so that no driver's filter comes between a
// surface and its mirror image.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace hrt
{

// Immutable once made: a changed image is a new Texture with a new version.
struct Texture
{
  // What lies beyond [0, 1]; the numbers are the shared source's.
  enum class Wrap : std::uint8_t
  {
    ClampToEdge = 0,
    Repeat = 1,
    MirroredRepeat = 2,
    ClampToBorder = 3
  };
  // What opacities the texels have.
  enum class Alpha : std::uint8_t
  {
    Opaque,
    Holes, // some have none at all, the others are opaque
    Mixed
  };

  std::uint64_t version = 0; // unique over the process' life, never 0 for a real texture
  int width = 0;
  int height = 0;
  // width x height, row by row from t = 0 on; one of the two is filled. Floats are of colours that
  // bytes do not hold: wider than eight bits, or stored as sRGB and decoded.
  std::vector<glm::u8vec4> bytes;
  std::vector<glm::vec4> floats;
  Wrap wrap = Wrap::Repeat;
  bool linear = false; // the four nearest texels interpolated; else the nearest one
  glm::vec4 border{ 0.0f };
  Alpha alpha = Alpha::Opaque; // of the texels, the border among them where it can be seen

  std::size_t texelCount() const { return static_cast<std::size_t>(width) * height; }
};

// How a texture goes with those before it; the numbers are the shared source's.
enum class TextureBlend : std::uint8_t
{
  None = 0, // the first replaces nothing; of others, VTK's word for one that is left out
  Replace = 1,
  Modulate = 2,
  Add = 3,
  AddSigned = 4,
  Subtract = 5
};

struct TextureLayer
{
  std::shared_ptr<const Texture> texture; // never null
  TextureBlend blend = TextureBlend::None;

  bool operator==(const TextureLayer& o) const
  {
    return texture->version == o.texture->version && blend == o.blend;
  }
};

// The textures of a surface: they multiply its shaded colour.
struct Textures
{
  std::vector<TextureLayer> layers;
  Texture::Alpha alpha = Texture::Alpha::Opaque; // of all together
  bool onBack = true; // on the back side too
  // (s, t, 0, 1) of a corner becomes (x / w, y / w): the rows x, y, w over (s, t, 1).
  bool transformed = false;
  glm::vec3 transformX{ 1, 0, 0 }, transformY{ 0, 1, 0 }, transformW{ 0, 0, 1 };

  bool operator==(const Textures& o) const
  {
    return layers == o.layers && alpha == o.alpha && onBack == o.onBack && transformed == o.transformed &&
      transformX == o.transformX && transformY == o.transformY && transformW == o.transformW;
  }
};

} // namespace hrt
