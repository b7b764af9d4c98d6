#include "engine/sensors/wheel_motion.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::sensors {

WheelMotion::WheelMotion(const VehicleDescription& vehicle, const std::string& who) {
  const WheeledVehicle& wheeled = vehicle.need_wheeled(who);
  wheels_ = wheeled.wheels;
  radius_m_ = vehicle.need_positive(wheeled.wheel_radius_m, "wheel_radius_m", who);
  true_radii_m_.assign(wheels_.size(), radius_m_);
  if (wheels_.empty()) {
    throw ConfigError(fmt::format("{}: vehicle type '{}' does not state where its wheels are", who,
                                  vehicle.type));
  }
  is_steered_ = vehicle.steers_by_axles();
  if (is_steered_) {
    front_actuator_ = vehicle.actuator_index("axle_front_steer_rad", who);
    if (vehicle.steered) {
      front_m_ = vehicle.steered->front_axle_m;
      rear_m_ = vehicle.steered->rear_axle_m;
      rear_actuator_ = vehicle.actuator_index("axle_rear_steer_rad", who);
    } else {
      rear_m_ = vehicle.ackermann->rear_axle_m;
      front_m_ = wheeled.wheel_base_m - rear_m_;
    }
    return;
  }
  const double track_m = vehicle.need_positive(wheeled.track_m, "track_m", who);
  if (wheeled.effective_track_m > 0.0) slip_scale_ = wheeled.effective_track_m / track_m;
  double spread = 0.0;
  for (const WheelPlace& wheel : wheels_) spread += std::abs(wheel.p_B.y() - wheels_[0].p_B.y());
  if (!(spread > 0.0)) {
    throw ConfigError(
        fmt::format("{}: the driven wheels of vehicle type '{}' are all on one side, so their "
                    "speeds do not show its turning",
                    who, vehicle.type));
  }
}

AxleRoll WheelMotion::roll_of(std::span<const double> actuators) const {
  const double rear_rad = rear_actuator_ >= 0 ? actuators[rear_actuator_] : 0.0;
  return calc_axle_roll(front_m_, rear_m_, {actuators[front_actuator_], rear_rad});
}

double WheelMotion::path_per_metre(const AxleRoll& roll, const Eigen::Vector2d& p_B) const {
  return Eigen::Vector2d(1.0 - roll.curvature_per_m * p_B.y(),
                         roll.drift + roll.curvature_per_m * p_B.x())
      .norm();
}

PlanarTwist WheelMotion::solve(std::span<const double> actuators, std::span<const double> radii_m,
                               double track_scale) const {
  if (!is_steered_) return solve_skid(actuators, radii_m, track_scale);
  const AxleRoll roll = roll_of(actuators);
  double along = 0.0, square = 0.0;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double f = path_per_metre(roll, wheels_[i].p_B);
    along += f * radii_m[i] * actuators[wheels_[i].actuator];
    square += f * f;
  }
  const double v_mps = along / square;
  return {{v_mps, roll.drift * v_mps}, roll.curvature_per_m * v_mps};
}

PlanarTwist WheelMotion::solve_skid(std::span<const double> actuators,
                                    std::span<const double> radii_m, double track_scale) const {
  // Line u = v_x - h w through the points (h, u), h = g y.
  double mean_h = 0.0, mean_u = 0.0;
  const double scale = slip_scale_ * track_scale;
  const auto count = static_cast<double>(wheels_.size());
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    mean_h += scale * wheels_[i].p_B.y() / count;
    mean_u += radii_m[i] * actuators[wheels_[i].actuator] / count;
  }
  double hh = 0.0, hu = 0.0;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double h = scale * wheels_[i].p_B.y() - mean_h;
    hh += h * h;
    hu += h * (radii_m[i] * actuators[wheels_[i].actuator] - mean_u);
  }
  const double yaw_rate_radps = -hu / hh;
  return {{mean_u + mean_h * yaw_rate_radps, 0.0}, yaw_rate_radps};
}

Eigen::Vector2d WheelMotion::calc_std(std::span<const double> actuators,
                                      std::span<const double> stds,
                                      std::vector<double>& readings) const {
  constexpr double kStep = 1e-6;  // rad, rad/s
  readings.assign(actuators.begin(), actuators.end());
  const PlanarTwist here = solve(readings, true_radii_m_, 1.0);
  Eigen::Vector2d variance = {0, 0};
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i] = actuators[i] + kStep;
    const PlanarTwist there = solve(readings, true_radii_m_, 1.0);
    readings[i] = actuators[i];
    const Eigen::Vector2d slope(there.v_mps.x() - here.v_mps.x(),
                                there.yaw_rate_radps - here.yaw_rate_radps);
    variance += (stds[i] / kStep * slope).cwiseAbs2();
  }
  return variance.cwiseSqrt();
}

}  // namespace vinerow::sensors
