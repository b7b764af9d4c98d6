#include "controllers/parts/rotorcraft/flight_ports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/part_name.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

RotorcraftModel read_craft(const ControllerContext& context, const std::string& who) {
  VINEROW_DEMAND(context.vehicle_description != nullptr);
  if (context.period.ns <= 0) throw ConfigError(fmt::format("{}: rate_Hz must be > 0", who));
  return read_rotorcraft(*context.vehicle_description, context.gravity_mps2, who);
}

/// The feet are about as far from the centre of mass horizontally as vertically.
double inertia_about_a_foot(const RotorcraftModel& craft, const VehicleDescription& vehicle) {
  const double height_m = vehicle.height_above_ground_m;
  return craft.inertia_kgm2.head<2>().mean() + 2.0 * craft.mass_kg * height_m * height_m;
}

}  // namespace

FlightPorts::FlightPorts(const ControllerContext& context, const std::string& type)
    : craft_(read_craft(context, part_name(context, type))),
      mixer_(craft_, part_name(context, type)),
      lay_down_(inertia_about_a_foot(craft_, *context.vehicle_description),
                craft_.mass_kg * craft_.gravity_mps2) {
  for (std::size_t i = 1; i <= craft_.rotors.size(); ++i) {
    actuator_values_.names.push_back(fmt::format("rotor_{}_speed_radps", i));
    context.vehicle_description->actuator_index(actuator_values_.names.back(),
                                                part_name(context, type));
  }
  actuator_values_.values.assign(craft_.rotors.size(), 0.0);
  for (const char* kind : {"wanted", "reachable"}) {
    wrench_values_.names.push_back(fmt::format("{}_thrust_N", kind));
    for (const char* axis : {"x", "y", "z"}) {
      wrench_values_.names.push_back(fmt::format("{}_torque_{}_Nm", kind, axis));
    }
  }
  wrench_values_.values.assign(wrench_values_.names.size(), 0.0);
}

void FlightPorts::connect(Ports& ports) {
  estimate_ = ports.read<Odometry>("estimate");
  reference_ = ports.read<ReferenceTrajectory>("reference");
  actuators_ = ports.write<NamedValues>("actuators");
  wrench_ = ports.write<NamedValues>("wrench");
  follower_ = ports.write<FollowerState>("follower");
}

bool FlightPorts::is_flying() const {
  if (!has_estimate() || !has_reference()) return false;
  return is_done() ? has_flown_ : reference().phase != ReferenceTrajectory::Phase::kWait;
}

TrajectoryPoint FlightPorts::reference_at(Time now) const {
  const ReferenceTrajectory& trajectory = reference();
  const double dt = trajectory.dt_s;
  const double last = static_cast<double>(trajectory.points.size() - 1);
  const double place = dt > 0.0 ? std::max((now - reference_.stamp()).s() / dt, 0.0) : 0.0;
  // A time stamp may exceed the last point by rounding.
  constexpr double kRounding = 1e-6;
  if (place >= last) {
    TrajectoryPoint end = trajectory.points.back();
    if (place > last + kRounding) {
      end.v_W.setZero();
      end.a_W.setZero();
      end.yaw_rate_radps = 0.0;
    }
    return end;
  }
  const auto index = static_cast<std::size_t>(place);
  const TrajectoryPoint &a = trajectory.points[index], &b = trajectory.points[index + 1];
  const double s = place - static_cast<double>(index);
  const double h = s * s * (3.0 - 2.0 * s);
  TrajectoryPoint at;
  at.p_W = a.p_W + h * (b.p_W - a.p_W) + dt * s * (1.0 - s) * ((1.0 - s) * a.v_W - s * b.v_W);
  at.v_W = a.v_W + s * (b.v_W - a.v_W);
  at.a_W = a.a_W + s * (b.a_W - a.a_W);
  at.yaw_rad = a.yaw_rad + s * (b.yaw_rad - a.yaw_rad);
  at.yaw_rate_radps = a.yaw_rate_radps + s * (b.yaw_rate_radps - a.yaw_rate_radps);
  return at;
}

Wrench FlightPorts::write(Time now, const Wrench& wanted) {
  // At this climb rate it has left the ground; other phases start in the air.
  constexpr double kClimb_mps = 0.1;
  const Odometry& odometry = estimate();
  if (reference().phase != ReferenceTrajectory::Phase::kTakeOff ||
      (odometry.X_WB.q * odometry.v_WB_B).z() > kClimb_mps) {
    has_lifted_off_ = true;
  }
  if (!is_done()) {
    landed_.reset();
  } else if (!landed_) {
    landed_ = laid_ = now;
    lay_down_.start(mixer_.wrench_of(actuator_values_.values));
  }
  if (landed_ && (now - *landed_).s() >= kWindDown_s) {
    write_off(now);
    return {};
  }
  has_flown_ = true;
  if (landed_) return lay_down(now);
  const Wrench reached = mixer_.mix(wanted, actuator_values_.values);
  write_values(now, wanted, reached);
  return reached;
}

Wrench FlightPorts::lay_down(Time now) {
  Wrench wanted = lay_down_.advance(estimate().w_WB_B, (now - laid_).s());
  laid_ = now;
  Wrench reached = mixer_.mix(wanted, actuator_values_.values);
  const double max_N = lay_down_.max_thrust_N();
  if (reached.thrust_N > max_N) {
    // In the air torques have priority and may cause lift; on the ground that would cost the feet
    // their grip.
    const double share = max_N / reached.thrust_N;
    lay_down_.limit(share);
    wanted.torque_B *= share;
    reached = mixer_.mix(wanted, actuator_values_.values);
  }
  write_values(now, wanted, reached);
  return reached;
}

void FlightPorts::write_off(Time now) {
  has_lifted_off_ = false;
  has_flown_ = false;
  has_ended_ = is_done();
  std::fill(actuator_values_.values.begin(), actuator_values_.values.end(), 0.0);
  write_values(now, {}, {});
}

void FlightPorts::write_values(Time now, const Wrench& wanted, const Wrench& reached) {
  std::vector<double>& values = wrench_values_.values;
  values[0] = wanted.thrust_N;
  values[4] = reached.thrust_N;
  for (int axis = 0; axis < 3; ++axis) {
    values[1 + axis] = wanted.torque_B(axis);
    values[5 + axis] = reached.torque_B(axis);
  }
  actuators_.write(now, actuator_values_);
  wrench_.write(now, wrench_values_);
  write_follower(now);
}

void FlightPorts::write_follower(Time now) {
  FollowerState state;
  state.finished = is_done();
  if (has_reference()) {
    state.distance_m = reference().distance_m;
    state.remaining_m = reference().remaining_m;
  }
  if (has_reference() && has_estimate()) {
    const TrajectoryPoint at = reference_at(now);
    const Pose& X_WB = estimate().X_WB;
    // Left of the direction of travel, or of the wanted heading if the reference is at rest.
    constexpr double kSlow_mps = 0.05;
    Eigen::Vector2d along(std::cos(at.yaw_rad), std::sin(at.yaw_rad));
    const Eigen::Vector2d v = at.v_W.head<2>();
    if (v.norm() > kSlow_mps) along = v.normalized();
    const Eigen::Vector2d off = (X_WB.p - at.p_W).head<2>();
    state.lateral_error_m = along.x() * off.y() - along.y() * off.x();
    state.heading_error_rad = wrap_angle(yaw_from_quaternion(X_WB.q) - at.yaw_rad);
  }
  follower_.write(now, state);
}

}  // namespace vinerow::controllers
