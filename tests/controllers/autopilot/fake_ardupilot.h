#pragma once
/// A small program that speaks ArduPilot's side of the JSON interface, in a thread. It refuses
/// what ArduPilot 4.6.3 cannot read, and repeats a packet that nobody answers.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace vinerow::controllers {

/// What the line says, as ArduPilot's search for words finds it.
struct FakeState {
  double timestamp_s = 0.0;
  std::array<double, 3> gyro{}, accel_body{}, position{}, velocity{};
  std::array<double, 4> quaternion{};  ///< w, x, y, z
  std::array<std::optional<double>, 6> ranges_m{};
  std::optional<double> airspeed_mps, battery_V, battery_A;
  std::array<std::optional<double>, 12> sticks_us{};
};

/// @returns the state, or a sentence about what ArduPilot would not read
std::string read_as_ardupilot(std::string_view line, FakeState& state);

struct FakeOptions {
  std::uint16_t port = 0;      ///< of the simulator
  int channels = 16;           ///< or 32
  int packets = 1000;          ///< ends after this number of answers
  double start_after_s = 0.0;  ///< a slow start
  double think_s = 0.0;        ///< before each packet
  int repeat_at = -1;          ///< packet that is sent three times at once
  int ignore_answer_at = -1;   ///< packet whose first answer is lost: it is repeated after 0.7 s
  int jump_at = -1;            ///< this packet skips a number
  int restart_at = -1;         ///< the numbers begin at 0 again
  std::uint16_t magic = 0;     ///< 0: the right one
  int short_at = -1;           ///< this packet lacks its last two bytes
};

class FakeArdupilot {
 public:
  /// @param firmware  pulses for a state; called in the thread
  using Firmware = std::function<std::vector<std::uint16_t>(const FakeState&)>;
  FakeArdupilot(FakeOptions options, Firmware firmware);
  ~FakeArdupilot();

  /// Waits for its end.
  void join();
  int answers() const { return answers_; }
  /// Lines that could not be read, and answers that nobody asked for.
  const std::vector<std::string>& complaints() const { return complaints_; }
  const std::vector<FakeState>& states() const { return states_; }

 private:
  void run();

  FakeOptions options_;
  Firmware firmware_;
  std::atomic<bool> stops_{false};
  std::atomic<int> answers_{0};
  std::vector<std::string> complaints_;
  std::vector<FakeState> states_;
  std::thread thread_;
};

}  // namespace vinerow::controllers
