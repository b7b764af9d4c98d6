/// The entry point of libFuzzer for autopilots.

#include "tests/fuzz/read_autopilot_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vinerow::fuzz::read_autopilot_bytes({data, size});
  return 0;
}
