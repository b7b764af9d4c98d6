#pragma once
/// Limits common to all hand-tuned flight controllers, as parameters: tilt, thrust, torques and
/// speeds of correction.

#include <Eigen/Core>

#include "controllers/parts/rotorcraft/rotor_mixer.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct FlightLimits {
  double tilt_rad = 0.0;
  double min_thrust_N = 0.0, max_thrust_N = 0.0;
  Eigen::Vector3d torque_Nm = Eigen::Vector3d::Zero();
  double correction_mps = 0.0;        ///< towards the reference, horizontally
  double climb_correction_mps = 0.0;  ///< the same up and down
  double yaw_rate_radps = 0.0;        ///< towards the wanted heading
};

/// The same limits, independent of the vehicle's size.
struct FlightLimitParams {
  double tilt_rad = rad_from_deg(25.0);
  double min_thrust = 0.3, max_thrust = 2.0;  ///< in weights
  double torque_share = 0.7;                  ///< of the torque limits at hover thrust
  double correction_mps = 2.0;
  double climb_correction_mps = 1.0;
  double yaw_rate_radps = rad_from_deg(60.0);
};

/// `tilt_limit_deg`, `min_thrust`, `max_thrust`, `torque_share`, `correction_speed_mps`,
/// `climb_correction_mps`, `yaw_rate_limit_degps`.
const ParameterTable<FlightLimitParams>& flight_limit_table();

/// Tilt and max_thrust are clamped to those of the vehicle. The parameters' ranges enclose the
/// weight.
FlightLimits make_flight_limits(const FlightLimitParams& params, const RotorcraftModel& craft,
                                const RotorMixer& mixer);

}  // namespace vinerow::controllers
