#include "engine/record/crc32.h"

#include <libdeflate.h>

namespace vinerow::record {

std::uint32_t calc_crc32(std::span<const std::uint8_t> bytes, std::uint32_t before) {
  // A null pointer, which an empty span may have, asks the library for the initial value.
  if (bytes.empty()) return before;
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

}  // namespace vinerow::record
