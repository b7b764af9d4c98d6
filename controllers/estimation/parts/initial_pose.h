#pragma once
/// Pose that a program outside the run gives an estimator, as RViz's "2D Pose Estimate" does.

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "engine/api/messages/motion.h"
#include "engine/api/parameter_table.h"
#include "engine/api/signal.h"
#include "engine/math/angles.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

struct InitialPoseParams {
  bool is_taken = false;
};

/// initial_pose_from_outside.
inline const ParameterTable<InitialPoseParams>& initial_pose_table() {
  using P = InitialPoseParams;
  static const ParameterTable<P> table = ParameterTable<P>().boolean(
      "initial_pose_from_outside", &P::is_taken,
      "true: each pose that a program outside the run gives (initialpose) replaces the estimate");
  return table;
}

class InitialPose {
 public:
  struct Value {
    Eigen::Vector2d p_W;  ///< of B's origin, m; viewers do not know its height
    double yaw_rad = 0.0;
    Eigen::Vector2d std_m;
    double yaw_std_rad = 0.0;
  };

  explicit InitialPose(const InitialPoseParams& params) : is_taken_(params.is_taken) {}

  /// Without the parameter there is no such signal, so that logs stay as they are.
  void connect(Ports& ports) {
    if (is_taken_) pose_ = ports.read_from_outside<Odometry>("initialpose");
  }

  /// Each given pose once. A variance of 0, which programs leave unset, counts as 1 cm or 0.1 deg.
  std::optional<Value> take() {
    if (!is_taken_ || !pose_.is_newer_than(seen_)) return std::nullopt;
    const Odometry& given = pose_.value();
    constexpr double kMinStd_m = 0.01, kMinStd_rad = 0.0017;
    const Eigen::Array2d variance_m2 = given.position_variance_m2.head<2>().array();
    return Value{given.X_WB.p.head<2>(), yaw_from_quaternion(given.X_WB.q),
                 variance_m2.max(0.0).sqrt().max(kMinStd_m).matrix(),
                 std::max(given.yaw_std_rad, kMinStd_rad)};
  }

  /// Sentence for an event.
  static std::string describe(const Value& pose) {
    return fmt::format("the pose ({:.2f}, {:.2f}), {:.1f} deg from outside replaces the estimate",
                       pose.p_W.x(), pose.p_W.y(), deg_from_rad(pose.yaw_rad));
  }

 private:
  bool is_taken_;
  std::uint64_t seen_ = 0;
  SignalReader<Odometry> pose_;
};

}  // namespace vinerow::controllers
