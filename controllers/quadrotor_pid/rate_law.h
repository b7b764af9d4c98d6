#pragma once
/// Rate law from wanted body rates to torques: PID on the rates, whose output is an angular
/// acceleration, so that gains hold for any inertia.
///
///   torque = J (k_p e + I - k_d dw/dt) + w x J w        e = wanted rates - w
///
/// k_d has the effect of a rotor lag shorter by 1 + k_d. The integral does not grow along an axis
/// whose torque the rotors did not reach in the last cycle.

#include <Eigen/Core>

#include "controllers/parts/rotorcraft/rotorcraft.h"

namespace vinerow::controllers {

struct RateParams {
  /// Gains about x and y (the first) and z.
  Eigen::Vector2d p_per_s = {30.0, 6.0};
  Eigen::Vector2d i_per_s2 = {10.0, 3.0};
  Eigen::Vector2d d = {0.8, 0.0};
  double filter_s = 0.004;  ///< low pass of dw/dt
  Eigen::Vector3d torque_limits_Nm = {3.0, 3.0, 0.3};
  double period_s = 0.004;
};

class RateLaw {
 public:
  RateLaw(const RotorcraftModel& craft, const RateParams& params);

  void reset();
  /// One cycle. No heap. @param lost_torque_Nm  wanted minus reached of the last cycle
  /// @returns torque in B, N m
  Eigen::Vector3d step(const Eigen::Vector3d& wanted_radps, const Eigen::Vector3d& w_B,
                       const Eigen::Vector3d& lost_torque_Nm, bool integrate);
  const Eigen::Vector3d& integral_radps2() const { return integral_; }

 private:
  RotorcraftModel craft_;
  RateParams params_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();  ///< rad/s2
  Eigen::Vector3d w_before_ = Eigen::Vector3d::Zero(), slope_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d cut_Nm_ = Eigen::Vector3d::Zero();  ///< by the own limits, last cycle
  bool has_before_ = false;
};

}  // namespace vinerow::controllers
