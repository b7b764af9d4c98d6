#pragma once
/// The limits that every hand-tuned flight controller keeps, as parameters: tilt, thrust, torques,
/// speeds at which errors are won back.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/rotor_mixer.h"
#include "engine/api/parameters.h"

namespace vinerow {

struct FlightLimits {
  double tilt_rad = 0.0;
  double min_thrust_N = 0.0, max_thrust_N = 0.0;
  Eigen::Vector3d torque_Nm = Eigen::Vector3d::Zero();
  double correction_mps = 0.0;        ///< towards the reference, horizontally
  double climb_correction_mps = 0.0;  ///< the same up and down
  double yaw_rate_radps = 0.0;        ///< towards the wanted heading
};

/// `tilt_limit_deg`, `min_thrust`, `max_thrust` (in weights), `torque_share` (of what hover leaves
/// room for), `correction_speed_mps`, `climb_correction_mps`, `yaw_rate_limit_degps`.
std::vector<ParameterSpec> flight_limit_parameters();

/// max_thrust is cut to what the rotors have. The parameters' ranges leave room about the weight.
FlightLimits read_flight_limits(const ParameterSet& parameters, const RotorcraftModel& craft,
                                const RotorMixer& mixer);

}  // namespace vinerow
