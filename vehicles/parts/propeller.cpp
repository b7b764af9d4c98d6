#include "vehicles/parts/propeller.h"

#include <algorithm>

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {
namespace {

constexpr double kRatedDensity_kgm3 = 1.225;

}  // namespace

void PropellerParams::validate(const std::string& who) const {
  demand_positive(who, "propeller_area_m2", area_m2);
  demand_range(who, "propeller_coefficient", coefficient, 0.0, 2.0);
  demand_positive(who, "propeller_speed_mps", speed_mps);
  demand_range(who, "propeller_windmill", windmill, 0.0, 1.0);
  demand_range(who, "propeller_torque_Nm", torque_Nm, -100.0, 100.0);
  demand_range(who, "propulsion_efficiency", efficiency, 0.01, 1.0);
  demand_range(who, "throttle_lag_s", lag_s, 0.0, 10.0);
}

double calc_thrust_N(const PropellerParams& p, double air_density_kgm3, double airspeed_mps,
                     double throttle_square) {
  const double thrust_N =
      0.5 * air_density_kgm3 * p.area_m2 * p.coefficient *
      (p.speed_mps * p.speed_mps * throttle_square - airspeed_mps * airspeed_mps);
  return thrust_N < 0.0 ? p.windmill * thrust_N : thrust_N;
}

AirLoad calc_propeller_load(const PropellerParams& p, double air_density_kgm3, double airspeed_mps,
                            double throttle_square) {
  AirLoad load;
  load.force_B.x() = calc_thrust_N(p, air_density_kgm3, airspeed_mps, throttle_square);
  load.torque_B.x() = -p.torque_Nm * air_density_kgm3 / kRatedDensity_kgm3 * throttle_square;
  return load;
}

double calc_propeller_power_W(const PropellerParams& p, double thrust_N, double airspeed_mps,
                              double throttle) {
  return std::max(0.0, thrust_N) * 0.5 * (p.speed_mps * throttle + airspeed_mps) / p.efficiency;
}

std::vector<ParameterSpec> propeller_parameter_specs() {
  const PropellerParams d;
  return {
      positive_parameter("propeller_area_m2", "m2", d.area_m2, "S_p, area of the disc"),
      number_parameter("propeller_coefficient", "", d.coefficient, 0, 2, "C_p"),
      positive_parameter("propeller_speed_mps", "m/s", d.speed_mps,
                         "k, speed of the air behind the disc at full throttle"),
      number_parameter("propeller_windmill", "", d.windmill, 0, 1,
                       "share of the thrust that brakes below the throttle V / k; 0: it folds"),
      number_parameter("propeller_torque_Nm", "N m", d.torque_Nm, -100, 100,
                       "reaction at full throttle, > 0 rolls left"),
      number_parameter("propulsion_efficiency", "", d.efficiency, 0.01, 1,
                       "power of an ideal disc over electric power"),
      number_parameter("throttle_lag_s", "s", d.lag_s, 0, 10,
                       "time constant of motor and propeller"),
  };
}

PropellerParams read_propeller_params(const ParameterSet& parameters) {
  PropellerParams p;
  p.area_m2 = parameters.number("propeller_area_m2");
  p.coefficient = parameters.number("propeller_coefficient");
  p.speed_mps = parameters.number("propeller_speed_mps");
  p.windmill = parameters.number("propeller_windmill");
  p.torque_Nm = parameters.number("propeller_torque_Nm");
  p.efficiency = parameters.number("propulsion_efficiency");
  p.lag_s = parameters.number("throttle_lag_s");
  return p;
}

}  // namespace vinerow::vehicles
