#pragma once
/// Estimator of the vehicle's slip relative to its axle angles, while it drives.
///
/// On a side slope tyres yield: the centre travels at an angle to the direction of the axles, and
/// the vehicle may turn less or more than they imply. Both are differences of two directions of the
/// same motion, so no steering command enters them and the estimate closes no loop:
///   slip      = atan(v_y / v_x) - atan(s)         direction of travel
///   curvature = yaw rate / v - k / sqrt(1 + s^2)
/// each through a first-order low-pass.

#include <Eigen/Core>

#include "controllers/four_wheel_steering/axle_geometry.h"

namespace vinerow::controllers {

class SlipLearning {
 public:
  /// @param learn_s  time constant; 0: both stay zero
  explicit SlipLearning(double learn_s) : learn_s_(learn_s) {}

  /// @param rolling  of the present axle angles
  /// @param v_B  velocity of B's origin, m/s  @param yaw_rate_radps  about B's z
  void update(const Rolling& rolling, const Eigen::Vector2d& v_B, double yaw_rate_radps,
              double dt_s);

  double slip_rad() const { return slip_rad_; }
  double curvature_per_m() const { return curvature_per_m_; }

 private:
  double learn_s_;
  double slip_rad_ = 0.0;
  double curvature_per_m_ = 0.0;
};

}  // namespace vinerow::controllers
