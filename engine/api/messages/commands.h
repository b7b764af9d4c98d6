#pragma once
/// Messages that command a vehicle, and named numbers of any kind.
/// Frames and units: engine/api/messages.h.

#include <cstdint>
#include <string>
#include <vector>

namespace vinerow {

/// Wanted forward and turning speed of a ground vehicle. ROS 2: geometry_msgs/msg/TwistStamped.
struct VelocityCommand {
  static constexpr const char* kType = "VelocityCommand";
  double v_mps = 0.0;
  double yaw_rate_radps = 0.0;

  template <class F>
  void fields(F&& f) {
    f(v_mps), f(yaw_rate_radps);
  }
};

/// What a local planner wants of a vehicle with two steered axles. ROS 2:
/// vinerow_msgs/msg/LocalCommand.
struct LocalCommand {
  static constexpr const char* kType = "LocalCommand";
  enum class Mode : std::uint8_t {
    kFollow = 0,  ///< follow the plan, not faster than v_mps
    kDrive = 1,   ///< drive with these axle angles at v_mps (negative: backwards)
    kStop = 2     ///< stand still until told otherwise
  };
  Mode mode = Mode::kStop;
  double v_mps = 0.0;
  double front_axle_rad = 0.0;  ///< positive to the left
  double rear_axle_rad = 0.0;
  double clearance_m = 0.0;  ///< least distance to anything known on the way chosen, m

  template <class F>
  void fields(F&& f) {
    f(mode), f(v_mps), f(front_axle_rad), f(rear_axle_rad), f(clearance_m);
  }
};

/// Named numbers of one kind: actuator commands, wheel states. Names are fixed when the writer
/// connects. ROS 2: vinerow_msgs/msg/NamedValues (see record/).
struct NamedValues {
  static constexpr const char* kType = "NamedValues";
  std::vector<std::string> names;
  std::vector<double> values;

  template <class F>
  void fields(F&& f) {
    f(names), f(values);
  }
};

}  // namespace vinerow
