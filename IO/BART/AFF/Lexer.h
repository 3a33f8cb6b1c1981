// Cuts AFF text into words and numbers and knows the line of each, so that every complaint can say
// where and what was expected.
#pragma once

#include "IO/BART/AFF/Error.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace hrt
{
namespace bart
{

// Larger numbers do not fit the float coordinates that renderers square and add.
constexpr double kLargestNumber = 1e18;

// Words end at white space, at a brace and at a comment; a brace is a word of its own.
class Lexer
{
public:
  // The text must outlive the lexer.
  Lexer(std::string path, std::string_view text);

  const std::string& path() const { return this->Path; }
  // Of the word that was read last.
  Location location() const { return { this->Path, this->WordLine }; }

  // The next word, empty at the end of the text.
  std::string_view next();
  std::string_view peek();

  // Where the next word begins, and a jump to such a place: what is known already is not read
  // again.
  struct Position
  {
    std::size_t offset = 0;
    std::size_t line = 1;
  };
  Position position();
  void jump(const Position& position);

  // Each reads words and throws ReadError, naming what was expected, for anything else.
  std::string word(const char* expected);
  void keyword(const char* expected);
  double number(const char* expected);
  double numberBetween(double least, double most, const char* expected);
  int integer(long long least, long long most, const char* expected);
  glm::dvec3 vector(const char* expected);
  glm::dvec2 pair(const char* expected);
  // A number of items that follow, each of the given number of words. A count that the rest of the
  // text cannot hold is refused before anything is allocated for it.
  std::size_t count(std::size_t least, std::size_t wordsEach, const char* expected);
  bool numberFollows();

  [[noreturn]] void fail(const std::string& what) const;
  // Complains about the word that was read last.
  [[noreturn]] void failExpecting(const std::string& expected) const;

private:
  void skipBlanks();

  std::string Path;
  std::string_view Text;
  std::size_t Offset = 0;
  std::size_t Line = 1;
  std::string_view Word;
  std::size_t WordLine = 1;
};

// A word as it may be shown in a message: shortened, with what cannot be printed replaced.
std::string inQuotes(std::string_view word);

} // namespace bart
} // namespace hrt
