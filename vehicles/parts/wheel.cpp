#include "vehicles/parts/wheel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

// Derivation. With spin omega at the start of the step and omega+ at its end, implicit Euler gives
//
//   I (omega+ - omega) / dt = tau_m(omega+) - R F_x(omega+) - C,
//   tau_m(omega+) = motor constant - motor slope omega+,  within [min, max]       (MotorStep)
//   F_x(omega+)   = fx0 + fx1 omega+,                     in the friction ellipse (TyreStep)
//   |C| <= c_rr N R + tau_brake, against omega+           (rolling resistance and brake).
//
// Collected, with free = I / dt omega + constant (motor and tyre):
//
//   omega+ = (free - C) / (I / dt + slope),
//
// and omega+ = 0 exactly if |free| <= c_rr N R + tau_brake. If the torque at omega+ is beyond the
// motor's limits, or the ellipse cuts the force, that part becomes a constant and omega+ is solved
// again: first the motor, then the tyre, then the motor with the tyre's constant force.

namespace vinerow::vehicles {
namespace {

/// Below this speed slip and slip angle are reported as zero: they have no meaning at rest. Chosen
/// far below the speeds of a vehicle that drives.
constexpr double kRestSpeed_mps = 1e-4;

/// Smallest cosine between strut and ground normal, 78 degrees: bounds the forces of a wheel that
/// touches a wall. Chosen.
constexpr double kMinStrutCosine = 0.2;

/// Relative difference above which the ellipse has cut the force; less is rounding.
constexpr double kCutShare = 1e-9;

/// Parameters of the wheel itself; those of its parts are in their own tables. Vehicles fill it.
const ParameterTable<WheelParams>& wheel_table() {
  using P = WheelParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("radius_m", "m", &P::radius_m, kPositive, "rolling radius")
          .number("spin_inertia_kgm2", "kg m2", &P::spin_inertia_kgm2, kPositive,
                  "about the axle, gear and rotor included");
  return table;
}

/// Torque that is left of `free_Nm` after a Coulomb torque of at most `limit_Nm` against it.
double take_off(double free_Nm, double limit_Nm) {
  if (std::abs(free_Nm) <= limit_Nm) return 0.0;
  return free_Nm - std::copysign(limit_Nm, free_Nm);
}

/// omega+ for motor and tyre with the torque constant_Nm - slope_Nms omega+.
double solve_spin(double inertia_per_dt, double spin, double constant_Nm, double slope_Nms,
                  double coulomb_Nm) {
  const double free_Nm = inertia_per_dt * spin + constant_Nm;
  return take_off(free_Nm, coulomb_Nm) / (inertia_per_dt + slope_Nms);
}

}  // namespace

double WheelOutput::slip() const {
  const double fastest = std::max(std::abs(rim_speed_mps), std::abs(v_x_mps));
  return touches && fastest > kRestSpeed_mps ? (rim_speed_mps - v_x_mps) / fastest : 0.0;
}

double WheelOutput::slip_angle_rad() const {
  const bool moves = touches && std::hypot(v_x_mps, v_y_mps) > kRestSpeed_mps;
  return moves ? std::atan2(v_y_mps, std::abs(v_x_mps)) : 0.0;
}

void WheelParams::validate(const std::string& who) const {
  const std::string place = who + ".wheel_" + name;
  wheel_table().validate(*this, place);
  if (probes != 1 && probes != 3) {
    throw ConfigError(fmt::format("{}: wheel_probes = {}, must be 1 or 3", place, probes));
  }
  if (!hub_B.allFinite()) {
    throw ConfigError(fmt::format("{}: hub position must be finite", place));
  }
  tyre.validate(place);
  suspension.validate(place);
  motor.validate(place);
}

Wheel::Wheel(const WheelParams& params, const std::string& who)
    : params_(params), tyre_(params.tyre, params.radius_m), motor_(params.motor) {
  params_.validate(who);
}

WheelDisc Wheel::disc(const WheelState& state, const Eigen::Vector3d& p_WB,
                      const Eigen::Matrix3d& R_WB) const {
  WheelDisc disc;
  disc.hub_W = p_WB + R_WB * params_.hub_B;
  disc.z_W = R_WB.col(2);
  if (state.steer_rad == 0.0) {
    disc.x_W = R_WB.col(0);
    disc.y_W = R_WB.col(1);
  } else {
    const double c = std::cos(state.steer_rad), s = std::sin(state.steer_rad);
    disc.x_W = c * R_WB.col(0) + s * R_WB.col(1);
    disc.y_W = c * R_WB.col(1) - s * R_WB.col(0);
  }
  disc.radius_m = params_.radius_m;
  disc.droop_m = params_.suspension.droop_m();
  disc.probes = params_.probes;
  return disc;
}

WheelOutput Wheel::step(const WheelDisc& disc, const WheelContact& contact,
                        const Eigen::Vector3d& p_WB, const Eigen::Vector3d& v_W,
                        const Eigen::Vector3d& w_W, const Soil& soil, double command_radps,
                        double dt_s, WheelState& state) const {
  WheelOutput out;
  const double spin = state.spin_radps;
  state.travel_m = contact.travel_m;

  // Load: the strut's force along z, balanced by the ground along its normal n:
  // N = F_strut / (z . n), strut rate = -v_C . n / (z . n).
  Eigen::Vector3d x_C = Eigen::Vector3d::Zero(), y_C = x_C, v_C = x_C;
  TyreStep tyre_step;
  if (contact.touches) {
    const Eigen::Vector3d& n = contact.normal_W;
    const double upright = std::max(disc.z_W.dot(n), kMinStrutCosine);
    v_C = v_W + w_W.cross(contact.p_W - p_WB);
    const double rate = -v_C.dot(n) / upright;
    out.load_N = calc_suspension_force(params_.suspension, contact.travel_m, rate) / upright;
    out.touches = out.load_N > 0.0;
    x_C = disc.y_W.cross(n);
    x_C *= 1.0 / std::sqrt(x_C.squaredNorm());
    y_C = n.cross(x_C);
    tyre_step = tyre_.begin(state.tyre, {v_C.dot(x_C), v_C.dot(y_C)}, spin, out.load_N, soil, dt_s);
  } else {
    state.tyre.xi.setZero();
  }

  // Spin, with the motor inside its limits or at one of them.
  const double r = params_.radius_m;
  const MotorStep motor_step = motor_.begin(command_radps, spin, dt_s, state.motor);
  const double rolling_Nm = soil.rolling_resistance * out.load_N * r;
  const double coulomb_Nm = rolling_Nm + (state.motor.braked ? params_.motor.brake_torque_Nm : 0.0);
  const double inertia = params_.spin_inertia_kgm2 / dt_s;
  double tyre_Nm = -r * tyre_step.fx0_N, tyre_slope = r * tyre_step.fx1_Ns;
  double motor_Nm = motor_step.constant_Nm, motor_slope = motor_step.slope_Nms;
  double new_spin =
      solve_spin(inertia, spin, motor_Nm + tyre_Nm, motor_slope + tyre_slope, coulomb_Nm);
  double torque = motor_Nm - motor_slope * new_spin;
  if (torque > motor_step.max_Nm || torque < motor_step.min_Nm) {
    motor_Nm = torque = std::clamp(torque, motor_step.min_Nm, motor_step.max_Nm);
    motor_slope = 0.0;
    new_spin = solve_spin(inertia, spin, motor_Nm + tyre_Nm, tyre_slope, coulomb_Nm);
  }
  Eigen::Vector2d force = {0, 0};
  if (contact.touches) {
    TyreState tyre_state = state.tyre;
    force = tyre_.finish(tyre_step, new_spin, dt_s, tyre_state);
    const double linear_N = tyre_step.fx0_N + tyre_step.fx1_Ns * new_spin;
    if (std::abs(force.x() - linear_N) > kCutShare * out.load_N) {
      // The ellipse has cut the force, which is now a constant for the spin.
      new_spin = solve_spin(inertia, spin, motor_Nm - r * force.x(), motor_slope, coulomb_Nm);
      torque = motor_Nm - motor_slope * new_spin;
      if (torque > motor_step.max_Nm || torque < motor_step.min_Nm) {
        torque = std::clamp(torque, motor_step.min_Nm, motor_step.max_Nm);
        new_spin = solve_spin(inertia, spin, torque - r * force.x(), 0.0, coulomb_Nm);
      }
    }
    state.tyre = tyre_state;
  }
  const double brake_Nm = state.motor.braked ? params_.motor.brake_torque_Nm : 0.0;
  motor_.finish(motor_step, new_spin, torque, dt_s, state.motor);
  motor_.release_brake(motor_step, torque - r * force.x(), dt_s, state.motor);
  state.spin_radps = new_spin;
  state.angle_rad += 0.5 * (spin + new_spin) * dt_s;
  if (std::abs(state.angle_rad) > kPi) state.angle_rad = wrap_angle(state.angle_rad);

  // Torque on the body. The ground's moment about the axle is that of F_x at radius R (in force_W
  // at p_W) and the rolling resistance. Motor and brake are internal torques, so that the body
  // takes the reaction to the change of spin, -I (omega+ - omega) / dt, and to the rolling
  // resistance, and the gyroscopic moment -w x (I omega+ y). At rest the resistance holds what the
  // brake does not, up to its limit.
  const double spin_torque_Nm = inertia * (new_spin - spin);
  const double held_Nm = take_off(torque - r * force.x(), brake_Nm);
  const double resistance_Nm = new_spin != 0.0 ? std::copysign(rolling_Nm, new_spin)
                                               : std::clamp(held_Nm, -rolling_Nm, rolling_Nm);
  out.body_torque_W = -(spin_torque_Nm + resistance_Nm) * disc.y_W -
                      w_W.cross(params_.spin_inertia_kgm2 * new_spin * disc.y_W);
  if (contact.touches) {
    out.p_W = contact.p_W;
    out.force_x_N = force.x();
    out.force_y_N = force.y();
    out.force_W = out.load_N * contact.normal_W + force.x() * x_C + force.y() * y_C;
    out.v_x_mps = tyre_step.velocity.x();
    out.v_y_mps = tyre_step.velocity.y();
  }
  out.rim_speed_mps = r * new_spin;
  return out;
}

Pose Wheel::link_pose_B(const WheelState& state) const {
  Pose pose;
  pose.p = params_.hub_B + Eigen::Vector3d(0, 0, state.travel_m);
  pose.q = Eigen::AngleAxisd(state.steer_rad, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(state.angle_rad, Eigen::Vector3d::UnitY());
  return pose;
}

}  // namespace vinerow::vehicles
