#pragma once
/// CRC-32 of MCAP, zip and PNG (ISO 3309).

#include <cstdint>
#include <span>

namespace vinerow::record {

/// @param before  CRC of the bytes that precede these
std::uint32_t calc_crc32(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace vinerow::record
