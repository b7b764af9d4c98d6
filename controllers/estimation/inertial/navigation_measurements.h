#pragma once
/// What a navigation state should measure, and how that depends on its errors: fixes and velocities
/// of an antenna, height, heading by the magnetic field, the body's velocity by its wheels.
///
/// Gradients follow from R_true = (1 + [dtheta]x) R; each is checked by differences
/// (tests/controllers/estimation). Places on the body are given relative to I along B's axes.

#include "controllers/estimation/inertial/error_state_kalman.h"

namespace vinerow::controllers {

/// Innovation and gradient of three numbers.
struct VectorMeasurement {
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();
  ErrorStateKalman::Rows3 H = ErrorStateKalman::Rows3::Zero();
};
struct ScalarMeasurement {
  double innovation = 0.0;
  ErrorRow H = ErrorRow::Zero();
};

/// Position z_W of a place on the body.
VectorMeasurement place_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                    const Eigen::Vector3d& z_W);
/// Velocity z_W of a place on the body.
VectorMeasurement velocity_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                       const Eigen::Vector3d& z_W);
/// Velocity z_B of a place on the body along the body's axes: wheel speed ahead, none sideways.
VectorMeasurement body_velocity_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                            const Eigen::Vector3d& z_B);
/// Height z of a place on the body.
ScalarMeasurement height_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                     double z);
/// Direction of the magnetic field seen from above. @param north_rad  where it points in W, from
/// east to the left  @pre the field is not vertical
ScalarMeasurement magnetic_measurement(const PastState& state, const Eigen::Vector3d& field_B,
                                       double north_rad);
/// A vector z_W of which the body knows that it is v_B along its axes: the way between two
/// antennas.
VectorMeasurement direction_measurement(const PastState& state, const Eigen::Vector3d& v_B,
                                        const Eigen::Vector3d& z_W);
/// Rate of a body that stands still: the reading is all bias.
VectorMeasurement standing_rate_measurement(const Eigen::Vector3d& reading_B,
                                            const Eigen::Vector3d& gyro_bias_B);

/// Gradient of what depends on the place of a point of the body and on a turn about the vertical
/// through it: dh = gradient_W . dp + gradient_yaw dpsi. For ranges to a map.
ErrorRow pose_row(const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& p_I_B,
                  const Eigen::Vector3d& gradient_W, double gradient_yaw);
/// Gradient of the heading of the body's x axis.
ErrorRow heading_row(const Eigen::Quaterniond& q_WB);

}  // namespace vinerow::controllers
