// The libFuzzer target of the AFF parser: see Documentation/fuzzing.md.
#include "Testing/Fuzz/BARTFuzzer.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  hrt::bart::readFuzzed({ reinterpret_cast<const char*>(data), size });
  return 0;
}
