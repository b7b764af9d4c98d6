#pragma once
/// Datagram of ArduPilot's JSON interface to the physics: its servo outputs.
/// Source: ArduPilot 4.6.3, libraries/SITL/examples/JSON.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/core/result.h"

namespace vinerow::controllers {

/// u16 magic, u16 frame rate, u32 frame, u16 pwm[16 or 32], little-endian.
struct ServoPacket {
  static constexpr std::uint16_t kMagic16 = 18458;
  static constexpr std::uint16_t kMagic32 = 29569;

  std::uint16_t frame_rate_Hz = 0;  ///< as wanted; the time stamps of the answers decide
  std::uint32_t frame = 0;          ///< counts the packets; a repeated request keeps its number
  int channels = 0;                 ///< 16 or 32
  std::array<std::uint16_t, 32> pwm_us{};  ///< 0: the output has no function
};

/// @returns the packet, or one sentence about what is wrong with the bytes
Result<ServoPacket> parse_servo_packet(std::span<const std::uint8_t> bytes);

}  // namespace vinerow::controllers
