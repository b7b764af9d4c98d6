#pragma once
/// All messages that we know, by number.

#include <cstddef>
#include <cstdint>
#include <span>

namespace vinerow::mavlink {

/// Layout of a message, as far as readers of frames need it.
struct MessageLayout {
  std::uint32_t id = 0;
  const char* name = "";
  std::uint8_t crc_extra = 0;
  std::size_t size = 0;  ///< of the payload with its extensions, bytes
};

/// Sorted by id.
std::span<const MessageLayout> known_messages();
/// @returns nullptr if the message is unknown
const MessageLayout* find_message(std::uint32_t id);

}  // namespace vinerow::mavlink
