#include "controllers/autopilot/ardupilot/servo_packet.h"

#include <fmt/format.h>

namespace vinerow::controllers {
namespace {

constexpr std::size_t kHeader = 8;

std::uint16_t u16_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

}  // namespace

Result<ServoPacket> parse_servo_packet(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader) {
    return Failure{fmt::format("sent {} bytes, too few for a packet of servo outputs (40 or 72)",
                               bytes.size())};
  }
  const std::uint16_t magic = u16_at(bytes, 0);
  if (magic != ServoPacket::kMagic16 && magic != ServoPacket::kMagic32) {
    return Failure{fmt::format(
        "sent a packet that begins with {}, not with {} or {} as servo outputs of ArduPilot do",
        magic, ServoPacket::kMagic16, ServoPacket::kMagic32)};
  }
  ServoPacket packet;
  packet.channels = magic == ServoPacket::kMagic16 ? 16 : 32;
  const std::size_t size = kHeader + 2 * static_cast<std::size_t>(packet.channels);
  if (bytes.size() != size) {
    return Failure{fmt::format("sent {} bytes, but servo outputs with {} channels have {}",
                               bytes.size(), packet.channels, size)};
  }
  packet.frame_rate_Hz = u16_at(bytes, 2);
  packet.frame = u16_at(bytes, 4) | static_cast<std::uint32_t>(u16_at(bytes, 6)) << 16;
  for (int i = 0; i < packet.channels; ++i) {
    packet.pwm_us[i] = u16_at(bytes, kHeader + 2 * static_cast<std::size_t>(i));
  }
  return packet;
}

}  // namespace vinerow::controllers
