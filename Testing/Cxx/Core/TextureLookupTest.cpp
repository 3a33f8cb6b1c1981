// Looking textures up: the shared source against OpenGL's rules written down another way, and values
// known by hand.
#include "Rendering/Core/Surface/SurfaceColors.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace hrt;
using Wrap = Texture::Wrap;

constexpr Wrap kWraps[] = { Wrap::ClampToEdge, Wrap::Repeat, Wrap::MirroredRepeat,
  Wrap::ClampToBorder };

std::shared_ptr<Texture> makeTexture(int width, int height, std::uint32_t seed = 1)
{
  static std::uint64_t version = 0;
  auto texture = std::make_shared<Texture>();
  texture->version = ++version;
  texture->width = width;
  texture->height = height;
  scenes::Random random(seed);
  for (int i = 0; i < width * height; ++i)
  {
    const auto byte = [&random] { return static_cast<std::uint8_t>(random.below(256)); };
    const std::uint8_t r = byte(), g = byte(), b = byte();
    texture->bytes.emplace_back(r, g, b, byte());
  }
  return texture;
}

// A triangle whose (u, v) are its texture coordinates, and whose part shows the textures.
struct Card
{
  Part part;
  explicit Card(std::vector<TextureLayer> layers)
  {
    auto geometry = scenes::makeGeometry({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
    geometry->textureCoordinates.values = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    this->part.geometry = geometry;
    this->part.material.textures.layers = std::move(layers);
  }
  glm::vec4 at(float u, float v, bool front = true) const
  {
    return shading::SurfaceColors(this->part, 0, 0).textureColor(u, v, front);
  }
};

glm::vec4 look(std::shared_ptr<Texture> texture, float s, float t)
{
  return Card({ { texture, TextureBlend::None } }).at(s, t);
}

// OpenGL 3.2 core, section 3.8.7: the coordinate is wrapped before it becomes texels.
double wrapped(double s, Wrap wrap, int size)
{
  const double least = 1.0 / (2 * size);
  switch (wrap)
  {
    case Wrap::ClampToEdge:
      return std::clamp(s, least, 1.0 - least);
    case Wrap::Repeat:
      return s - std::floor(s);
    case Wrap::MirroredRepeat:
    {
      const double whole = std::floor(s), rest = s - whole;
      return std::fmod(whole, 2.0) == 0.0 ? rest : 1.0 - rest;
    }
    default:
      return std::clamp(s, -least, 1.0 + least);
  }
}

glm::dvec4 texelOf(const Texture& texture, int x, int y)
{
  if (texture.wrap == Wrap::Repeat)
  {
    x = (x + texture.width) % texture.width;
    y = (y + texture.height) % texture.height;
  }
  if (texture.wrap == Wrap::MirroredRepeat)
  {
    x = std::clamp(x, 0, texture.width - 1); // what is mirrored goes on with its last texel
    y = std::clamp(y, 0, texture.height - 1);
  }
  if (x < 0 || y < 0 || x >= texture.width || y >= texture.height)
  {
    return texture.border;
  }
  return glm::dvec4(texture.bytes[std::size_t(y) * texture.width + x]) / 255.0;
}

glm::dvec4 expected(const Texture& texture, double s, double t)
{
  const double x = wrapped(s, texture.wrap, texture.width) * texture.width;
  const double y = wrapped(t, texture.wrap, texture.height) * texture.height;
  if (!texture.linear)
  {
    return texelOf(texture, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
  }
  const int i = static_cast<int>(std::floor(x - 0.5)), j = static_cast<int>(std::floor(y - 0.5));
  const double a = x - 0.5 - i, b = y - 0.5 - j;
  return (1 - a) * (1 - b) * texelOf(texture, i, j) + a * (1 - b) * texelOf(texture, i + 1, j) +
    (1 - a) * b * texelOf(texture, i, j + 1) + a * b * texelOf(texture, i + 1, j + 1);
}

// Whether the coordinate is so near a border between texels that a rounding decides.
bool undecided(double s, int size, bool linear)
{
  const double x = s * size - (linear ? 0.5 : 0.0);
  return !linear && std::abs(x - std::round(x)) < 1e-4;
}

TEST(TextureLookup, FollowsOpenGL)
{
  for (const Wrap wrap : kWraps)
  {
    for (const bool linear : { false, true })
    {
      auto texture = makeTexture(5, 3);
      texture->wrap = wrap;
      texture->linear = linear;
      texture->border = { 0.1f, 0.2f, 0.3f, 0.4f };
      const Card card({ { texture, TextureBlend::None } });
      scenes::Random random(7);
      for (int i = 0; i < 20000; ++i)
      {
        const auto s = static_cast<float>(random(-3.5, 3.5));
        const auto t = static_cast<float>(random(-3.5, 3.5));
        if (undecided(s, 5, linear) || undecided(t, 3, linear))
        {
          continue;
        }
        const glm::dvec4 error = glm::abs(glm::dvec4(card.at(s, t)) - expected(*texture, s, t));
        // Coordinates up to 3.5 times 5 texels are off by a few roundings of 17; a texel's difference
        // to its neighbour is at most 1.
        const double bound = 64 * 17 * scenes::kFloatRounding;
        ASSERT_LT(std::max({ error.x, error.y, error.z, error.w }), bound)
          << "wrap " << int(wrap) << " linear " << linear << " at " << s << ", " << t;
      }
    }
  }
}

TEST(TextureLookup, NoCoordinateIsTooFar)
{
  for (const Wrap wrap : kWraps)
  {
    for (const bool linear : { false, true })
    {
      auto texture = makeTexture(4, 4);
      texture->wrap = wrap;
      texture->linear = linear;
      for (const float s : { 1e30f, -1e30f, std::numeric_limits<float>::max(), -1e-30f, 1.0f, 2.0f,
             16777216.0f, -0.0f })
      {
        const glm::vec4 c = Card({ { texture, TextureBlend::None } }).at(s, 0.25f);
        for (int k = 0; k < 4; ++k)
        {
          ASSERT_TRUE(c[k] >= 0.0f && c[k] <= 1.0f) << s;
        }
      }
    }
  }
}

TEST(TextureLookup, FloatsAreTakenAsTheyAre)
{
  auto texture = std::make_shared<Texture>();
  texture->version = 1;
  texture->width = 2;
  texture->height = 1;
  texture->floats = { { 4.0f, 0.0f, 0.5f, 1.0f }, { 0.0f, 2.0f, 0.5f, 0.0f } };
  EXPECT_EQ(look(texture, 0.25f, 0.5f), glm::vec4(4.0f, 0.0f, 0.5f, 1.0f));
  texture->linear = true;
  EXPECT_EQ(look(texture, 0.5f, 0.5f), glm::vec4(2.0f, 1.0f, 0.5f, 0.5f));
}

TEST(TextureLookup, BlendingIsVTKs)
{
  const auto plain = [](glm::u8vec4 color)
  {
    auto texture = makeTexture(1, 1);
    texture->bytes = { color };
    return texture;
  };
  const auto below = plain({ 255, 51, 0, 255 }), above = plain({ 51, 255, 0, 51 });
  const float a = 51.0f / 255.0f;
  const struct
  {
    TextureBlend blend;
    glm::vec4 color;
  } table[] = {
    { TextureBlend::None, { 1.0f, a, 0.0f, 1.0f } }, // left out
    { TextureBlend::Replace, { a * a + 1 - a, a + a * (1 - a), 0.0f, 1.0f } },
    { TextureBlend::Modulate, { a, a, 0.0f, a } },
    { TextureBlend::Add, { a * a + 1, a + a, 0.0f, 1 + a } },
    { TextureBlend::AddSigned, { a * a + 0.5f, a + a - 0.5f, -0.5f, 0.5f + a } },
    { TextureBlend::Subtract, { 1 - a * a, 0.0f, 0.0f, 1.0f } },
  };
  for (const auto& row : table)
  {
    const glm::vec4 c = Card({ { below, TextureBlend::None }, { above, row.blend } }).at(0.2f, 0.2f);
    const glm::vec4 error = glm::abs(c - row.color);
    EXPECT_LT(std::max({ error.x, error.y, error.z, error.w }), 1e-6f) << int(row.blend);
  }
}

TEST(TextureLookup, TheTransformIsOfTheCorners)
{
  auto texture = makeTexture(8, 8);
  Card plain({ { texture, TextureBlend::None } }), moved = plain;
  Textures& textures = moved.part.material.textures;
  textures.transformed = true;
  textures.transformX = { 0.0f, 1.0f, 0.25f }; // (s, t) -> (t + 1/4, 2 s)
  textures.transformY = { 2.0f, 0.0f, 0.0f };
  EXPECT_EQ(moved.at(0.2f, 0.3f), plain.at(0.55f, 0.4f));
  // Projective: halved at the corners; between them linear all the same.
  textures.transformW = { 0.0f, 0.0f, 2.0f };
  EXPECT_EQ(moved.at(0.2f, 0.3f), plain.at(0.275f, 0.2f));
}

TEST(TextureLookup, NoCoordinatesNoTexture)
{
  auto texture = makeTexture(8, 8);
  Card card({ { texture, TextureBlend::None } });
  EXPECT_NE(card.at(0.2f, 0.3f), glm::vec4(1.0f));
  EXPECT_NE(card.at(0.2f, 0.3f, false), glm::vec4(1.0f));
  card.part.material.textures.onBack = false;
  EXPECT_NE(card.at(0.2f, 0.3f), glm::vec4(1.0f));
  EXPECT_EQ(card.at(0.2f, 0.3f, false), glm::vec4(1.0f));
  auto bare = std::make_shared<Geometry>(*card.part.geometry);
  bare->textureCoordinates.values.clear();
  card.part.geometry = bare;
  EXPECT_EQ(card.at(0.2f, 0.3f), glm::vec4(1.0f));
}

} // namespace
