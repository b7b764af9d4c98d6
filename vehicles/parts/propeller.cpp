#include "vehicles/parts/propeller.h"

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

constexpr double kRatedDensity_kgm3 = 1.225;

}  // namespace

void PropellerParams::validate(const std::string& who) const {
  propeller_table().validate(*this, who);
}

const ParameterTable<PropellerParams>& propeller_table() {
  using P = PropellerParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("propeller_area_m2", "m2", &P::area_m2, kPositive, "S_p, area of the disc")
          .number("propeller_coefficient", "", &P::coefficient, between(0.0, 2.0),
                  "C_p: propeller coefficient")
          .number("propeller_speed_mps", "m/s", &P::speed_mps, kPositive,
                  "k, speed of the air behind the disc at full throttle")
          .number("propeller_windmill", "", &P::windmill, between(0.0, 1.0),
                  "share of the thrust that brakes below the throttle V / k; 0: it folds")
          .number("propeller_torque_Nm", "N m", &P::torque_Nm, between(-100.0, 100.0),
                  "reaction at full throttle, > 0 rolls left")
          .number("propulsion_efficiency", "", &P::efficiency, between(0.01, 1.0),
                  "power of an ideal disc over electric power")
          .number("throttle_lag_s", "s", &P::lag_s, between(0.0, 10.0),
                  "time constant of motor and propeller");
  return table;
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

}  // namespace vinerow::vehicles
