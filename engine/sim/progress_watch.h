#pragma once
/// Tells that a vehicle drives its wheels and gets nowhere: stuck on a trunk, in the mud, on its
/// belly.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/core/time.h"

namespace vinerow {

struct VehicleDescription;

class ProgressWatch {
 public:
  /// Of the way that the wheels' rims were commanded to go, forward less back: a vehicle that
  /// stands before an obstacle and tries a little back and forth gets where it is told to.
  static constexpr double kDriven_m = 5.0;
  /// A vehicle may spin its wheels for a while and then come free.
  static constexpr double kPatience_s = 20.0;
  /// Within which a vehicle that drove so far has not moved on. Whoever pivots commands no way.
  static constexpr double kMoved_m = 0.5;

  /// @param description  of a vehicle without wheels: nothing is watched
  explicit ProgressWatch(const VehicleDescription& description);

  /// @param p_W  where the vehicle is  @param actuators  commanded, in the order of the description
  /// @param dt  since the last call
  /// @returns "its wheels were driven for 19.1 m in 20.0 s and it moved 0.12 m", once it is stuck;
  /// empty before
  std::string update(Time now, const Eigen::Vector3d& p_W, const std::vector<double>& actuators,
                     Duration dt);

 private:
  std::vector<int> wheels_;  ///< actuators that are a wheel's speed
  double radius_m_ = 0.0;
  bool started_ = false;
  Time since_;  ///< when it was at the place below
  Eigen::Vector3d from_W_ = Eigen::Vector3d::Zero();
  double driven_m_ = 0.0;  ///< since then, forward > 0
};

}  // namespace vinerow
