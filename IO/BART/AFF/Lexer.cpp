// Implements the words and numbers of AFF. Numbers are read without the user's locale, in which a
// decimal point may be a comma.
#include "IO/BART/AFF/Lexer.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

namespace hrt
{
namespace bart
{
namespace
{

constexpr std::size_t kLongestQuote = 40;

bool isBlank(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

bool isBrace(char c)
{
  return c == '{' || c == '}';
}

bool beginsComment(char c)
{
  return c == '%' || c == '#';
}

bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

// C and scanf allow a plus sign, from_chars does not.
std::string_view withoutPlus(std::string_view word)
{
  const bool plus = word.size() > 1 && word[0] == '+' && (isDigit(word[1]) || word[1] == '.');
  return plus ? word.substr(1) : word;
}

//------------------------------------------------------------------------------
// False unless the whole word is a number that fits.
template <typename T>
bool convert(std::string_view word, T& value)
{
  word = withoutPlus(word);
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end && !word.empty();
}

#ifndef __cpp_lib_to_chars
// A standard library without from_chars for floating point.
template <>
bool convert(std::string_view word, double& value)
{
  std::istringstream stream{ std::string(withoutPlus(word)) };
  stream.imbue(std::locale::classic());
  return stream >> value && stream.eof();
}
#endif

} // anonymous namespace

//------------------------------------------------------------------------------
std::string inQuotes(std::string_view word)
{
  std::string text = "'";
  for (char c : word.substr(0, kLongestQuote))
  {
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text + (word.size() > kLongestQuote ? "...'" : "'");
}

//------------------------------------------------------------------------------
Lexer::Lexer(std::string path, std::string_view text)
  : Path(std::move(path))
  , Text(text)
{
}

//------------------------------------------------------------------------------
void Lexer::skipBlanks()
{
  bool comment = false;
  for (; this->Offset < this->Text.size(); ++this->Offset)
  {
    const char c = this->Text[this->Offset];
    // A lone carriage return ends no line: the files' lines end with both or with a line feed.
    this->Line += c == '\n' ? 1 : 0;
    comment = c != '\n' && (comment || beginsComment(c));
    if (!comment && !isBlank(c))
    {
      return;
    }
  }
}

//------------------------------------------------------------------------------
std::string_view Lexer::peek()
{
  this->skipBlanks();
  const std::string_view rest = this->Text.substr(this->Offset);
  std::size_t length = rest.empty() || !isBrace(rest[0]) ? 0 : 1;
  while (length < rest.size() && !isBrace(rest[0]) && !isBrace(rest[length]) &&
    !isBlank(rest[length]) && !beginsComment(rest[length]))
  {
    ++length;
  }
  return rest.substr(0, length);
}

//------------------------------------------------------------------------------
std::string_view Lexer::next()
{
  this->Word = this->peek();
  this->WordLine = this->Line;
  this->Offset += this->Word.size();
  return this->Word;
}

//------------------------------------------------------------------------------
Lexer::Position Lexer::position()
{
  this->skipBlanks();
  return { this->Offset, this->Line };
}

//------------------------------------------------------------------------------
void Lexer::jump(const Position& position)
{
  this->Offset = position.offset;
  this->Line = position.line;
}

//------------------------------------------------------------------------------
void Lexer::fail(const std::string& what) const
{
  throw ReadError(this->location(), what);
}

//------------------------------------------------------------------------------
void Lexer::failExpecting(const std::string& expected) const
{
  this->fail("expected " + expected + ", found " +
    (this->Word.empty() ? std::string("the end of the file") : inQuotes(this->Word)));
}

//------------------------------------------------------------------------------
std::string Lexer::word(const char* expected)
{
  const std::string_view word = this->next();
  if (word.empty() || isBrace(word[0]))
  {
    this->failExpecting(expected);
  }
  return std::string(word);
}

//------------------------------------------------------------------------------
void Lexer::keyword(const char* expected)
{
  if (this->next() != expected)
  {
    this->failExpecting(inQuotes(expected));
  }
}

//------------------------------------------------------------------------------
double Lexer::number(const char* expected)
{
  return this->numberBetween(-kLargestNumber, kLargestNumber, expected);
}

//------------------------------------------------------------------------------
double Lexer::numberBetween(double least, double most, const char* expected)
{
  double value = 0.0;
  if (!convert(this->next(), value))
  {
    this->failExpecting(std::string(expected) + " (a number)");
  }
  // Written so that NaN, which fails every comparison, is refused too.
  if (!(value >= least && value <= most))
  {
    std::ostringstream range;
    range << expected << " (a number from " << least << " to " << most << ")";
    this->failExpecting(range.str());
  }
  return value;
}

//------------------------------------------------------------------------------
int Lexer::integer(long long least, long long most, const char* expected)
{
  long long value = 0;
  if (!convert(this->next(), value) || value < least || value > most)
  {
    this->failExpecting(std::string(expected) + " (a whole number from " + std::to_string(least) +
      " to " + std::to_string(most) + ")");
  }
  return static_cast<int>(value);
}

//------------------------------------------------------------------------------
glm::dvec3 Lexer::vector(const char* expected)
{
  // One after the other: the order of a call's arguments is not defined.
  const double x = this->number(expected);
  const double y = this->number(expected);
  const double z = this->number(expected);
  return { x, y, z };
}

//------------------------------------------------------------------------------
glm::dvec2 Lexer::pair(const char* expected)
{
  const double x = this->number(expected);
  const double y = this->number(expected);
  return { x, y };
}

//------------------------------------------------------------------------------
std::size_t Lexer::count(std::size_t least, std::size_t wordsEach, const char* expected)
{
  unsigned long long value = 0;
  if (!convert(this->next(), value) || value < least)
  {
    this->failExpecting(
      std::string(expected) + " (a whole number, at least " + std::to_string(least) + ")");
  }
  // A word takes a letter and a blank before it.
  const std::size_t rest = this->Text.size() - this->Offset;
  if (value > rest / (2 * wordsEach))
  {
    this->fail(std::string(expected) + " is " + inQuotes(this->Word) +
      ", but the rest of the file cannot hold that many");
  }
  return static_cast<std::size_t>(value);
}

//------------------------------------------------------------------------------
bool Lexer::numberFollows()
{
  const std::string_view word = this->peek();
  const char first = word.empty() ? ' ' : word[0];
  return isDigit(first) || first == '+' || first == '-' || first == '.';
}

} // namespace bart
} // namespace hrt
