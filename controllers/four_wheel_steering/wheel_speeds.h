#pragma once
/// Wheel speeds of each cycle: by the QP or all equal; a safe stop if the QP has no solution.

#include "controllers/four_wheel_steering/wheel_speed_qp.h"

namespace vinerow::controllers {

enum class SpeedRule {
  kQp,         ///< wheel_speed_qp.h, corrected form
  kQpPrinted,  ///< as printed in paper A
  kEqual       ///< all wheels have the speed of the vehicle's middle: shows the slip without the QP
};

struct WheelSpeedsParams {
  SpeedRule rule = SpeedRule::kQp;
  WheelSpeedParams qp;
  double stop_mps2 = 0.5;  ///< deceleration of the fastest rim in a safe stop
  double cycle_s = 0.02;
};

class WheelSpeeds {
 public:
  explicit WheelSpeeds(const WheelSpeedsParams& params);

  /// Rim speeds for the coming cycle, m/s; exactly zero for zero speed. No heap.
  /// After the QP had no solution they ramp down to zero, in their last ratio, and stay there.
  /// @param speed_mps  of B's origin, already within the rim limit
  const Eigen::Vector4d& update(const Rolling& rolling, double speed_mps);

  bool has_failed() const { return status_ != QpStatus::kSolved; }
  QpStatus status() const { return status_; }
  const Eigen::Vector4d& rim_mps() const { return rim_mps_; }
  /// Of the last cycle: (alpha v - beta)^2, steps of the solver, largest |A v|.
  double cost() const { return cost_; }
  int iterations() const { return iterations_; }
  double slip_mps() const { return slip_mps_; }

 private:
  void slow_down();

  WheelSpeedsParams params_;
  WheelSpeedQp qp_;
  QpStatus status_ = QpStatus::kSolved;
  Eigen::Vector4d rim_mps_ = Eigen::Vector4d::Zero();
  double cost_ = 0.0;
  double slip_mps_ = 0.0;
  int iterations_ = 0;
};

}  // namespace vinerow::controllers
