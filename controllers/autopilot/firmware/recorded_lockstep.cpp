#include "controllers/autopilot/firmware/recorded_lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "controllers/autopilot/link/plain_text.h"

namespace vinerow::controllers {
namespace {

/// Where two states differ: the text around it, or the byte's number if they are no text.
std::string describe_difference(Bytes recorded, Bytes here) {
  const auto differs =
      std::mismatch(recorded.begin(), recorded.end(), here.begin(), here.end()).first;
  const auto at = static_cast<std::size_t>(differs - recorded.begin());
  const auto is_text = [](Bytes bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) {
      return byte < 0x80 && (byte >= ' ' || byte == '\n');
    });
  };
  if (!is_text(recorded) || !is_text(here)) {
    return fmt::format("the states differ from byte {} of {} on", at, recorded.size());
  }
  const auto near = [at](Bytes bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t begin = at > 24 ? at - 24 : 0;
    return plain_text(begin < text.size() ? text.substr(begin, 48) : std::string_view());
  };
  return fmt::format("the state was \"...{}...\" there and is \"...{}...\" here", near(recorded),
                     near(here));
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

Result<Bytes> RecordedLockstep::next_outputs() {
  if (!next_) return Failure{fmt::format("is a recording, which ends here ({})", file_)};
  advance();
  return Bytes(taken_->bytes);
}

Result<Bytes> RecordedLockstep::begin(Time /*now*/, const BootState& /*boot_state*/) {
  return next_outputs();
}

void RecordedLockstep::send_state(Time /*now*/, const FirmwareState& state) {
  state_ = state.bytes;
}

Result<Bytes> RecordedLockstep::wait_for_outputs(Time /*now*/) {
  skip_messages_to_firmware();
  if (next_) {
    const Bytes recorded(next_->bytes);
    if (!std::equal(recorded.begin(), recorded.end(), state_.begin(), state_.end())) {
      return Failure{fmt::format("is a recording ({}) of another flight: {}", file_,
                                 describe_difference(recorded, state_))};
    }
    advance();
  }
  return next_outputs();
}

void RecordedLockstep::skip_messages_to_firmware() {
  while (next_ && next_->from.port != 0 && !(next_->from == own_)) advance();
}

Bytes RecordedLockstep::next_message(Time /*now*/) {
  skip_messages_to_firmware();
  // Port 0 stands for the autopilot.
  const bool is_message = next_ && next_->from.port == 0 && !(next_->to == own_);
  if (!is_message) return {};
  advance();
  return taken_->bytes;
}

void RecordedLockstep::send_message(Time /*now*/, Bytes /*bytes*/) {
  // What was sent to the firmware shows in the states that follow.
}

}  // namespace vinerow::controllers
