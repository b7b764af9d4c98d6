#include "tests/controllers/autopilot/fake_px4.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

#include "engine/mavlink/enums.h"
#include "engine/mavlink/frame.h"

namespace vinerow::controllers {
namespace {

using namespace mavlink;

void pause(double time_s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(time_s));
}

/// @returns a connected socket; -1: nobody listens
int connect_to(std::uint16_t port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in simulator{};
  simulator.sin_family = AF_INET;
  simulator.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  simulator.sin_port = htons(port);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&simulator), sizeof simulator) == 0) {
    const int yes = 1;
    ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    return descriptor;
  }
  ::close(descriptor);
  return -1;
}

}  // namespace

FakePx4::FakePx4(FakePx4Options options, Firmware firmware)
    : options_(options), firmware_(std::move(firmware)), thread_([this] { run(); }) {}

FakePx4::~FakePx4() {
  stops_ = true;
  thread_.join();
}

std::vector<FakePx4State> FakePx4::states_of_run() const {
  std::vector<FakePx4State> result;
  for (const FakePx4State& state : states_) {
    if (state.truth) result.push_back(state);
  }
  return result;
}

void FakePx4::check(const HilSensor& sensors) {
  if (states_.empty()) return;
  const HilSensor& last = states_.back().sensors;
  if (sensors.time_usec <= last.time_usec) complaints_.push_back("the clock does not move");
  const bool is_equal = sensors.xacc == last.xacc && sensors.yacc == last.yacc &&
                        sensors.zacc == last.zacc && sensors.zgyro == last.zgyro;
  equal_ = is_equal ? equal_ + 1 : 0;
  constexpr int kStuck = 100;  // PX4's DataValidator
  if (equal_ == kStuck) complaints_.push_back("the sensors are stuck");
}

void FakePx4::answer(int descriptor) {
  HilActuatorControls controls;
  controls.time_usec = state_.sensors.time_usec;
  controls.mode = options_.is_armed ? kModeFlagArmed | kModeFlagCustom : kModeFlagCustom;
  controls.flags = 1;
  controls.controls = firmware_(state_);
  if (answered_ == options_.wrong_stamp_at) controls.time_usec += 1000;
  FrameWriter writer(Sender{1, 1});
  const auto frame = writer.write(controls);
  pause(options_.think_s);
  if (answered_ == options_.garbage_at) ::send(descriptor, "no frame", 8, MSG_NOSIGNAL);
  const std::size_t first = answered_ == options_.cut_at ? 20 : frame.size();
  ::send(descriptor, frame.data(), first, MSG_NOSIGNAL);
  if (first < frame.size()) {
    pause(0.02);
    ::send(descriptor, frame.data() + first, frame.size() - first, MSG_NOSIGNAL);
  }
  if (answered_ == options_.twice_at) ::send(descriptor, frame.data(), frame.size(), MSG_NOSIGNAL);
  ++answered_;
}

void FakePx4::run() {
  pause(options_.start_after_s);
  int descriptor = -1;
  while (descriptor < 0 && !stops_) {
    descriptor = connect_to(options_.port);
    if (descriptor < 0) pause(0.002);
  }
  if (descriptor < 0) return;
  FrameWriter writer(Sender{1, 1});
  Heartbeat heartbeat;
  heartbeat.autopilot = kAutopilotPx4;
  const auto first = writer.write(heartbeat);
  ::send(descriptor, first.data(), first.size(), MSG_NOSIGNAL);

  FrameReader reader;
  while (!stops_) {
    pollfd waits{descriptor, POLLIN, 0};
    if (::poll(&waits, 1, 20) <= 0) continue;
    std::array<std::uint8_t, 4096> bytes{};
    const ssize_t count = ::recv(descriptor, bytes.data(), bytes.size(), 0);
    if (count <= 0) break;
    reader.read(std::span(bytes).first(static_cast<std::size_t>(count)), [&](const Frame& frame) {
      if (const auto gps = read<HilGps>(frame)) {
        state_.gps = gps;
        state_.has_new_gps = true;
      }
      if (const auto truth = read<HilStateQuaternion>(frame)) state_.truth = truth;
      if (const auto sticks = read<RcChannels>(frame)) state_.sticks = sticks;
      if (const auto range = read<DistanceSensor>(frame)) state_.ranges.push_back(*range);
      const auto sensors = read<HilSensor>(frame);
      if (!sensors) return;
      check(*sensors);
      state_.sensors = *sensors;
      states_.push_back(state_);
      const bool answers = static_cast<int>(states_.size()) > options_.silent;
      if (answers && answered_ < options_.answers) answer(descriptor);
      state_.ranges.clear();
      state_.has_new_gps = false;
    });
    if (options_.closes && answered_ >= options_.answers) break;
  }
  ::close(descriptor);
}

}  // namespace vinerow::controllers
