#pragma once
/// Measurement models of a navigation state, with gradients with respect to its errors: position
/// and velocity of an antenna, height, heading from the magnetic field, body velocity from wheels.
///
/// Gradients follow from R_true = (1 + [dtheta]x) R; each is checked by finite differences
/// (tests/controllers/estimation). Points on the body are given relative to I along B's axes.

#include "controllers/estimation/inertial/error_state_kalman.h"

namespace vinerow::controllers {

/// Innovation and gradient of a measurement of three numbers.
struct VectorMeasurement {
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();
  ErrorStateKalman::Rows3 H = ErrorStateKalman::Rows3::Zero();
};
struct ScalarMeasurement {
  double innovation = 0.0;
  ErrorRow H = ErrorRow::Zero();
};

/// Position z_W of a point on the body.
VectorMeasurement place_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                    const Eigen::Vector3d& z_W);
/// Velocity z_W of a point on the body.
VectorMeasurement velocity_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                       const Eigen::Vector3d& z_W);
/// Velocity z_B of a point on the body along the body's axes: wheel speed ahead, zero sideways.
VectorMeasurement body_velocity_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                            const Eigen::Vector3d& z_B);
/// Height z of a point on the body.
ScalarMeasurement height_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                     double z);
/// Direction of the magnetic field seen from above. @param north_rad  its direction in W,
/// counter-clockwise from east @pre the field is not vertical
ScalarMeasurement magnetic_measurement(const PastState& state, const Eigen::Vector3d& field_B,
                                       double north_rad);
/// A vector z_W that is known to be v_B along the body's axes: the baseline between two antennas.
VectorMeasurement direction_measurement(const PastState& state, const Eigen::Vector3d& v_B,
                                        const Eigen::Vector3d& z_W);
/// Angular rate of a stationary body: the reading consists of bias alone.
VectorMeasurement stationary_rate_measurement(const Eigen::Vector3d& reading_B,
                                              const Eigen::Vector3d& gyro_bias_B);

/// Gradient of a quantity that depends on the position of a body point and on a rotation about the
/// vertical through it: dh = gradient_W . dp + gradient_yaw dpsi. For ranges to a map.
ErrorRow pose_row(const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& p_I_B,
                  const Eigen::Vector3d& gradient_W, double gradient_yaw);
/// Gradient of the heading of the body's x axis.
ErrorRow heading_row(const Eigen::Quaterniond& q_WB);

}  // namespace vinerow::controllers
