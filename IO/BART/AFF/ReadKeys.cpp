// Implements AFF's key frames and its animated triangle, the two commands that hold tables by time.
#include "IO/BART/AFF/Commands.h"

namespace hrt
{
namespace bart
{
namespace
{

// Words in a row of each kind of key.
constexpr std::size_t kVectorKeyWords = 7;
constexpr std::size_t kRotationKeyWords = 8;
constexpr std::size_t kVisibilityKeyWords = 2;
// A time, and a position and a normal for each of three corners.
constexpr std::size_t kAnimatedTriangleWords = 1 + 3 * 6;

//------------------------------------------------------------------------------
KeyShape readShape(Lexer& lexer)
{
  KeyShape shape;
  shape.tension = lexer.number("the tension of a key");
  shape.continuity = lexer.number("the continuity of a key");
  shape.bias = lexer.number("the bias of a key");
  return shape;
}

//------------------------------------------------------------------------------
std::vector<VectorKey> readVectorKeys(Lexer& lexer)
{
  std::vector<VectorKey> keys(lexer.count(kFewestKeys, kVectorKeyWords, "the number of keys"));
  for (VectorKey& key : keys)
  {
    key.time = lexer.number("the time of a key");
    key.value = lexer.vector("the value of a key");
    key.shape = readShape(lexer);
  }
  return keys;
}

//------------------------------------------------------------------------------
std::vector<RotationKey> readRotationKeys(Lexer& lexer)
{
  std::vector<RotationKey> keys(lexer.count(kFewestKeys, kRotationKeyWords, "the number of keys"));
  for (RotationKey& key : keys)
  {
    key.time = lexer.number("the time of a key");
    key.value = readRotation(lexer);
    key.shape = readShape(lexer);
  }
  return keys;
}

//------------------------------------------------------------------------------
std::vector<VisibilityKey> readVisibilityKeys(Lexer& lexer)
{
  std::vector<VisibilityKey> keys(lexer.count(1, kVisibilityKeyWords, "the number of keys"));
  for (VisibilityKey& key : keys)
  {
    key.time = lexer.number("the time of a key");
    key.visible = lexer.integer(0, 1, "a visibility") == 1;
  }
  return keys;
}

//------------------------------------------------------------------------------
void refuseSecond(Lexer& lexer, bool present, const std::string& kind)
{
  if (present)
  {
    lexer.fail("expected '" + kind + "' once at most for one name");
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
Animation readKeys(Lexer& lexer)
{
  Animation animation;
  animation.name = lexer.word("the name of what the keys move");
  lexer.keyword("{");
  for (;;)
  {
    const std::string_view kind = lexer.next();
    if (kind == "}")
    {
      return animation;
    }
    if (kind == "transl")
    {
      refuseSecond(lexer, animation.translation.has_value(), "transl");
      animation.translation.emplace(readVectorKeys(lexer));
    }
    else if (kind == "rot")
    {
      refuseSecond(lexer, animation.rotation.has_value(), "rot");
      animation.rotation.emplace(readRotationKeys(lexer));
    }
    else if (kind == "scale")
    {
      refuseSecond(lexer, animation.scale.has_value(), "scale");
      animation.scale.emplace(readVectorKeys(lexer));
    }
    else if (kind == "visibility")
    {
      refuseSecond(lexer, animation.visibility.has_value(), "visibility");
      animation.visibility.emplace(readVisibilityKeys(lexer));
    }
    else
    {
      lexer.failExpecting("'transl', 'rot', 'scale', 'visibility' or '}'");
    }
  }
}

//------------------------------------------------------------------------------
AnimatedTriangle readAnimatedTriangle(Lexer& lexer)
{
  AnimatedTriangle triangle;
  const std::size_t times =
    lexer.count(1, kAnimatedTriangleWords, "the number of times of a triangle");
  triangle.times.reserve(times);
  triangle.corners.resize(times);
  for (AnimatedTriangle::Corners& corners : triangle.corners)
  {
    triangle.times.push_back(lexer.number("a time of a triangle"));
    if (triangle.times.size() > 1 && triangle.times.back() < *(triangle.times.end() - 2))
    {
      lexer.failExpecting("a time that is not before the one above it");
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
      corners.positions[i] = glm::vec3(lexer.vector("a corner of a triangle"));
      corners.normals[i] = glm::vec3(lexer.vector("a normal of a triangle"));
    }
  }
  return triangle;
}

} // namespace bart
} // namespace hrt
