// What is refused, and that the message says where and what was expected.
#include "BARTTest.h"

using namespace hrt::bart;

namespace
{

struct Wrong
{
  const char* text;
  int line;
  const char* message; // a part of it
};

const char* const kView = "v\nfrom 0 0 1\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 9 9\n";

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  return text.replace(text.find(what), what.size(), by);
}

} // anonymous namespace

TEST(Errors, NameFileLineAndWhatWasExpected)
{
  const Wrong wrongs[] = {
    { "\n\nquux 1 2 3", 3, "expected a command (a am b " },
    { "{", 1, "expected a command" },
    { "s 0 0 0", 1, "expected the sphere's radius (a number), found the end of the file" },
    { "s 0 0 zero 1", 1, "expected the sphere's centre (a number), found 'zero'" },
    { "s 0 0\n0\n1x", 3, "found '1x'" },
    { "s 0 0 0 nan", 1,
      "expected the sphere's radius (a number from -1e+18 to 1e+18), found 'nan'" },
    { "s 0 0 0 inf", 1, "found 'inf'" },
    { "s 0 0 0 1e400", 1, "found '1e400'" },
    { "s 0 0 0 2e18", 1, "a number from -1e+18 to 1e+18" },
    { "s 0 0 0 0", 1, "radius other than 0" },
    { "s 0 0 0 {", 1, "found '{'" },
    { "c 0 0 0 1 0 0 0 1", 1, "apex away from its base" },
    { "c 0 0 0 0 0 0 1 0", 1, "not both 0" },
    { "c 0 0 0 -1 0 0 1 1", 1, "either both negative or none" },
    { "l 0 0", 1, "the light's place" },
    { "l 0 0 0 1 1", 1, "the light's colour" },
    { "la { 0 0 0", 1, "the name of a light" },
    { "b 1 2", 1, "the background's colour" },
    { "am 1 2 x", 1, "the ambient light's colour" },
    { "fm 1 1 1 1 1 1 1 1 1 1 0", 1, "the index of refraction" },
    { "f 1 1 1 1 1 1 0", 1, "the index of refraction" },
    { "a 5 4 10", 1, "the time of the last frame (a number from 5 to" },
    { "a 0 1 0", 1, "the number of frames (a whole number from 1 to" },
    { "a 0 1 2.5", 1, "found '2.5'" },
    { "p 2 0 0 0 1 0 0", 1, "the number of corners (a whole number, at least 3)" },
    { "p -3", 1, "the number of corners" },
    { "p 4294967299 0 0 0", 1, "cannot hold that many" },
    { "p 99999999999999999999999 0 0 0", 1, "the number of corners" },
    { "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0", 1, "cannot hold that many" },
    { "tt", 1, "the name of a texture" },
    { "tt a.ppm 0 0 0 0", 1, "a texture coordinate" },
    { "tpa 0", 1, "the number of times of a triangle" },
    { "tpa 2 1  0 0 0 0 0 1  0 0 0 0 0 1  0 0 0 0 0 1\n0 0 0 0 0 0 1  0 0 0 0 0 1  0 0 0 0 0 1", 2,
      "a time that is not before the one above it" },
    { "m triangles 1", 1, "expected 'vertices', found 'triangles'" },
    { "m vertices 1000000000 0 0 0", 1, "the number of vertices is '1000000000', but the rest" },
    { "m vertices 1 0 0 0 texturecoords 1 a.ppm 0 0 normals 1", 1, "in this order" },
    { "m vertices 3 0 0 0 1 0 0 0 1 0 triangles 1\n0 1 3", 2,
      "a vertex's index (a whole number from 0 to 2), found '3'" },
    { "m vertices 3 0 0 0 1 0 0 0 1 0 triangles 1\n0 1 -1", 2, "a vertex's index" },
    { "m vertices 3 0 0 0 1 0 0 0 1 0 normals 1 0 0 1 triangles 1 0 1 2 0 0 1", 1,
      "a normal's index (a whole number from 0 to 0)" },
    { "m vertices 3 0 0 0 1 0 0 0 1 0 texturecoords 1 a.ppm 0 0 triangles 1 0 1 2 0 0 1", 1,
      "a texture coordinate's index" },
    { "m vertices 3 0 0 0 1 0 0 0 1 0 triangles 0", 1, "the number of triangles" },
    { "x { }", 1, "the name of a transform" },
    { "x a\ns 0 0 0 1", 2, "expected '{', found 's'" },
    { "xs 1 1 1 0 0 0 90 0 0 0 { }", 1, "an axis other than 0 0 0" },
    { "xs 1 1 1 0 0 1 90 0 0 { }", 1, "the translation of a transform" },
    { "x a {\n\n", 1, "this '{' is not closed in its file" },
    { "x a { }\n}", 2, "closes nothing" },
    { "k a { turn 4", 1, "'transl', 'rot', 'scale', 'visibility' or '}', found 'turn'" },
    { "k a { transl 3", 1, "the number of keys (a whole number, at least 4)" },
    { "k a { transl 4 0 0 0 0 0 0 0", 1, "cannot hold that many" },
    { "k a { visibility 1 0 2 }", 1, "a visibility (a whole number from 0 to 1)" },
    { "k a { visibility 1 0 1\nvisibility 1 0 1 }", 2, "'visibility' once at most" },
    { "k a { rot 4 0 0 0 0 5 0 0 0  0 0 0 1 5 0 0 0  1 0 0 1 5 0 0 0  1 0 0 1 5 0 0 0 }", 1,
      "an axis other than 0 0 0" },
    { "k a {", 1, "found the end of the file" },
    { "i 0", 1, "the name of a file to include" },
    { "i high a.aff", 1, "the level of detail of an included file" },
    { "\ni 0 absent.aff", 2, "the included file 'absent.aff' is not an existing file" },
    { "i 0 main.aff", 1, "the included file 'main.aff' includes itself" },
    { "d", 1, "the level of detail" },
    { "s 0 0 0 \x01\x80zzz", 1, "found '??zzz'" },
  };
  for (const Wrong& wrong : wrongs)
  {
    const std::string message = refusal(wrong.text);
    const std::string place = "main.aff:" + std::to_string(wrong.line) + ": ";
    EXPECT_EQ(message.substr(0, place.size()), place) << wrong.text << "\ngave " << message;
    EXPECT_NE(message.find(wrong.message), std::string::npos)
      << wrong.text << "\ngave " << message << "\nnot  " << wrong.message;
  }
}

TEST(Errors, AViewMustBeWholeAndPossible)
{
  EXPECT_EQ(refusal(kView), "");
  const Wrong wrongs[] = {
    { "from", 2, "expected 'from'" },
    { "angle 30", 5, "expected 'angle'" },
    { "resolution 9 9", 7, "expected 'resolution'" },
  };
  for (const Wrong& wrong : wrongs)
  {
    const std::string message = refusal(replaced(kView, wrong.text, "z"));
    EXPECT_NE(message.find("main.aff:" + std::to_string(wrong.line)), std::string::npos) << message;
    EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
  }
  for (const char* angle : { "angle 0", "angle 180", "angle -5" })
  {
    EXPECT_NE(refusal(replaced(kView, "angle 30", angle)).find("main.aff:5"), std::string::npos);
  }
  EXPECT_NE(
    refusal(replaced(kView, "hither 1", "hither -1")).find("main.aff:6"), std::string::npos);
  EXPECT_NE(refusal(replaced(kView, "9 9", "9 0")).find("the picture's height"), std::string::npos);
  EXPECT_NE(refusal(replaced(kView, "up 0 1 0", "up 0 0 5")).find("main.aff:4"), std::string::npos);
}

TEST(Errors, NameTheIncludedFile)
{
  MemoryFiles files;
  files.files["main.aff"] = "x a {\n i 0 part.aff\n}";
  files.files["part.aff"] = "s 0 0 0 1\n}";
  EXPECT_EQ(refusal(files).rfind("part.aff:2: this '}' closes nothing", 0), 0u) << refusal(files);
  files.files["part.aff"] = "x b {\n";
  EXPECT_EQ(refusal(files).rfind("part.aff:1: this '{' is not closed", 0), 0u) << refusal(files);
  files.files["part.aff"] = "s 0 0 0 1 i 0 main.aff";
  EXPECT_EQ(
    refusal(files).rfind("part.aff:1: the included file 'main.aff' includes itself", 0), 0u);
}

TEST(Errors, AFileThatIsAbsentHasNoLine)
{
  EXPECT_EQ(refusal(MemoryFiles()), "main.aff: is not an existing file");
  DiskFiles disk;
  EXPECT_THROW(readScene(HRT_TEST_DATA, disk), ReadError) << "a folder";
  EXPECT_THROW(readScene(HRT_TEST_DATA "/absent.aff", disk), ReadError);
}

TEST(Errors, IncludesMayNotDoubleOverAndOver)
{
  // Thirty files, each including the next one twice: a billion spheres.
  MemoryFiles files;
  const auto name = [](int i) { return i == 0 ? "main.aff" : std::to_string(i) + ".aff"; };
  for (int i = 0; i < 30; ++i)
  {
    files.files[name(i)] = "i 0 " + name(i + 1) + " i 0 " + name(i + 1);
  }
  files.files[name(30)] = "s 0 0 0 1";
  Limits limits;
  limits.includes = 1000;
  EXPECT_NE(refusal(files, limits).find("too many files"), std::string::npos);
  limits = Limits();
  limits.instances = 1000;
  EXPECT_NE(refusal(files, limits).find("more than 1000 surfaces"), std::string::npos);
  limits = Limits();
  limits.bytes = 10000;
  EXPECT_NE(refusal(files, limits).find("larger than 10000 bytes"), std::string::npos);
  limits = Limits();
  limits.includeDepth = 10;
  EXPECT_NE(refusal(files, limits).find("too deeply"), std::string::npos);
}

TEST(Errors, BracesMayNotNestWithoutEnd)
{
  std::string text;
  for (int i = 0; i < 1001; ++i)
  {
    text += "x a {\n";
  }
  EXPECT_EQ(
    refusal(text).rfind("main.aff:1001: more than 1000 transforms inside each other", 0), 0u)
    << refusal(text);
}

TEST(Errors, AFileTooLargeForTheSceneIsNotRead)
{
  MemoryFiles files;
  files.files["main.aff"] = std::string(100, ' ');
  Limits limits;
  limits.bytes = 99;
  EXPECT_NE(refusal(files, limits).find("has 100 bytes"), std::string::npos);
}
