#include "controllers/parts/rotorcraft/hover_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

HoverFrame::HoverFrame(const Eigen::Vector3d& p_WH, double yaw_rad)
    : p_WH_(p_WH), yaw_rad_(yaw_rad), cos_(std::cos(yaw_rad)), sin_(std::sin(yaw_rad)) {}

Eigen::Vector3d HoverFrame::from_W(const Eigen::Vector3d& v_W) const {
  return {cos_ * v_W.x() + sin_ * v_W.y(), -sin_ * v_W.x() + cos_ * v_W.y(), v_W.z()};
}

Eigen::Vector3d HoverFrame::to_W(const Eigen::Vector3d& v_H) const {
  return {cos_ * v_H.x() - sin_ * v_H.y(), sin_ * v_H.x() + cos_ * v_H.y(), v_H.z()};
}

double HoverState::tilt_rad() const {
  return std::acos(std::clamp(upright, -1.0, 1.0));
}

HoverState calc_hover_state(const Odometry& odometry, const HoverFrame& frame) {
  const Eigen::Quaterniond& q = odometry.X_WB.q;
  const Eigen::Vector3d x_B = frame.from_W(q * Eigen::Vector3d::UnitX());
  const Eigen::Vector3d z_B = frame.from_W(q * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d w = frame.from_W(q * odometry.w_WB_B);
  const Eigen::Vector3d z_rate = w.cross(z_B);
  // Rates of the two arc tangents; undefined only if thrust points along an axis of H.
  constexpr double kMin = 1e-6;
  const double pitch2 = std::max(z_B.x() * z_B.x() + z_B.z() * z_B.z(), kMin);
  const double roll2 = std::max(z_B.y() * z_B.y() + z_B.z() * z_B.z(), kMin);
  HoverState state;
  state.upright = z_B.z();
  state.x << frame.from_W(odometry.X_WB.p - frame.p_WH()), frame.from_W(q * odometry.v_WB_B),
      -std::atan2(z_B.y(), z_B.z()), std::atan2(z_B.x(), z_B.z()), std::atan2(x_B.y(), x_B.x()),
      -(z_B.z() * z_rate.y() - z_B.y() * z_rate.z()) / roll2,
      (z_B.z() * z_rate.x() - z_B.x() * z_rate.z()) / pitch2, w.z();
  return state;
}

Wrench calc_body_wrench(const Eigen::Vector4d& u, const HoverState& state, double weight_N) {
  constexpr double kMinUpright = 0.5;
  const double yaw = state.x[kHoverAngle + 2], c = std::cos(yaw), s = std::sin(yaw);
  Wrench wrench;
  if (state.upright > 0.0) {
    wrench.thrust_N = std::max(weight_N + u[0], 0.0) / std::max(state.upright, kMinUpright);
  }
  wrench.torque_B = {c * u[1] + s * u[2], -s * u[1] + c * u[2], u[3]};
  return wrench;
}

Eigen::Vector4d calc_hover_wrench(const Wrench& wrench, const HoverState& state, double weight_N) {
  const double yaw = state.x[kHoverAngle + 2], c = std::cos(yaw), s = std::sin(yaw);
  const Eigen::Vector3d& t = wrench.torque_B;
  return {wrench.thrust_N * state.upright - weight_N, c * t.x() - s * t.y(), s * t.x() + c * t.y(),
          t.z()};
}

}  // namespace vinerow::controllers
