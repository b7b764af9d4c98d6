/// The entry point of libFuzzer for live runs.

#include "tests/fuzz/read_live_frames.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vinerow::fuzz::read_live_frames({data, size});
  return 0;
}
