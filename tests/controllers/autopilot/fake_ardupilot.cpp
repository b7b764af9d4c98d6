#include "tests/controllers/autopilot/fake_ardupilot.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>

namespace vinerow::controllers {
namespace {

/// Finds "key" as strstr does and reads the numbers behind it: one, or a list in brackets.
template <std::size_t N>
bool find_numbers(std::string_view text, const std::string& key, std::array<double, N>& to) {
  const std::size_t at = text.find('"' + key + '"');
  if (at == std::string_view::npos) return false;
  std::string_view rest = text.substr(at + key.size() + 2);
  if (!rest.starts_with(N > 1 ? ":[" : ":")) return false;
  const char* p = rest.data() + (N > 1 ? 2 : 1);
  for (double& number : to) {
    char* end = nullptr;
    number = std::strtod(p, &end);
    if (end == p) return false;
    p = end + 1;
  }
  return true;
}

std::optional<double> find_number(std::string_view text, const std::string& key) {
  std::array<double, 1> number{};
  if (!find_numbers(text, key, number)) return std::nullopt;
  return number[0];
}

}  // namespace

std::string read_as_ardupilot(std::string_view line, FakeState& state) {
  if (line.empty() || line.front() != '\n') return "does not begin with a line feed";
  if (line.back() != '\n') return "does not end with a line feed";
  if (line.find_first_of(" \t\r") != std::string_view::npos) return "contains a blank";
  if (line.find("nan") != std::string_view::npos || line.find("inf") != std::string_view::npos) {
    return "contains what is no number";
  }
  // It looks for the first occurrence of a word.
  if (line.find("velocity") != line.find("velocity\"")) return "finds another velocity first";
  if (line.find("rc_1") != line.find("rc_1\"")) return "finds another rc_1 first";
  const std::string text(line);
  const auto timestamp = find_number(text, "timestamp");
  if (!timestamp) return "has no timestamp";
  state.timestamp_s = *timestamp;
  if (!find_numbers(text, "gyro", state.gyro)) return "has no gyro";
  if (!find_numbers(text, "accel_body", state.accel_body)) return "has no accel_body";
  if (!find_numbers(text, "position", state.position)) return "has no position";
  if (!find_numbers(text, "velocity", state.velocity)) return "has no velocity";
  if (!find_numbers(text, "quaternion", state.quaternion)) return "has no quaternion";
  for (std::size_t i = 0; i < state.ranges_m.size(); ++i) {
    state.ranges_m[i] = find_number(text, "rng_" + std::to_string(i + 1));
  }
  state.airspeed_mps = find_number(text, "airspeed");
  state.battery_V = find_number(text, "voltage");
  state.battery_A = find_number(text, "current");
  for (std::size_t i = 0; i < state.sticks_us.size(); ++i) {
    state.sticks_us[i] = find_number(text, "rc_" + std::to_string(i + 1));
  }
  return "";
}

FakeArdupilot::FakeArdupilot(FakeOptions options, Firmware firmware)
    : options_(options), firmware_(std::move(firmware)), thread_([this] { run(); }) {}

FakeArdupilot::~FakeArdupilot() {
  stops_ = true;
  join();
}

void FakeArdupilot::join() {
  if (thread_.joinable()) thread_.join();
}

void FakeArdupilot::run() {
  const auto pause = [](double time_s) {
    std::this_thread::sleep_for(std::chrono::duration<double>(time_s));
  };
  pause(options_.start_after_s);
  const int own = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in simulator{};
  simulator.sin_family = AF_INET;
  simulator.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  simulator.sin_port = htons(options_.port);
  ::connect(own, reinterpret_cast<const sockaddr*>(&simulator), sizeof simulator);

  std::vector<std::uint16_t> pulses;
  std::uint32_t number = 0;
  for (int packet = 0; packet < options_.packets && !stops_; ++packet) {
    if (packet == options_.jump_at) ++number;
    if (packet == options_.restart_at) number = 0;
    std::vector<std::uint8_t> bytes;
    const auto add = [&bytes](std::uint64_t value, int count) {
      for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    add(options_.magic ? options_.magic : (options_.channels == 16 ? 18458 : 29569), 2);
    add(1200, 2);
    add(number++, 4);
    for (int i = 0; i < options_.channels; ++i) {
      add(i < static_cast<int>(pulses.size()) ? pulses[i] : 0, 2);
    }
    if (packet == options_.short_at) bytes.resize(bytes.size() - 2);
    pause(options_.think_s);
    for (int i = 0; i < (packet == options_.repeat_at ? 3 : 1); ++i) {
      ::send(own, bytes.data(), bytes.size(), 0);
    }
    // ArduPilot repeats after a second; here it is 0.7 s, to save the test's time.
    bool ignores = packet == options_.ignore_answer_at;
    for (auto asked = std::chrono::steady_clock::now(); !stops_;) {
      pollfd waits{own, POLLIN, 0};
      std::array<char, 4096> answer{};
      if (::poll(&waits, 1, 20) > 0) {
        const ssize_t count = ::recv(own, answer.data(), answer.size(), 0);
        if (count < 0) continue;  // nobody listens yet
        if (ignores) {
          ignores = false;
          continue;
        }
        ++answers_;
        FakeState state;
        const std::string fault =
            read_as_ardupilot({answer.data(), static_cast<std::size_t>(count)}, state);
        if (!fault.empty()) complaints_.push_back(fault);
        states_.push_back(state);
        pulses = firmware_(state);
        break;
      }
      if (std::chrono::steady_clock::now() - asked > std::chrono::milliseconds(700)) {
        ::send(own, bytes.data(), bytes.size(), 0);
        asked = std::chrono::steady_clock::now();
      }
    }
  }
  ::close(own);
}

}  // namespace vinerow::controllers
