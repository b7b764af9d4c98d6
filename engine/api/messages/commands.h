#pragma once
/// Command messages, and named numbers of any kind. Frames and units: engine/api/messages.h.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/api/field.h"

namespace vinerow {

/// Desired speed and yaw rate of a ground vehicle. ROS 2: geometry_msgs/msg/TwistStamped.
struct VelocityCommand {
  static constexpr const char* kType = "VelocityCommand";
  double v_mps = 0.0;
  double yaw_rate_radps = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"speed", "m/s"}, self.v_mps);
    f({"yaw_rate", "rad/s"}, self.yaw_rate_radps);
  }
};

/// Command of a local planner to a vehicle with two steered axles. ROS 2:
/// vinerow_msgs/msg/LocalCommand.
struct LocalCommand {
  static constexpr const char* kType = "LocalCommand";
  enum class Mode : std::uint8_t {
    kFollow = 0,  ///< follow the plan, not faster than v_mps
    kDrive = 1,   ///< drive with these axle angles at v_mps (negative: backwards)
    kStop = 2     ///< stop until the next command
  };
  Mode mode = Mode::kStop;
  double v_mps = 0.0;
  double front_axle_rad = 0.0;  ///< positive to the left
  double rear_axle_rad = 0.0;
  double clearance_m = 0.0;  ///< smallest distance to known obstacles on the chosen path, m

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"mode"}, self.mode);
    f({"speed", "m/s", "limit when following, signed speed when driving"}, self.v_mps);
    f({"front_axle", "rad", "positive to the left"}, self.front_axle_rad);
    f({"rear_axle", "rad"}, self.rear_axle_rad);
    f({"clearance", "m", "smallest distance to known obstacles on the chosen path"},
      self.clearance_m);
  }
};

inline std::span<const EnumName> enum_names(LocalCommand::Mode) {
  using enum LocalCommand::Mode;
  static constexpr EnumName kNames[] = {
      enum_name(kFollow, "FOLLOW"),
      enum_name(kDrive, "DRIVE"),
      enum_name(kStop, "STOP")};
  return kNames;
}

/// Named numbers of one kind: actuator commands, wheel states. The names are fixed when the writer
/// connects. ROS 2: vinerow_msgs/msg/NamedValues (see record/).
struct NamedValues {
  static constexpr const char* kType = "NamedValues";
  std::vector<std::string> names;
  std::vector<double> values;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"name", "", "ends with the unit of the value: _m, _rad, _radps, _N"}, self.names);
    f({"value"}, self.values);
  }
};

}  // namespace vinerow
