#pragma once
/// Sentences of an autopilot. Longer ones than a message holds come in numbered pieces.
/// Source: MAVLink's definition of STATUSTEXT.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

struct SpokenText {
  std::uint8_t severity = 0;  ///< MAV_SEVERITY
  std::string text;           ///< printable ASCII
};

class StatusTexts {
 public:
  /// @returns the sentences that are whole now. One whose piece was lost ends where it is missing.
  std::vector<SpokenText> take(const mavlink::StatusText& piece);

 private:
  std::optional<SpokenText> open_;
  std::uint16_t id_ = 0;
  int next_piece_ = 0;
};

}  // namespace vinerow::controllers
