#pragma once
/// A small program that speaks PX4's side of its interface to simulators, in a thread: it connects,
/// gives no answer to the first sensors, then one to each.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

/// What has come with a HIL_SENSOR and before it.
struct FakePx4State {
  mavlink::HilSensor sensors;
  std::optional<mavlink::HilGps> gps;                ///< the last one
  std::optional<mavlink::HilStateQuaternion> truth;  ///< absent while it boots
  std::optional<mavlink::RcChannels> sticks;         ///< the last ones
  std::vector<mavlink::DistanceSensor> ranges;       ///< of this state
  bool has_new_gps = false;
};

struct FakePx4Options {
  std::uint16_t port = 0;   ///< of the simulator
  int answers = 1'000'000;  ///< it says no more after this number
  bool closes = false;      ///< then it also closes its connection
  bool is_armed = true;
  int silent = 9;              ///< sensors without an answer at first
  double start_after_s = 0.0;  ///< a slow start
  double think_s = 0.0;        ///< before each answer
  int wrong_stamp_at = -1;     ///< the answer of this number is of another state
  int cut_at = -1;             ///< the answer of this number comes in two pieces
  int garbage_at = -1;         ///< before the answer of this number there are bytes of no frame
  int twice_at = -1;           ///< the answer of this number comes twice
};

class FakePx4 {
 public:
  using Shares = std::array<float, 16>;
  /// @param firmware  outputs for a state; called in the thread
  using Firmware = std::function<Shares(const FakePx4State&)>;
  FakePx4(FakePx4Options options, Firmware firmware);
  ~FakePx4();

  /// What PX4 would not take: a clock that does not move, readings that never change.
  const std::vector<std::string>& complaints() const { return complaints_; }
  const std::vector<FakePx4State>& states() const { return states_; }
  /// States with the truth: those of the run, not of the boot.
  std::vector<FakePx4State> states_of_run() const;

 private:
  void run();
  void check(const mavlink::HilSensor& sensors);
  void answer(int descriptor);

  FakePx4Options options_;
  Firmware firmware_;
  FakePx4State state_;
  int answered_ = 0, equal_ = 0;
  std::atomic<bool> stops_{false};
  std::vector<std::string> complaints_;
  std::vector<FakePx4State> states_;
  std::thread thread_;
};

}  // namespace vinerow::controllers
