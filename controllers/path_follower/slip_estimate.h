#pragma once
/// Estimator of the slip of a skid-steered vehicle while it drives.
///
/// Wheels that are pushed sideways slip, so the vehicle turns as if its track were wider:
/// w = eta w_wheels. It turns about a point ahead of its centre, so that the centre slides
/// outwards: v_y = -arm w + v drift (the instantaneous centres of rotation of Martinez, Mandow,
/// Morales, Pedraza, Garcia-Cerezo, "Approximating kinematics for tracked mobile robots", Int. J.
/// Robotics Research 24(10), 2005). eta and arm are estimated in turns, drift on straights, each as
/// a low-passed quotient whose weight falls where the yaw rate contains little information.

#include "controllers/path_follower/path_follower_law.h"

namespace vinerow::controllers {

struct SlipEstimateParams {
  double effectiveness = 1.0;  ///< eta at the start
  double arm_m = 0.0;          ///< at the start
  bool learns_arm = true;      ///< false: the arm is constant
  double learn_time_s = 1.0;   ///< time constant of the estimates; 0: all are constant
  double filter_s = 0.2;       ///< low-pass of the measurements
  double response_s = 0.0;     ///< lag of the vehicle's yaw rate behind the wheels'
};

class SlipEstimate {
 public:
  explicit SlipEstimate(const SlipEstimateParams& params)
      : params_(params), effectiveness_(params.effectiveness), slide_{params.arm_m, 0.0} {}

  /// @param commanded_radps     yaw rate of the wheel speeds since the last call
  /// @param measured_radps  yaw rate of the vehicle now
  /// @param v_B             velocity of the vehicle now, m/s
  void update(double commanded_radps, double measured_radps, const Eigen::Vector2d& v_B,
              double dt_s);

  double effectiveness() const { return effectiveness_; }
  const Sideslip& slide() const { return slide_; }

 private:
  SlipEstimateParams params_;
  double effectiveness_;
  Sideslip slide_;
  double lagged_radps_ = 0.0;
  double commanded_radps_ = 0.0;
  double measured_radps_ = 0.0;
  Eigen::Vector2d v_B_ = Eigen::Vector2d::Zero();
};

}  // namespace vinerow::controllers
