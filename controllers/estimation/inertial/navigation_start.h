#pragma once
/// How a navigation filter begins: drawn about the truth, as a user who knows roughly where the
/// vehicle stands, or by levelling at rest.

#include "controllers/estimation/inertial/error_state_options.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

/// Diagonal, of the stated 1 sigmas.
ErrorCovariance start_covariance(const ErrorStateOptions& options);

/// A state whose error is drawn from `covariance` (diagonal); the biases begin at zero, theirs is
/// the unit's. @param p_BI  the inertial unit in B
NavState draw_start(const Odometry& truth, const Eigen::Vector3d& p_BI,
                    const ErrorCovariance& covariance, RandomStream& random);

/// Attitude of a body at rest whose specific force is f_B: roll and pitch by it, the heading given.
/// @pre f_B is not zero and not along body x
Eigen::Quaterniond level_attitude(const Eigen::Vector3d& f_B, double yaw_rad);

/// Heading at which the field of a body so tilted points towards north_rad (from east to the left).
double heading_from_field(const Eigen::Vector3d& f_B, const Eigen::Vector3d& field_B,
                          double north_rad);

/// Height above the standard atmosphere's sea level at this pressure, m. International standard
/// atmosphere below 11 km: T0 = 288.15 K, 6.5 K/km.
double standard_height_m(double pressure_Pa);

}  // namespace vinerow::controllers
