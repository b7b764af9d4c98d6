#include "controllers/autopilot/ardupilot/lockstep_link.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/autopilot/firmware/running_lockstep.h"

namespace vinerow::controllers {
namespace {

using std::chrono::milliseconds;

/// Between two looks at whether the autopilot still runs.
constexpr milliseconds kLook{100};
/// A repeated packet that arrives earlier after an answer has crossed it on the way: ArduPilot
/// repeats after 1 s.
constexpr milliseconds kCrossing{500};

}  // namespace

void LockstepLink::send() {
  socket_.send({reinterpret_cast<const std::uint8_t*>(line_.data()), line_.size()}, *peer_);
  sent_ = Clock::now();
}

std::optional<Result<ServoPacket>> LockstepLink::next_packet(milliseconds limit) {
  const auto datagram = socket_.receive(limit);
  if (!datagram) return std::nullopt;
  if (peer_ && datagram->from != *peer_) {
    return Result<ServoPacket>(Failure{fmt::format(
        "is not alone: programs at the ports {} and {} send servo outputs to port {}; each "
        "autopilot needs an `instance` of its own",
        peer_->port, datagram->from.port, socket_.port())});
  }
  Result<ServoPacket> packet = parse_servo_packet(datagram->bytes);
  last_ = datagram->bytes;
  if (packet) peer_ = datagram->from;
  return packet;
}

Result<ServoPacket> LockstepLink::wait_for_first(milliseconds limit, const GaveUp& gave_up) {
  const auto begin = Clock::now();
  while (Clock::now() - begin < limit) {
    const auto packet = next_packet(kLook);
    if (packet) {
      // Packets that were repeated before we listened are in the queue with the same number.
      if (*packet) frame_ = packet->value().frame;
      return *packet;
    }
    if (const std::string reason = gave_up(); !reason.empty()) return Failure{reason};
  }
  return Failure{
      fmt::format("sent nothing to UDP port {} for {}", socket_.port(), seconds_text(limit))};
}

void LockstepLink::answer(std::string_view line) {
  // What came while the physics worked are repetitions, and this answer is for all of them.
  while (const auto packet = next_packet(milliseconds(0))) {
    if (!*packet && !failure_) failure_ = Failure{packet->reason()};
  }
  line_ = line;
  send();
}

Result<ServoPacket> LockstepLink::wait_for_next(milliseconds limit, const GaveUp& gave_up) {
  if (failure_) return *failure_;
  const auto begin = Clock::now();
  for (auto now = begin; now - begin < limit; now = Clock::now()) {
    const auto packet = next_packet(kLook);
    if (!packet) {
      if (const std::string reason = gave_up(); !reason.empty()) return Failure{reason};
      continue;
    }
    if (!*packet) return *packet;
    const std::uint32_t frame = packet->value().frame;
    if (frame == frame_ + 1) {
      frame_ = frame;
      return *packet;
    }
    if (frame == frame_) {
      if (Clock::now() - sent_ >= kCrossing) send();
    } else if (frame == 0) {
      return Failure{fmt::format("has restarted after packet {}", frame_)};
    } else {
      return Failure{fmt::format("sent packet {} after packet {}", frame, frame_)};
    }
  }
  return Failure{fmt::format("sent nothing for {} (packet {})", seconds_text(limit), frame_)};
}

}  // namespace vinerow::controllers
