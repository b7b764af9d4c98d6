#pragma once
/// Outputs of PX4: which one drives what, and what PX4 calls it.

#include <string>
#include <vector>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

/// HIL_ACTUATOR_CONTROLS has 16.
inline constexpr int kPx4Outputs = 16;

/// Channels of the scenario, or those that PX4's frames have: motors of a quadrotor front right,
/// rear left, front left, rear right; left and right wheels; steering, then throttle; elevons, then
/// throttle.
/// @throws ConfigError if the vehicle does not fit the mixer
std::vector<OutputChannel> px4_output_channels(const FirmwareParams& params,
                                               const VehicleDescription& vehicle,
                                               const std::string& who);

/// Number of a function in PX4's parameters PWM_MAIN_FUNCn: 101 is the first motor, 201 the first
/// servo.
int px4_function_number(const std::string& function);

}  // namespace vinerow::controllers
