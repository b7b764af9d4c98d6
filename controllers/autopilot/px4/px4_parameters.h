#pragma once
/// Parameters of PX4 that fit a vehicle of ours.

#include <vector>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// What follows from the vehicle's description and its sensors: places of rotors and sensors,
/// functions of the outputs, speeds, hover thrust; and what any simulated vehicle needs.
/// Names and meanings: PX4 1.14.3.
std::vector<FirmwareParameter> px4_parameters(const FirmwareParams& params,
                                              const AutopilotContext& context);

/// PX4's number of the frame that fits the vehicle (SYS_AUTOSTART); px4_parameters() changes what
/// differs.
int px4_airframe(const VehicleDescription& vehicle);

}  // namespace vinerow::controllers
