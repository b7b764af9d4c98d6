#include "vehicles/fixed_wing/fixed_wing_model.h"

#include <cmath>

#include "engine/core/check.h"

namespace vinerow::vehicles {

AirLoad FixedWingModel::load(const AirPoint& air, std::span<const double> actuators) const {
  VINEROW_ASSERT(actuators.size() == 3);
  return load(air, actuators[0] * actuators[0], {actuators[1], actuators[2]});
}

AirLoad FixedWingModel::load(const AirPoint& air, double throttle_square,
                             const Elevons& elevons) const {
  AirLoad load = calc_wing_load(wing_, air, elevons);
  const AirLoad propeller =
      calc_propeller_load(propeller_, air.air_density_kgm3, air.v_air_B.norm(), throttle_square);
  load.force_B += propeller.force_B;
  load.torque_B += propeller.torque_B;
  return load;
}

std::optional<LevelFlight> find_level_flight(const FixedWingParams& p, double airspeed_mps,
                                             double gravity_mps2, double air_density_kgm3) {
  const double pressure_N = 0.5 * air_density_kgm3 * airspeed_mps * airspeed_mps * p.wing.area_m2;
  const double weight_N = p.mass_kg * gravity_mps2;
  double thrust_N = 0.0, elevator_rad = 0.0;
  // What is left of lift and the propeller's pull over the weight, elevons and thrust in balance.
  const auto surplus_N = [&](double alpha_rad) {
    const double power = calc_lift_drag(p.wing, alpha_rad, {1.0, 1.0}).pitch;
    const double clean = calc_lift_drag(p.wing, alpha_rad, {}).pitch;
    elevator_rad = power == clean ? 0.0 : -clean / (power - clean);
    const LiftDrag c = calc_lift_drag(p.wing, alpha_rad, {elevator_rad, elevator_rad});
    thrust_N = pressure_N * c.drag / std::cos(alpha_rad);
    return pressure_N * c.lift + thrust_N * std::sin(alpha_rad) - weight_N;
  };
  double low_rad = -0.8 * p.wing.stall_angle_rad, high_rad = 0.8 * p.wing.stall_angle_rad;
  if (surplus_N(low_rad) > 0.0 || surplus_N(high_rad) < 0.0) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle_rad = 0.5 * (low_rad + high_rad);
    (surplus_N(middle_rad) > 0.0 ? high_rad : low_rad) = middle_rad;
  }
  LevelFlight flight;
  flight.alpha_rad = 0.5 * (low_rad + high_rad);
  surplus_N(flight.alpha_rad);
  flight.elevator_rad = elevator_rad;
  // Thrust grows with the square of the throttle from a constant.
  const double idle_N = calc_thrust_N(p.propeller, air_density_kgm3, 0.0, 1.0);
  if (!(idle_N > 0.0)) return std::nullopt;
  const double ratio = airspeed_mps / p.propeller.speed_mps;
  flight.throttle = std::sqrt(thrust_N / idle_N + ratio * ratio);
  if (flight.throttle > 1.0 || std::abs(elevator_rad) > p.elevon_limit_rad) return std::nullopt;
  return flight;
}

}  // namespace vinerow::vehicles
