// Reads numbers off a fuzzer's input. Past its end everything is zero, so that every input, however
// short, means something, and longer ones only add to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hrt
{
namespace fuzz
{

class Bytes
{
public:
  Bytes(const std::uint8_t* data, std::size_t size)
    : Data(data)
    , Left(size)
  {
  }

  bool empty() const { return this->Left == 0; }

  template <class Value>
  Value take()
  {
    Value value{};
    const std::size_t size = this->Left < sizeof value ? this->Left : sizeof value;
    std::memcpy(&value, this->Data, size);
    this->Data += size;
    this->Left -= size;
    return value;
  }

  unsigned int byte() { return this->take<std::uint8_t>(); }
  unsigned int below(unsigned int n) { return this->byte() % n; }

  // Mostly small round numbers, of which meshes with shared corners and exact ties are made; now and
  // then any bits.
  double number()
  {
    const unsigned int kind = this->byte();
    if (kind < 224)
    {
      return (double(kind) - 112.0) / 16.0;
    }
    return kind < 240 ? double(this->take<float>()) : this->take<double>();
  }

private:
  const std::uint8_t* Data;
  std::size_t Left;
};

} // namespace fuzz
} // namespace hrt
