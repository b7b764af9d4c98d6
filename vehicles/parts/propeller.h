#pragma once
/// Propeller with an electric motor, along x of B through the centre of mass. Source: Beard,
/// McLain, *Small Unmanned Aircraft*, 2012, eq. 4.15 (Bernoulli over the disc):
///   T = rho / 2 S_p C_p ((k d_t)^2 - V^2)
/// Below the throttle V / k it brakes (windmilling), by the share `windmill`: 0 for a folding
/// propeller. The power is that of an actuator disc, T (k d_t + V) / 2, over the efficiency. The
/// reaction torque rolls the vehicle to the left and grows with d_t^2.

#include <string>

#include "engine/api/flight_model.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

struct PropellerParams {
  double area_m2 = 0.0314;   ///< S_p
  double coefficient = 1.0;  ///< C_p
  double speed_mps = 25.0;   ///< k: speed of the air behind it at full throttle
  double windmill = 1.0;     ///< share of the braking thrust, 0..1
  double torque_Nm = 0.0;    ///< reaction at full throttle and 1.225 kg/m3
  double efficiency = 0.5;   ///< of propeller, motor and speed controller against the ideal disc
  double lag_s = 0.10;       ///< of d_t

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// propeller_area_m2, ..., propulsion_efficiency, throttle_lag_s
const ParameterTable<PropellerParams>& propeller_table();

/// Thrust, N. @param airspeed_mps  >= 0  @param throttle_square  d_t^2, or its mean over a step
double calc_thrust_N(const PropellerParams& params, double air_density_kgm3, double airspeed_mps,
                     double throttle_square);

/// Force and torque in B.
AirLoad calc_propeller_load(const PropellerParams& params, double air_density_kgm3,
                            double airspeed_mps, double throttle_square);

/// Electric power, W, >= 0: no energy is recovered.
double calc_propeller_power_W(const PropellerParams& params, double thrust_N, double airspeed_mps,
                              double throttle);

}  // namespace vinerow::vehicles
