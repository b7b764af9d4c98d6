#include "engine/record/crc32.h"

#include <zlib.h>

namespace vinerow::record {

std::uint32_t calc_crc32(std::span<const std::uint8_t> bytes, std::uint32_t before) {
  // zlib takes a null pointer, which an empty span may have, as a request for the initial value.
  if (bytes.empty()) return before;
  return static_cast<std::uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace vinerow::record
