#include "controllers/parts/aircraft/aircraft_ports.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/aircraft/aircraft_linear.h"
#include "controllers/parts/paths/part_name.h"
#include "engine/math/angles.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {
namespace {

/// Share of the wanted airspeed at which the launch ends and the controller takes over.
constexpr double kFlownShare = 0.8;
/// Fastest change of a reference's bank: 115 deg/s.
constexpr double kFastestRoll_radps = 2.0;
/// Range of airspeeds of the trims, as shares of the cruise speed. Beyond it the nearest trim is
/// used, and the difference is a deviation.
constexpr double kSlowestShare = 0.7, kFastestShare = 1.5;
/// Rounding, as a share of a limit.
constexpr double kRounding = 1e-9;

bool is_finite(const AircraftControls& controls) {
  return std::isfinite(controls.throttle) && std::isfinite(controls.elevator_rad) &&
         std::isfinite(controls.aileron_rad);
}

}  // namespace

AircraftPorts::AircraftPorts(const ControllerContext& context, const std::string& type,
                             const AircraftLimits& limits)
    : aircraft_(read_aircraft(*context.vehicle_description, context.gravity_mps2,
                              part_name(context, type))),
      trims_(aircraft_, kSlowestShare * aircraft_.cruise_speed_mps,
             kFastestShare * aircraft_.cruise_speed_mps, aircraft_.max_bank_rad,
             part_name(context, type)),
      limits_(limits),
      trim_(trims_.cruise().at(0.0, 0.0)),
      period_s_(context.period.s()),
      bank_before_rad_(std::numeric_limits<double>::quiet_NaN()) {
  const LinearAxis lateral = linearise(aircraft_, trims_.cruise().level()).lateral;
  aileron_per_roll_rate_s_ = -lateral.A(1, 1) / lateral.B(1, 0);
  for (const ActuatorSpec& actuator : aircraft_.actuators) {
    actuator_values_.names.push_back(actuator.name);
    actuator_values_.values.push_back(std::clamp(0.0, actuator.min, actuator.max));
  }
  deviation_values_.names = {"u_mps",
                             "w_mps",
                             "q_radps",
                             "theta_rad",
                             "h_m",
                             "throttle",
                             "elevator_rad",
                             "v_mps",
                             "p_radps",
                             "r_radps",
                             "phi_rad",
                             "psi_rad",
                             "aileron_rad",
                             "limit_share",
                             "outside_lon_states",
                             "outside_lon_inputs",
                             "outside_lat_states",
                             "outside_lat_inputs"};
  deviation_values_.values.assign(deviation_values_.names.size(), 0.0);
}

void AircraftPorts::connect(Ports& ports) {
  estimate_ = ports.read<Odometry>("estimate");
  reference_ = ports.read<AirReference>("reference");
  actuators_ = ports.write<NamedValues>("actuators");
  deviation_out_ = ports.write<NamedValues>("deviation");
  follower_ = ports.write<FollowerState>("follower");
}

bool AircraftPorts::is_flying() const {
  if (!has_estimate() || !has_reference()) return false;
  const AirReference::Phase phase = reference().phase;
  return phase != AirReference::Phase::kWait &&
         (phase != AirReference::Phase::kDone || reference().power);
}

void AircraftPorts::add_roll_rate(double bank_rad) {
  const double rate_radps = (bank_rad - bank_before_rad_) / period_s_;
  bank_before_rad_ = bank_rad;
  // A step of the bank is no roll: the reference starts, or starts again.
  if (!(std::abs(rate_radps) <= kFastestRoll_radps)) return;
  trim_.p_radps += rate_radps;
  // Damping is proportional to the airspeed, the aileron's moment to its square.
  const double slower = trims_.cruise().airspeed_mps() / trims_.within(reference().airspeed_mps);
  trim_.controls.aileron_rad += aileron_per_roll_rate_s_ * slower * rate_radps;
}

void AircraftPorts::take_over() {
  const Odometry& odometry = estimate();
  const AirReference& wanted = reference();
  trim_ = trims_.at(wanted.airspeed_mps, wanted.climb_angle_rad, wanted.bank_rad);
  add_roll_rate(wanted.bank_rad);
  const RollPitchYaw rpy = rpy_from_quaternion(odometry.X_WB.q);
  const Eigen::Vector3d v_air_B = odometry.v_WB_B - odometry.X_WB.q.conjugate() * wanted.wind_W;
  const Eigen::Vector3d& w_B = odometry.w_WB_B;
  const double faster_mps =
      wanted.airspeed_mps > 0.0 ? wanted.airspeed_mps - trims_.within(wanted.airspeed_mps) : 0.0;
  deviation_.lon << v_air_B.x() - trim_.u_mps - faster_mps, -v_air_B.z() - trim_.w_mps,
      -w_B.y() - trim_.q_radps, -rpy.pitch_rad - trim_.pitch_rad,
      odometry.X_WB.p.z() - wanted.height_m;
  const double turned_rad = wanted.heading_rad - rpy.yaw_rad;
  deviation_.lat << -v_air_B.y() - trim_.v_mps, w_B.x() - trim_.p_radps, -w_B.z() - trim_.r_radps,
      wrap_angle(rpy.roll_rad - trim_.roll_rad),
      std::isfinite(turned_rad) ? wrap_angle(turned_rad) : turned_rad;
  is_launching_ = wanted.phase == AirReference::Phase::kLaunch &&
                  v_air_B.norm() < kFlownShare * wanted.airspeed_mps;
  if (!deviation_.lon.allFinite() || !deviation_.lat.allFinite()) deviation_ = {};
}

void AircraftPorts::write_actuators(Time now, const AircraftControls& controls) {
  aircraft_.mix(controls, actuator_values_.values);
  for (std::size_t i = 0; i < aircraft_.actuators.size(); ++i) {
    double& value = actuator_values_.values[i];
    value = std::clamp(value, aircraft_.actuators[i].min, aircraft_.actuators[i].max);
  }
  if (!reference().power) {
    actuator_values_.values[static_cast<std::size_t>(aircraft_.throttle)] =
        aircraft_.throttle_min();
  }
  actuators_.write(now, actuator_values_);
}

AircraftControls AircraftPorts::write(Time now, const AircraftControls& deviation) {
  const AircraftControls requested = is_finite(deviation) ? deviation : AircraftControls{};
  const AircraftControls& trim = trim_.controls;
  const AircraftControls controls = aircraft_.limit({trim.throttle + requested.throttle,
                                                     trim.elevator_rad + requested.elevator_rad,
                                                     trim.aileron_rad + requested.aileron_rad});
  const AircraftControls left = {reference().power ? controls.throttle - trim.throttle : 0.0,
                                 controls.elevator_rad - trim.elevator_rad,
                                 controls.aileron_rad - trim.aileron_rad};
  write_actuators(now, controls);
  write_deviation(now, deviation_, left, true);
  write_follower(now);
  return left;
}

void AircraftPorts::write_launch(Time now) {
  write_actuators(now, {aircraft_.throttle_max(), trim_.controls.elevator_rad, 0.0});
  write_deviation(now, deviation_, {}, false);
  write_follower(now);
}

void AircraftPorts::write_off(Time now) {
  for (std::size_t i = 0; i < aircraft_.actuators.size(); ++i) {
    actuator_values_.values[i] =
        std::clamp(0.0, aircraft_.actuators[i].min, aircraft_.actuators[i].max);
  }
  actuators_.write(now, actuator_values_);
  write_deviation(now, {}, {}, false);
  write_follower(now);
}

void AircraftPorts::write_deviation(Time now, const AircraftDeviation& deviation,
                                    const AircraftControls& controls, bool judged) {
  const Eigen::Vector2d lon_inputs(controls.throttle, controls.elevator_rad);
  const Eigen::Matrix<double, 1, 1> lat_inputs(controls.aileron_rad);
  const Eigen::Vector4d shares(deviation.lon.cwiseAbs().cwiseQuotient(limits_.lon).maxCoeff(),
                               std::max(std::abs(controls.throttle) / limits_.throttle,
                                        std::abs(controls.elevator_rad) / limits_.elevator_rad),
                               deviation.lat.cwiseAbs().cwiseQuotient(limits_.lat).maxCoeff(),
                               std::abs(controls.aileron_rad) / limits_.aileron_rad);
  Eigen::Map<Eigen::Matrix<double, 18, 1>> values(deviation_values_.values.data());
  values << deviation.lon, lon_inputs, deviation.lat, lat_inputs, judged ? shares.maxCoeff() : 0.0,
      Eigen::Vector4d::Zero();
  for (int i = 0; judged && i < 4; ++i) {
    values(14 + i) = shares(i) > 1.0 + kRounding ? 1.0 : 0.0;
  }
  deviation_out_.write(now, deviation_values_);
}

void AircraftPorts::write_follower(Time now) {
  FollowerState follower;
  has_ended_ = has_reference() && reference().phase == AirReference::Phase::kDone;
  if (has_reference()) {
    const AirReference& wanted = reference();
    follower.lateral_error_m = wanted.cross_track_m;
    follower.heading_error_rad = -deviation_.lat(4);
    follower.distance_m = wanted.distance_m;
    follower.remaining_m = wanted.remaining_m;
    follower.waypoint = wanted.waypoint;
    follower.finished = has_ended_;
  }
  follower_.write(now, follower);
}

}  // namespace vinerow::controllers
