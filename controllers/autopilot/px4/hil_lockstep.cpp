#include "controllers/autopilot/px4/hil_lockstep.h"

#include <fmt/format.h>

#include <thread>

namespace vinerow::controllers {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Between two looks at whether the autopilot still runs.
constexpr milliseconds kLook{100};
/// Between two states before the first outputs: as PX4's clock would run.
constexpr milliseconds kPace{4};

}  // namespace

std::string HilLockstep::gone() {
  if (std::string reason = ending(); !reason.empty()) return reason;
  if (!server_->is_closed()) return "";
  // The connection of a program that ends closes before the program has ended.
  constexpr milliseconds kEnding{200}, kPause{10};
  for (auto waited = milliseconds(0); waited < kEnding; waited += kPause) {
    std::this_thread::sleep_for(kPause);
    if (std::string reason = ending(); !reason.empty()) return reason;
  }
  return "closed its connection";
}

bool HilLockstep::receive(std::uint64_t stamp_us, milliseconds limit) {
  const auto end = Clock::now() + limit;
  for (;;) {
    if (controls_ && controls_->time_usec >= stamp_us) return true;
    const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
    if (left.count() < 0) return false;
    const Bytes bytes = server_->receive(left);
    if (bytes.empty()) return false;
    reader_.read(bytes, [this](const mavlink::Frame& frame) {
      if (auto controls = mavlink::read<mavlink::HilActuatorControls>(frame)) controls_ = controls;
    });
  }
}

Result<Bytes> HilLockstep::boot(const BootState& boot_state) {
  const auto begin = Clock::now();
  for (std::uint64_t number = 1; Clock::now() - begin < options().start_limit; ++number) {
    const FirmwareState state = boot_state(number);
    const bool is_in_lockstep = controls_.has_value();
    server_->send(state.bytes, options().answer_limit);
    if (!is_in_lockstep) {
      receive(state.stamp_us, kPace);
      if (std::string reason = gone(); !reason.empty()) return Failure{reason};
      continue;
    }
    auto answer = wait_for(state.stamp_us);
    if (!answer || has_heard()) return answer;
  }
  return Failure{fmt::format("sent {} for {}", controls_ ? "no MAVLink" : "no outputs",
                             seconds_text(options().start_limit))};
}

Result<Bytes> HilLockstep::begin(Time now, const BootState& boot_state) {
  server_.emplace(options().own, who());
  start();
  const auto begin = Clock::now();
  while (!server_->accept(kLook)) {
    if (std::string reason = ending(); !reason.empty()) return Failure{reason};
    if (Clock::now() - begin >= options().start_limit) {
      return Failure{fmt::format("did not connect to TCP port {} for {}", server_->port(),
                                 seconds_text(options().start_limit))};
    }
  }
  auto first = boot(boot_state);
  if (first) record_outputs(now, *first);
  return first;
}

void HilLockstep::send_state(Time now, const FirmwareState& state) {
  record_state(now, state.bytes);
  stamp_us_ = state.stamp_us;
  // What cannot be sent shows when no outputs come.
  server_->send(state.bytes, options().answer_limit);
}

Result<Bytes> HilLockstep::wait_for(std::uint64_t stamp_us) {
  const auto begin = Clock::now();
  do {
    if (receive(stamp_us, kLook)) return Bytes(writer_.write(*controls_));
    if (std::string reason = gone(); !reason.empty()) return Failure{reason};
  } while (Clock::now() - begin < options().answer_limit);
  return Failure{fmt::format("sent nothing for {} (at {:.6f} s of its clock)",
                             seconds_text(options().answer_limit),
                             1e-6 * static_cast<double>(stamp_us))};
}

Result<Bytes> HilLockstep::wait_for_outputs(Time now) {
  auto answer = wait_for(stamp_us_);
  if (answer) record_outputs(now, *answer);
  return answer;
}

}  // namespace vinerow::controllers
