#pragma once
/// CRC-16/MCRF4XX, the check of MAVLink frames (X.25 without the final complement).

#include <cstdint>
#include <span>
#include <string_view>

namespace vinerow::mavlink {

class Crc16 {
 public:
  /// Polynomial x^16 + x^12 + x^5 + 1, least significant bit first.
  constexpr void add(std::uint8_t byte) {
    auto shifted = static_cast<std::uint8_t>(byte ^ (value_ & 0xFF));
    shifted = static_cast<std::uint8_t>(shifted ^ (shifted << 4));
    value_ = static_cast<std::uint16_t>((value_ >> 8) ^ (shifted << 8) ^ (shifted << 3) ^
                                        (shifted >> 4));
  }
  constexpr void add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint8_t>(c));
  }
  constexpr void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) add(byte);
  }
  constexpr std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_ = 0xFFFF;
};

}  // namespace vinerow::mavlink
