#pragma once
/// Initial state of a navigation filter: drawn about the truth, like a user's rough knowledge of
/// the vehicle's position, or from levelling at rest.

#include "controllers/estimation/inertial/error_state_options.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

/// Diagonal covariance of the configured 1 sigma values.
ErrorCovariance start_covariance(const ErrorStateOptions& options);

/// A state whose error is drawn from `covariance` (diagonal). The biases start at zero, so that
/// their error is the unit's own bias. @param p_BI  the inertial unit in B
NavState draw_start(const Odometry& truth, const Eigen::Vector3d& p_BI,
                    const ErrorCovariance& covariance, RandomStream& random);

/// A state and its diagonal covariance.
struct NavStart {
  NavState state;
  ErrorCovariance covariance;
};
/// The present state moved to another place and heading, as if the vehicle had been carried there
/// in motion: height, tilt, speed along the body's axes and biases stay, with their variances.
/// @param p_BI  the inertial unit in B
NavStart moved_start(const NavState& present, const ErrorCovariance& covariance,
                     const InitialPose::Value& pose, const Eigen::Vector3d& p_BI);

/// Attitude of a body at rest with the specific force f_B, which gives roll and pitch; the heading
/// is given.
/// @pre f_B is not zero and not along body x
Eigen::Quaterniond level_attitude(const Eigen::Vector3d& f_B, double yaw_rad);

/// Heading at which the field measured by a body with this tilt points towards north_rad
/// (counter-clockwise from east).
double heading_from_field(const Eigen::Vector3d& f_B, const Eigen::Vector3d& field_B,
                          double north_rad);

/// Height above sea level in the standard atmosphere at this pressure, m. International standard
/// atmosphere below 11 km: T0 = 288.15 K, 6.5 K/km.
double standard_height_m(double pressure_Pa);

}  // namespace vinerow::controllers
