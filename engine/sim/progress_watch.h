#pragma once
/// Detector of vehicles that drive their wheels without progress: stuck on a trunk, in mud, or
/// with the belly on the ground.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/core/time.h"

namespace vinerow {

struct VehicleDescription;

class ProgressWatch {
 public:
  /// Commanded rim travel, forward minus backward, from which a vehicle counts as driven. Small
  /// manoeuvres back and forth in front of an obstacle cancel out and are not reported.
  static constexpr double kDriven_m = 5.0;
  /// Time without progress before the report, since spinning wheels may come free.
  static constexpr double kPatience_s = 20.0;
  /// Displacement below which a vehicle has made no progress. Pivoting on the spot is not
  /// reported, because its commanded travel is zero.
  static constexpr double kMoved_m = 0.5;

  /// @param description  without wheels, nothing is watched
  explicit ProgressWatch(const VehicleDescription& description);

  /// @param p_W  position of the vehicle
  /// @param actuators  commanded values, in the order of the description
  /// @param dt  since the last call
  /// @returns "its wheels were commanded to roll 19.1 m in 20.0 s and it moved 0.12 m" when it
  /// is stuck, else empty
  std::string update(Time now, const Eigen::Vector3d& p_W, const std::vector<double>& actuators,
                     Duration dt);

 private:
  std::vector<int> wheels_;  ///< indices of the actuators that set a wheel's speed
  double radius_m_ = 0.0;
  bool started_ = false;
  Time since_;  ///< when it was at from_W_
  Eigen::Vector3d from_W_ = Eigen::Vector3d::Zero();
  double driven_m_ = 0.0;  ///< since then, forward > 0
};

}  // namespace vinerow
