#pragma once
/// Identity of a DDS reader, writer or participant.

#include <array>
#include <cstdint>

namespace vinerow::ros2 {

/// 12 bytes of the participant, 4 of the endpoint; all zero if unknown.
using Guid = std::array<std::uint8_t, 16>;

}  // namespace vinerow::ros2
