#pragma once
/// Attitude law from wanted force and heading to wanted body rates, tilt before yaw.
///
/// Source: Brescianini, Hehn, D'Andrea, "Nonlinear quadrocopter attitude control", technical
/// report, ETH Zurich, 2013. The reduced attitude (direction of thrust) is reached by the shortest
/// rotation; the yaw of the full attitude follows with a smaller weight, so that a large yaw error
/// does not disturb the tilt. PX4's attitude controller does the same.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/math/angles.h"

namespace vinerow::controllers {

struct AttitudeParams {
  double tilt_p_per_s = 8.0;
  double yaw_p_per_s = 2.0;
  double tilt_rate_limit_radps = rad_from_deg(220.0);
  double yaw_rate_limit_radps = 1.05;
};

/// Attitude whose z axis is along F_W and whose x axis is above the heading.
/// @param F_W  z part > 0
Eigen::Quaterniond calc_wanted_attitude(const Eigen::Vector3d& F_W, double yaw_rad);

/// @param yaw_rate_radps  of the reference, fed forward @returns wanted rates in B, rad/s
Eigen::Vector3d calc_wanted_rates(const Eigen::Quaterniond& q_WB, const Eigen::Quaterniond& wanted,
                                  double yaw_rate_radps, const AttitudeParams& params);

}  // namespace vinerow::controllers
