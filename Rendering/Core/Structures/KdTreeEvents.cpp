// The one sort of the build, and the arena of the events' lists.
#include "Rendering/Core/Structures/KdTreeEvents.h"

#include <algorithm>
#include <array>

namespace hrt
{

namespace
{

// Position and kind are the upper 34 bits: three digits of 12 bits reach down to bit 28, two bits into
// the triangle's number. That does no harm, for lists are filled in the order of the triangles.
constexpr int kDigitBits = 12;
constexpr int kDigits = 3;
constexpr int kLowestBit = 64 - kDigits * kDigitBits;
constexpr std::size_t kDigitValues = std::size_t(1) << kDigitBits;
// Below, clearing and summing the histograms costs more than comparing.
constexpr std::size_t kRadixLeast = 2048;

std::size_t digitOf(KdEvent event, int digit)
{
  return (event >> (kLowestBit + digit * kDigitBits)) & (kDigitValues - 1);
}

using Histogram = std::array<std::uint32_t, kDigitValues>;

// Where each value's events go: counts become sums of the counts before.
void sumBefore(Histogram& histogram)
{
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : histogram)
  {
    const std::uint32_t count = entry;
    entry = sum;
    sum += count;
  }
}

} // namespace

void sortEvents(KdEventList& list, KdEvent* scratch)
{
  if (list.count < kRadixLeast)
  {
    std::sort(list.events, list.events + list.count);
    return;
  }
  std::vector<Histogram> histograms(kDigits);
  for (KdEvent event : list)
  {
    for (int digit = 0; digit < kDigits; ++digit)
    {
      ++histograms[digit][digitOf(event, digit)];
    }
  }
  KdEvent* from = list.events;
  KdEvent* to = scratch;
  for (int digit = 0; digit < kDigits; ++digit)
  {
    sumBefore(histograms[digit]);
    for (std::uint32_t i = 0; i < list.count; ++i)
    {
      to[histograms[digit][digitOf(from[i], digit)]++] = from[i];
    }
    std::swap(from, to);
  }
  if (from != list.events)
  {
    std::copy(from, from + list.count, list.events);
  }
}

void KdArena::nextBlock(std::size_t count)
{
  if (this->Block < this->Blocks.size())
  {
    ++this->Block;
  }
  if (this->Block < this->Blocks.size() && this->Blocks[this->Block].size < count)
  {
    // Nothing beyond the current block is in use.
    this->Blocks.resize(this->Block);
  }
  if (this->Block == this->Blocks.size())
  {
    const std::size_t size = std::max(count, kBlockSize);
    this->Blocks.push_back({ std::unique_ptr<KdEvent[]>(new KdEvent[size]), size });
  }
  this->Used = 0;
}

} // namespace hrt
