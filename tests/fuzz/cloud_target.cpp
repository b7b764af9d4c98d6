/// The entry point of libFuzzer; VINEROW_CLOUD_KIND is set for each target.

#include "tests/fuzz/read_cloud_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vinerow::fuzz::read_cloud_bytes(vinerow::fuzz::CloudKind::VINEROW_CLOUD_KIND, {data, size});
  return 0;
}
