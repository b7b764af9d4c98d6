#include "tests/controllers/support/aircraft_sim.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace vinerow::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// North, east, down to east, north, up and back; body axes of aviation to x forward, y left, z up
/// and back.
Vector3d world_turned(const Vector3d& v) {
  return {v.y(), v.x(), -v.z()};
}
Vector3d body_turned(const Vector3d& v) {
  return {v.x(), -v.y(), -v.z()};
}

class SimFlightModel final : public FlightModel {
 public:
  explicit SimFlightModel(const AircraftNumbers& numbers) : numbers_(numbers) {}

  AirLoad load(const AirPoint& air, std::span<const double> actuators) const override {
    AircraftNumbers numbers = numbers_;
    numbers.air_density_kgm3 = air.air_density_kgm3;
    const Vector3d controls(actuators[0], 0.5 * (actuators[2] + actuators[1]),
                            0.5 * (actuators[1] - actuators[2]));
    const auto [force, torque] =
        calc_aero(numbers, body_turned(air.v_air_B), body_turned(air.w_WB_B), controls);
    return {body_turned(force), body_turned(torque)};
  }
  double mass_kg() const override { return numbers_.mass_kg; }
  Eigen::Matrix3d inertia_B() const override {
    // x z changes its sign as z does.
    Eigen::Matrix3d J = Vector3d(numbers_.jx_kgm2, numbers_.jy_kgm2, numbers_.jz_kgm2).asDiagonal();
    J(0, 2) = J(2, 0) = numbers_.jxz_kgm2;
    return J;
  }

 private:
  AircraftNumbers numbers_;
};

}  // namespace

AircraftNumbers make_mh900_like() {
  return {};
}

AircraftNumbers make_reference_wing() {
  AircraftNumbers numbers;
  numbers.gravity_mps2 = 9.81;
  numbers.stall_rad = 0.4712;
  return numbers;
}

AircraftNumbers make_scaled_zagi() {
  AircraftNumbers numbers;
  numbers.area_m2 = 0.104;
  numbers.chord_m = 0.209;
  numbers.aspect_ratio = 0.9 * 0.9 / 0.104;
  numbers.CL0 = 0.09167;
  numbers.stall_rad = 0.26;
  return numbers;
}

std::pair<Vector3d, Vector3d> calc_aero(const AircraftNumbers& n, const Vector3d& air,
                                        const Vector3d& rates, const Vector3d& controls) {
  const double V = std::max(air.norm(), 1e-6);
  const double alpha = std::atan2(air.z(), air.x());
  const double beta = std::asin(air.y() / V);
  const double throttle = controls.x(), de = controls.y(), da = controls.z();
  const double c2V = n.chord_m / (2.0 * V), b2V = n.span_m / (2.0 * V);
  const double p = rates.x(), q = rates.y(), r = rates.z();
  const double M = n.stall_sharpness, a0 = n.stall_rad;
  const double e1 = std::exp(std::clamp(-M * (alpha - a0), -300.0, 300.0));
  const double e2 = std::exp(std::clamp(M * (alpha + a0), -300.0, 300.0));
  const double stalled = (1.0 + e1 + e2) / ((1.0 + e1) * (1.0 + e2));
  const double plate =
      2.0 * (alpha > 0 ? 1 : -1) * std::sin(alpha) * std::sin(alpha) * std::cos(alpha);
  const double CL_static = (1.0 - stalled) * (n.CL0 + n.CLa * alpha) + stalled * plate;
  const double CL = CL_static + n.CLq * q * c2V + n.CLde * de;
  const double CD =
      n.CD0 + CL * CL / (M_PI * n.oswald * n.aspect_ratio) + n.CDd2 * (de * de + da * da);
  const double CY = n.CYb * beta + n.CYp * p * b2V + n.CYr * r * b2V;
  const double Cl = n.Clb * beta + n.Clp * p * b2V + n.Clr * r * b2V + n.Clda * da;
  const double Cm = n.Cm0 + n.Cma * alpha + n.Cmq * q * c2V + n.Cmde * de;
  const double Cn = n.Cnb * beta + n.Cnp * p * b2V + n.Cnr * r * b2V + n.Cnda * da;
  const double qS = 0.5 * n.air_density_kgm3 * V * V * n.area_m2;
  const double kd = n.motor_mps * throttle;
  const double thrust = 0.5 * n.air_density_kgm3 * n.propeller_area_m2 * (kd * kd - V * V);
  const Vector3d force(thrust + qS * (-CD * std::cos(alpha) + CL * std::sin(alpha)), qS * CY,
                       qS * (-CD * std::sin(alpha) - CL * std::cos(alpha)));
  return {force, {qS * n.span_m * Cl, qS * n.chord_m * Cm, qS * n.span_m * Cn}};
}

VehicleDescription describe(const AircraftNumbers& numbers) {
  VehicleDescription description;
  description.type = "fixed_wing";
  description.mass_kg = numbers.mass_kg;
  description.actuators = {
      {"throttle", "", 0.0, 1.0},
      {"elevon_left_rad", "rad", -numbers.max_elevon_rad, numbers.max_elevon_rad},
      {"elevon_right_rad", "rad", -numbers.max_elevon_rad, numbers.max_elevon_rad}};
  description.collision_half_extents_m = {0.3, 0.5 * numbers.span_m, 0.05};
  description.max_speed_mps = 25.0;
  description.min_turning_radius_m = numbers.cruise_speed_mps * numbers.cruise_speed_mps /
                                     (numbers.gravity_mps2 * std::tan(numbers.max_bank_rad));
  FixedWingAircraft& aircraft = description.fixed_wing.emplace();
  aircraft.flight_model = std::make_shared<SimFlightModel>(numbers);
  aircraft.span_m = numbers.span_m;
  aircraft.wing_area_m2 = numbers.area_m2;
  aircraft.air_density_kgm3 = numbers.air_density_kgm3;
  aircraft.cruise_speed_mps = numbers.cruise_speed_mps;
  aircraft.stall_speed_mps = std::sqrt(2.0 * numbers.mass_kg * numbers.gravity_mps2 /
                                       (numbers.air_density_kgm3 * numbers.area_m2));
  aircraft.max_bank_rad = numbers.max_bank_rad;
  aircraft.throttle_lag_s = numbers.throttle_lag_s;
  aircraft.elevon_lag_s = numbers.elevon_lag_s;
  aircraft.launch_throttle = 0.3;
  aircraft.landing_sink_limit_mps = 2.0;
  aircraft.belly_height_m = 0.05;
  return description;
}

struct AircraftSim::Rate {
  Vector3d velocity, rates, p_N, controls;
  Eigen::Vector4d q;
};

Vector3d AircraftSim::air_velocity(const AircraftState& x, double time_s) const {
  const Vector3d wind_W = wind_ ? wind_(time_s, world_turned(x.p_N)) : Vector3d::Zero();
  return x.velocity - x.q_NB.conjugate() * world_turned(wind_W) - body_gust_;
}

Vector3d AircraftSim::air_velocity() const {
  return air_velocity(state_, time_s_);
}

AircraftSim::Rate AircraftSim::derivative(const AircraftState& x, const Vector3d& wanted,
                                          double time_s) const {
  const AircraftNumbers& n = numbers_;
  AircraftState level = x;
  level.q_NB.normalize();
  const Vector3d deflected(x.controls.x(), 0.5 * (x.controls.y() + x.controls.z()),
                           0.5 * (x.controls.z() - x.controls.y()));
  const auto [force, torque] = calc_aero(n, air_velocity(level, time_s), x.rates, deflected);
  Rate rate;
  const Vector3d gravity = level.q_NB.conjugate() * Vector3d(0, 0, n.gravity_mps2);
  rate.velocity = force / n.mass_kg + gravity - x.rates.cross(x.velocity);
  Eigen::Matrix3d J = Vector3d(n.jx_kgm2, n.jy_kgm2, n.jz_kgm2).asDiagonal();
  J(0, 2) = J(2, 0) = -n.jxz_kgm2;
  rate.rates = J.inverse() * (torque - x.rates.cross(J * x.rates));
  rate.p_N = level.q_NB * x.velocity;
  const Quaterniond spin(0.0, x.rates.x(), x.rates.y(), x.rates.z());
  rate.q = 0.5 * (x.q_NB * spin).coeffs();
  rate.controls = (wanted - x.controls)
                      .cwiseQuotient(Vector3d(n.throttle_lag_s, n.elevon_lag_s, n.elevon_lag_s));
  return rate;
}

void AircraftSim::start(const Vector3d& p_W, double phi, double theta, double psi,
                        const Vector3d& velocity, const Vector3d& rates, const Vector3d& controls) {
  state_.p_N = world_turned(p_W);
  state_.q_NB = Eigen::AngleAxisd(psi, Vector3d::UnitZ()) *
                Eigen::AngleAxisd(theta, Vector3d::UnitY()) *
                Eigen::AngleAxisd(phi, Vector3d::UnitX());
  state_.velocity = velocity;
  state_.rates = rates;
  state_.controls = {controls.x(), controls.y() - controls.z(), controls.y() + controls.z()};
}

void AircraftSim::step(const std::vector<double>& actuators, double dt_s) {
  const double max_rad = numbers_.max_elevon_rad;
  const Vector3d wanted(std::clamp(actuators[0], 0.0, 1.0),
                        std::clamp(actuators[2], -max_rad, max_rad),
                        std::clamp(actuators[1], -max_rad, max_rad));
  const auto moved = [&](double s, const Rate& rate) {
    AircraftState x = state_;
    x.velocity += s * rate.velocity;
    x.rates += s * rate.rates;
    x.q_NB.coeffs() += s * rate.q;
    x.p_N += s * rate.p_N;
    x.controls += s * rate.controls;
    return x;
  };
  const Rate k1 = derivative(state_, wanted, time_s_);
  const Rate k2 = derivative(moved(0.5 * dt_s, k1), wanted, time_s_ + 0.5 * dt_s);
  const Rate k3 = derivative(moved(0.5 * dt_s, k2), wanted, time_s_ + 0.5 * dt_s);
  const Rate k4 = derivative(moved(dt_s, k3), wanted, time_s_ + dt_s);
  const auto mean = [&](auto member) {
    return ((k1.*member + k4.*member) + 2.0 * (k2.*member + k3.*member)).eval();
  };
  state_ = moved(dt_s / 6.0, {mean(&Rate::velocity), mean(&Rate::rates), mean(&Rate::p_N),
                              mean(&Rate::controls), mean(&Rate::q)});
  state_.q_NB.normalize();
  time_s_ += dt_s;
}

Odometry AircraftSim::truth() const {
  // Body and world are both turned: v_W = T R_NB T' v_B with the turns above.
  const Eigen::Matrix3d R_NB = state_.q_NB.toRotationMatrix();
  Eigen::Matrix3d R_WB;
  for (int i = 0; i < 3; ++i) R_WB.col(i) = world_turned(R_NB * body_turned(Vector3d::Unit(i)));
  Odometry truth;
  truth.X_WB = {Quaterniond(R_WB), world_turned(state_.p_N)};
  truth.v_WB_B = body_turned(state_.velocity);
  truth.w_WB_B = body_turned(state_.rates);
  return truth;
}

Vector3d AircraftSim::angles() const {
  const Eigen::Matrix3d R = state_.q_NB.toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Matrix<double, 6, 1> AircraftSim::accelerations() const {
  const Rate rate = derivative(state_, state_.controls, time_s_);
  Eigen::Matrix<double, 6, 1> both;
  both << rate.velocity, rate.rates;
  return both;
}

}  // namespace vinerow::test
