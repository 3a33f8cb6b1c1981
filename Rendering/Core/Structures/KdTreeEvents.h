// What the plane sweep runs over: where, along one axis, the boxes of triangles start and end. An
// event is one 64-bit number whose natural order is the order of the sweep, so that sorting, merging
// and comparing are integer operations on a compact array.
#pragma once

#include "Rendering/Core/Structures/KdTree.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace hrt
{

// At one place, what ends comes first, then what lies in the plane, then what starts (Wald and Havran
// 2006, section 4.2): so the counts on both sides are right when a plane is weighed.
enum class KdEventKind : std::uint32_t
{
  End = 0,
  Planar = 1,
  Start = 2
};

using KdEvent = std::uint64_t; // position (32 bits), kind (2), triangle (30)

// Floats as unsigned integers in the same order.
inline std::uint32_t orderedBits(float position)
{
  std::uint32_t bits;
  std::memcpy(&bits, &position, sizeof(bits));
  return bits ^ ((bits >> 31) ? ~0u : 0x80000000u);
}

inline float fromOrderedBits(std::uint32_t ordered)
{
  const std::uint32_t bits = ordered ^ ((ordered >> 31) ? 0x80000000u : ~0u);
  float position;
  std::memcpy(&position, &bits, sizeof(bits));
  return position;
}

inline KdEvent makeEvent(float position, KdEventKind kind, std::uint32_t triangle)
{
  return KdEvent(orderedBits(position)) << 32 | KdEvent(kind) << 30 | triangle;
}

inline float positionOf(KdEvent event) { return fromOrderedBits(std::uint32_t(event >> 32)); }
inline KdEventKind kindOf(KdEvent event) { return KdEventKind(std::uint32_t(event) >> 30); }
inline std::uint32_t triangleOf(KdEvent event) { return std::uint32_t(event) & 0x3fffffffu; }

// The least event at a position, the least start there, and the least event beyond it.
inline KdEvent firstEventAt(float position) { return KdEvent(orderedBits(position)) << 32; }
inline KdEvent firstStartAt(float position)
{
  return makeEvent(position, KdEventKind::Start, 0);
}
inline KdEvent firstEventAfter(float position)
{
  return (KdEvent(orderedBits(position)) + 1) << 32;
}

// Greater than every event: ends a list that is merged.
inline constexpr KdEvent kNoEvent = ~KdEvent(0);

struct KdEventList
{
  KdEvent* events = nullptr;
  std::uint32_t count = 0;

  const KdEvent* begin() const { return this->events; }
  const KdEvent* end() const { return this->events + this->count; }
  void add(float lower, float upper, std::uint32_t triangle)
  {
    if (lower == upper)
    {
      this->events[this->count++] = makeEvent(lower, KdEventKind::Planar, triangle);
      return;
    }
    this->events[this->count++] = makeEvent(lower, KdEventKind::Start, triangle);
    this->events[this->count++] = makeEvent(upper, KdEventKind::End, triangle);
  }
};

// Sorts a list by position and kind. Events that agree in both keep their order. `scratch` holds as
// many events as the list.
void sortEvents(KdEventList& list, KdEvent* scratch);

// Memory that is given back in the reverse order: a depth-first build asks for nothing else, and
// asking the heap for every node's lists would cost more than filling them.
class KdArena
{
public:
  struct Mark
  {
    std::size_t block, used;
  };
  Mark mark() const { return { this->Block, this->Used }; }
  void release(const Mark& mark)
  {
    this->Block = mark.block;
    this->Used = mark.used;
  }

  KdEvent* allocate(std::size_t count)
  {
    while (this->Block == this->Blocks.size() || this->Used + count > this->Blocks[this->Block].size)
    {
      this->nextBlock(count);
    }
    KdEvent* events = this->Blocks[this->Block].events.get() + this->Used;
    this->Used += count;
    return events;
  }

private:
  struct Block_
  {
    std::unique_ptr<KdEvent[]> events;
    std::size_t size;
  };
  void nextBlock(std::size_t count);

  static constexpr std::size_t kBlockSize = 1u << 15;
  std::vector<Block_> Blocks;
  std::size_t Block = 0;
  std::size_t Used = 0;
};

} // namespace hrt
