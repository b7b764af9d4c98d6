#include "controllers/estimation/inertial/navigation_measurements.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// Gradient of a vector's horizontal direction with respect to a small rotation dtheta in W.
Eigen::RowVector3d azimuth_gradient(const Eigen::Vector3d& v_W) {
  const double square = v_W.head<2>().squaredNorm();
  return {-v_W.z() * v_W.x() / square, -v_W.z() * v_W.y() / square, 1.0};
}

}  // namespace

VectorMeasurement place_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                    const Eigen::Vector3d& z_W) {
  const Eigen::Vector3d arm_W = state.q_WB * p_I_B;
  VectorMeasurement m;
  m.innovation = z_W - (state.p_WI + arm_W);
  m.H.middleCols<3>(ErrorIndex::kPosition).setIdentity();
  m.H.middleCols<3>(ErrorIndex::kAttitude) = -skew(arm_W);
  return m;
}

VectorMeasurement velocity_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                       const Eigen::Vector3d& z_W) {
  const Eigen::Vector3d turning_W = state.q_WB * state.w_B.cross(p_I_B);
  VectorMeasurement m;
  m.innovation = z_W - (state.v_WI + turning_W);
  m.H.middleCols<3>(ErrorIndex::kVelocity).setIdentity();
  m.H.middleCols<3>(ErrorIndex::kAttitude) = -skew(turning_W);
  // w = reading - bias: d(w x r) = -dbias x r = [r]x dbias.
  m.H.middleCols<3>(ErrorIndex::kGyroBias) = state.q_WB.toRotationMatrix() * skew(p_I_B);
  return m;
}

VectorMeasurement body_velocity_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                            const Eigen::Vector3d& z_B) {
  const Eigen::Matrix3d R_BW = state.q_WB.conjugate().toRotationMatrix();
  VectorMeasurement m;
  m.innovation = z_B - (R_BW * state.v_WI + state.w_B.cross(p_I_B));
  m.H.middleCols<3>(ErrorIndex::kVelocity) = R_BW;
  m.H.middleCols<3>(ErrorIndex::kAttitude) = R_BW * skew(state.v_WI);
  m.H.middleCols<3>(ErrorIndex::kGyroBias) = skew(p_I_B);
  return m;
}

ScalarMeasurement height_measurement(const PastState& state, const Eigen::Vector3d& p_I_B,
                                     double z) {
  const VectorMeasurement place = place_measurement(state, p_I_B, Eigen::Vector3d::Constant(z));
  return {place.innovation.z(), place.H.row(2)};
}

ScalarMeasurement magnetic_measurement(const PastState& state, const Eigen::Vector3d& field_B,
                                       double north_rad) {
  const Eigen::Vector3d field_W = state.q_WB * field_B;
  ScalarMeasurement m;
  m.innovation = wrap_angle(north_rad - std::atan2(field_W.y(), field_W.x()));
  m.H.middleCols<3>(ErrorIndex::kAttitude) = azimuth_gradient(field_W);
  return m;
}

VectorMeasurement direction_measurement(const PastState& state, const Eigen::Vector3d& v_B,
                                        const Eigen::Vector3d& z_W) {
  const Eigen::Vector3d v_W = state.q_WB * v_B;
  VectorMeasurement m;
  m.innovation = z_W - v_W;
  m.H.middleCols<3>(ErrorIndex::kAttitude) = -skew(v_W);
  return m;
}

VectorMeasurement stationary_rate_measurement(const Eigen::Vector3d& reading_B,
                                              const Eigen::Vector3d& gyro_bias_B) {
  VectorMeasurement m;
  m.innovation = reading_B - gyro_bias_B;
  m.H.middleCols<3>(ErrorIndex::kGyroBias).setIdentity();
  return m;
}

ErrorRow pose_row(const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& p_I_B,
                  const Eigen::Vector3d& gradient_W, double gradient_yaw) {
  ErrorRow row = ErrorRow::Zero();
  row.segment<3>(ErrorIndex::kPosition) = gradient_W.transpose();
  // g . (dtheta x arm) = dtheta . (arm x g)
  row.segment<3>(ErrorIndex::kAttitude) = (q_WB * p_I_B).cross(gradient_W).transpose();
  row[ErrorIndex::kAttitude + 2] += gradient_yaw;
  return row;
}

ErrorRow heading_row(const Eigen::Quaterniond& q_WB) {
  ErrorRow row = ErrorRow::Zero();
  row.segment<3>(ErrorIndex::kAttitude) = azimuth_gradient(q_WB * Eigen::Vector3d::UnitX());
  return row;
}

}  // namespace vinerow::controllers
