#include "tests/controllers/support/quadrotor_sim.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::test {
namespace {

/// Rotors on a circle, the first at this angle from the nose, then to the left.
std::vector<SimRotor> make_rotors(double arm_m, double first_rad) {
  std::vector<SimRotor> rotors;
  for (int i = 0; i < 4; ++i) {
    const double angle = first_rad + 0.5 * M_PI * i;
    rotors.push_back({arm_m * std::cos(angle), arm_m * std::sin(angle), i % 2 == 0 ? 1.0 : -1.0});
  }
  return rotors;
}

/// a + s b, the quaternion as four numbers.
QuadrotorState moved(const QuadrotorState& a, double s, const QuadrotorState& b) {
  QuadrotorState x;
  x.p_W = a.p_W + s * b.p_W;
  x.v_W = a.v_W + s * b.v_W;
  x.q_WB.coeffs() = a.q_WB.coeffs() + s * b.q_WB.coeffs();
  x.w_B = a.w_B + s * b.w_B;
  x.rotors_radps = a.rotors_radps + s * b.rotors_radps;
  return x;
}

}  // namespace

QuadrotorNumbers make_q4t() {
  QuadrotorNumbers numbers;
  numbers.rotors = make_rotors(0.31, 0.25 * M_PI);
  return numbers;
}

QuadrotorNumbers make_m100() {
  QuadrotorNumbers numbers;
  numbers.mass_kg = 2.431;
  numbers.inertia_kgm2 = {0.0617, 0.0619, 0.1231};
  numbers.rotors = make_rotors(0.325, 0.25 * M_PI);
  numbers.thrust_coefficient = 2.431 * 9.80665 / (4.0 * 580.0 * 580.0);
  numbers.torque_coefficient = 0.018 * numbers.thrust_coefficient;
  numbers.max_radps = 820.0;
  return numbers;
}

QuadrotorNumbers with_plus_layout(QuadrotorNumbers numbers) {
  numbers.rotors = make_rotors(std::hypot(numbers.rotors[0].x_m, numbers.rotors[0].y_m), 0.0);
  return numbers;
}

VehicleDescription describe(const QuadrotorNumbers& numbers) {
  VehicleDescription description;
  description.type = "quadrotor";
  description.mass_kg = numbers.mass_kg;
  description.max_speed_mps = 8.0;
  description.min_turning_radius_m = 1.0;
  description.battery_capacity_J = 4.0e5;
  Rotorcraft& craft = description.rotorcraft.emplace();
  for (const SimRotor& rotor : numbers.rotors) {
    craft.rotors.push_back({{rotor.x_m, rotor.y_m}, rotor.torque_sign});
    description.actuators.push_back(
        {"rotor_" + std::to_string(craft.rotors.size()) + "_speed_radps", "rad/s",
         numbers.min_radps, numbers.max_radps});
  }
  craft.inertia_kgm2 = numbers.inertia_kgm2;
  craft.thrust_coefficient_Ns2 = numbers.thrust_coefficient;
  craft.torque_coefficient_Nms2 = numbers.torque_coefficient;
  craft.min_rotor_radps = numbers.min_radps;
  craft.max_rotor_radps = numbers.max_radps;
  craft.rotor_lag_s = numbers.lag_s;
  craft.rotor_inertia_kgm2 = numbers.rotor_inertia_kgm2;
  craft.rotor_drag_Ns_per_m = numbers.rotor_drag_Ns_per_m;
  craft.rotor_radius_m = 0.19;
  craft.tip_radius_m = 0.50;
  craft.max_tilt_rad = numbers.max_tilt_rad;
  craft.landing_speed_limit_mps = 1.0;
  return description;
}

QuadrotorSim::QuadrotorSim(QuadrotorNumbers numbers)
    : numbers_(std::move(numbers)), floor_m_(-std::numeric_limits<double>::infinity()) {
  state_.rotors_radps = Eigen::VectorXd::Zero(static_cast<int>(numbers_.rotors.size()));
}

double QuadrotorSim::hover_radps() const {
  return std::sqrt(numbers_.mass_kg * numbers_.gravity_mps2 /
                   (static_cast<double>(numbers_.rotors.size()) * numbers_.thrust_coefficient));
}

void QuadrotorSim::set_floor(double height_m) {
  floor_m_ = height_m;
}

QuadrotorState QuadrotorSim::derivative(const QuadrotorState& x, const Eigen::VectorXd& wanted,
                                        double time_s) const {
  QuadrotorState rate;
  rate.rotors_radps = (wanted - x.rotors_radps) / numbers_.lag_s;
  double thrust_N = 0.0, rotors_Nms = 0.0;
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (int i = 0; i < x.rotors_radps.size(); ++i) {
    const SimRotor& rotor = numbers_.rotors[static_cast<std::size_t>(i)];
    const double square = x.rotors_radps(i) * x.rotors_radps(i);
    const Eigen::Vector3d lift(0.0, 0.0, numbers_.thrust_coefficient * square);
    thrust_N += lift.z();
    torque += Eigen::Vector3d(rotor.x_m, rotor.y_m, 0.0).cross(lift);
    torque.z() += rotor.torque_sign * numbers_.torque_coefficient * square;
    // A rotor whose drag turns the body to the left turns to the right itself.
    torque.z() += rotor.torque_sign * numbers_.rotor_inertia_kgm2 * rate.rotors_radps(i);
    rotors_Nms -= rotor.torque_sign * numbers_.rotor_inertia_kgm2 * x.rotors_radps(i);
  }
  const Eigen::Vector3d wind = wind_ ? wind_(time_s, x.p_W) : Eigen::Vector3d::Zero();
  const Eigen::Vector3d through_air = x.v_W - wind;
  const double drag = numbers_.rotor_drag_Ns_per_m + 0.5 * numbers_.air_density_kgm3 *
                                                         numbers_.body_drag_area_m2 *
                                                         through_air.norm();
  const Eigen::Quaterniond q = x.q_WB.normalized();
  rate.p_W = x.v_W;
  rate.v_W = (q * Eigen::Vector3d(0.0, 0.0, thrust_N) - drag * through_air) / numbers_.mass_kg;
  rate.v_W.z() -= numbers_.gravity_mps2;
  const Eigen::Quaterniond spin(0.0, x.w_B.x(), x.w_B.y(), x.w_B.z());
  rate.q_WB.coeffs() = 0.5 * (x.q_WB * spin).coeffs();
  Eigen::Vector3d momentum = numbers_.inertia_kgm2.cwiseProduct(x.w_B);
  momentum.z() += rotors_Nms;
  rate.w_B = (torque - x.w_B.cross(momentum)).cwiseQuotient(numbers_.inertia_kgm2);
  return rate;
}

void QuadrotorSim::step(const std::vector<double>& wanted_radps, double dt_s) {
  // The bias as half a kick before and half a kick after the step.
  const Eigen::Vector3d half_kick = 0.5 * dt_s * bias_B_.cwiseQuotient(numbers_.inertia_kgm2);
  state_.w_B += half_kick;
  Eigen::VectorXd wanted(state_.rotors_radps.size());
  for (int i = 0; i < wanted.size(); ++i) {
    wanted(i) = std::clamp(wanted_radps[static_cast<std::size_t>(i)], numbers_.min_radps,
                           numbers_.max_radps);
  }
  const QuadrotorState k1 = derivative(state_, wanted, time_s_);
  const QuadrotorState k2 = derivative(moved(state_, 0.5 * dt_s, k1), wanted, time_s_ + 0.5 * dt_s);
  const QuadrotorState k3 = derivative(moved(state_, 0.5 * dt_s, k2), wanted, time_s_ + 0.5 * dt_s);
  const QuadrotorState k4 = derivative(moved(state_, dt_s, k3), wanted, time_s_ + dt_s);
  state_ = moved(state_, dt_s / 6.0, moved(moved(moved(k1, 2.0, k2), 2.0, k3), 1.0, k4));
  state_.q_WB.normalize();
  time_s_ += dt_s;
  state_.w_B += half_kick;
  if (state_.p_W.z() < floor_m_) {
    // It stands: level, with its heading.
    const Eigen::Vector3d nose = state_.q_WB * Eigen::Vector3d::UnitX();
    state_.p_W.z() = floor_m_;
    state_.v_W.setZero();
    state_.w_B.setZero();
    state_.q_WB = Eigen::AngleAxisd(std::atan2(nose.y(), nose.x()), Eigen::Vector3d::UnitZ());
  }
}

double QuadrotorSim::tilt_rad() const {
  return std::acos(std::clamp((state_.q_WB * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
}

Odometry QuadrotorSim::truth() const {
  Odometry truth;
  truth.X_WB = {state_.q_WB, state_.p_W};
  truth.v_WB_B = state_.q_WB.conjugate() * state_.v_W;
  truth.w_WB_B = state_.w_B;
  return truth;
}

}  // namespace vinerow::test
