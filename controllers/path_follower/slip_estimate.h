#pragma once
/// How a skid-steered vehicle slips, learnt while it drives.
///
/// Wheels that are pushed sideways slip, so the vehicle turns as if its track were wider than it
/// is: w = eta w_wheels; and it turns about a point ahead of its centre, so that the centre slides
/// outwards: v_y = -arm w + v drift (the instantaneous centres of rotation of Martinez, Mandow,
/// Morales, Pedraza, Garcia-Cerezo, "Approximating kinematics for tracked mobile robots", Int. J.
/// Robotics Research 24(10), 2005). eta and arm are learnt while turning, drift while driving
/// straight, each as a low-passed quotient whose weight falls where the yaw rate says little.

#include "controllers/path_follower/path_follower_law.h"

namespace vinerow::controllers {

struct SlipEstimateParams {
  double effectiveness = 1.0;  ///< eta at the start
  double arm_m = 0.0;          ///< at the start
  bool learns_arm = true;      ///< else it stays
  double learn_time_s = 1.0;   ///< time constant of learning; 0 = all stay
  double filter_s = 0.2;       ///< low-pass of what is measured
  double response_s = 0.0;     ///< lag of the vehicle's yaw rate behind the wheels'
};

class SlipEstimate {
 public:
  explicit SlipEstimate(const SlipEstimateParams& params)
      : params_(params), effectiveness_(params.effectiveness), slide_{params.arm_m, 0.0} {}

  /// @param asked_radps     yaw rate the wheels stood for since the last call
  /// @param measured_radps  yaw rate of the vehicle now
  /// @param v_B             velocity of the vehicle now, m/s
  void update(double asked_radps, double measured_radps, const Eigen::Vector2d& v_B, double dt_s);

  double effectiveness() const { return effectiveness_; }
  const Sideslip& slide() const { return slide_; }

 private:
  SlipEstimateParams params_;
  double effectiveness_;
  Sideslip slide_;
  double lagged_radps_ = 0.0;
  double asked_radps_ = 0.0;
  double measured_radps_ = 0.0;
  Eigen::Vector2d v_B_ = Eigen::Vector2d::Zero();
};

}  // namespace vinerow::controllers
