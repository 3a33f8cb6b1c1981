// Some thousand damaged scenes, the same ones in every run: each is read or refused with its place,
// and nothing else happens. What a fuzzer finds beyond this becomes a seed of the corpus, and with
// it a part of this test.
#include "BARTTest.h"

#include "Testing/Fuzz/BARTFuzzer.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace
{

constexpr int kMutationsOfEachSeed = 1000;
constexpr int kMostDamages = 6;

const char* const kNastyWords[] = { "nan", "-inf", "1e999", "-1", "0", "4294967296",
  "18446744073709551615", "99999999999", "0x10", "1e-320", "{", "}", "%", "x a {", "k camera {",
  "m", "tpa", "vertices", "i 0 part.aff", "i 0 main.aff", "1e18", "-1e18", "\xff", "." };

std::vector<std::string> seeds()
{
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(HRT_FUZZ_CORPUS))
  {
    paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const std::string& path : paths)
  {
    std::ifstream stream(path, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

// The distributions of the standard library differ from one to the next; the generator does not.
class Damage
{
public:
  explicit Damage(unsigned seed)
    : Random(seed)
  {
  }

  void apply(std::string& text)
  {
    const std::size_t at = this->below(text.size() + 1), length = this->below(12) + 1;
    switch (this->below(5))
    {
      case 0:
        if (at < text.size())
        {
          text[at] = static_cast<char>(this->below(256));
        }
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(this->below(text.size() + 1), 4 * length));
        break;
      case 3:
        text.resize(this->below(8) == 0 ? at : text.size());
        break;
      default:
        this->replaceWord(text, at);
        break;
    }
  }

  std::size_t below(std::size_t end) { return end == 0 ? 0 : this->Random() % end; }

private:
  void replaceWord(std::string& text, std::size_t from)
  {
    const std::size_t begin = text.find_first_not_of(" \n", from);
    if (begin != std::string::npos)
    {
      const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
      text.replace(begin, end - begin, kNastyWords[this->below(std::size(kNastyWords))]);
    }
  }

  std::mt19937 Random;
};

} // anonymous namespace

TEST(Mutations, SeedsThemselvesAreReadOrRefused)
{
  const std::vector<std::string> texts = seeds();
  ASSERT_GE(texts.size(), 4u);
  EXPECT_TRUE(std::any_of(texts.begin(), texts.end(), hrt::bart::readFuzzed));
}

TEST(Mutations, DamagedScenesAreReadOrRefused)
{
  int read = 0, refused = 0;
  unsigned number = 0;
  for (const std::string& seed : seeds())
  {
    for (int i = 0; i < kMutationsOfEachSeed; ++i)
    {
      Damage damage(++number);
      std::string text = seed;
      const std::size_t damages = 1 + damage.below(kMostDamages);
      for (std::size_t k = 0; k < damages; ++k)
      {
        damage.apply(text);
      }
      ++(hrt::bart::readFuzzed(text) ? read : refused);
    }
  }
  // Neither so damaged that the first words fail, nor so little that nothing does.
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 1000);
}

TEST(Mutations, EveryTruncationIsReadOrRefused)
{
  for (const std::string& seed : seeds())
  {
    for (std::size_t length = 0; length <= seed.size(); ++length)
    {
      hrt::bart::readFuzzed(std::string_view(seed).substr(0, length));
    }
  }
}
