#pragma once
/// Mean wind from the measurements of a fixed-wing vehicle: its velocity over ground minus its
/// velocity through the air, low-passed. In the first seconds it is the mean of all measurements.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "engine/api/forward.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"

namespace vinerow::controllers {

class WindEstimate {
 public:
  /// @param time_s  time constant, > 0
  explicit WindEstimate(double time_s) : time_s_(time_s) {}

  /// Adds a measurement; one that is not finite is ignored. No heap.
  void add(const Odometry& estimate, const AirData& air, double dt_s) {
    const Eigen::Vector3d wind_W = estimate.X_WB.q * (estimate.v_WB_B - air.v_air_B);
    if (!wind_W.allFinite() || dt_s <= 0.0) return;
    seen_s_ += dt_s;
    const double share = std::max(dt_s / seen_s_, 1.0 - std::exp(-dt_s / time_s_));
    wind_W_ += share * (wind_W.head<2>() - wind_W_);
  }

  /// In plan view: a mean of the vertical wind would be the mean error of its sensor.
  const Eigen::Vector2d& wind_W() const { return wind_W_; }

 private:
  double time_s_;
  double seen_s_ = 0.0;
  Eigen::Vector2d wind_W_ = Eigen::Vector2d::Zero();
};

}  // namespace vinerow::controllers
