#pragma once
/// CRC-32 of MCAP: polynomial 0xEDB88320 reflected, start and end inverted (ISO 3309, also used by
/// zip and PNG).
///
/// Method: eight tables, eight bytes per iteration ("slicing by 8": Kounavis and Berry, "Novel
/// Table Lookup-Based Algorithms for High-Performance CRC Generation", IEEE Trans. Computers 57,
/// 2008).

#include <cstddef>
#include <cstdint>
#include <span>

namespace vinerow::record {

class Crc32 {
 public:
  void add(const void* data, std::size_t size);
  void add(std::span<const std::uint8_t> bytes) { add(bytes.data(), bytes.size()); }
  /// CRC of all bytes added so far.
  std::uint32_t value() const { return ~state_; }

 private:
  std::uint32_t state_ = 0xFFFFFFFFu;
};

std::uint32_t calc_crc32(std::span<const std::uint8_t> bytes);

}  // namespace vinerow::record
