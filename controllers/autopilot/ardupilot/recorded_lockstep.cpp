#include "controllers/autopilot/ardupilot/recorded_lockstep.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/autopilot/link/plain_text.h"

namespace vinerow::controllers {
namespace {

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

RecordedLockstep::RecordedLockstep(const std::filesystem::path& file, const std::string& who)
    : file_(file.string()), reader_(file, who) {
  advance();
  if (next_) own_ = next_->to;
}

void RecordedLockstep::advance() {
  taken_ = std::move(next_);
  next_ = reader_.next();
}

Result<ServoPacket> RecordedLockstep::next_packet() {
  if (!next_) return Failure{fmt::format("is a recording, which ends here ({})", file_)};
  advance();
  return parse_servo_packet(taken_->bytes);
}

Result<ServoPacket> RecordedLockstep::begin(Time /*now*/) {
  return next_packet();
}

void RecordedLockstep::send_state(Time /*now*/, std::string_view line) {
  line_ = line;
}

Result<ServoPacket> RecordedLockstep::wait_for_outputs(Time /*now*/) {
  skip_messages_to_firmware();
  if (!next_) return Failure{fmt::format("is a recording, which ends here ({})", file_)};
  const std::string_view recorded = text_of(next_->bytes);
  if (recorded != line_) {
    const auto differs =
        std::mismatch(recorded.begin(), recorded.end(), line_.begin(), line_.end());
    const auto at = static_cast<std::size_t>(differs.first - recorded.begin());
    const auto near = [at](std::string_view text) {
      const std::size_t begin = at > 24 ? at - 24 : 0;
      return plain_text(begin < text.size() ? text.substr(begin, 48) : std::string_view());
    };
    return Failure{fmt::format(
        "is a recording ({}) of another flight: the state was \"...{}...\" there and is "
        "\"...{}...\" here",
        file_, near(recorded), near(line_))};
  }
  advance();
  return next_packet();
}

void RecordedLockstep::skip_messages_to_firmware() {
  while (next_ && next_->from.port != 0 && !(next_->from == own_)) advance();
}

std::span<const std::uint8_t> RecordedLockstep::next_message(Time /*now*/) {
  skip_messages_to_firmware();
  // Port 0 stands for the autopilot.
  const bool is_message = next_ && next_->from.port == 0 && !(next_->to == own_);
  if (!is_message) return {};
  advance();
  return taken_->bytes;
}

void RecordedLockstep::send_message(Time /*now*/, std::span<const std::uint8_t> /*bytes*/) {
  // What was sent to the firmware shows in the states that follow.
}

}  // namespace vinerow::controllers
