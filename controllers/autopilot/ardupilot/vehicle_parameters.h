#pragma once
/// Parameters of ArduPilot that fit a vehicle of ours.

#include <vector>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// What follows from the vehicle's description: functions of the outputs, frame, speeds, hover
/// thrust; from the sensors that the firmware gets; and what any simulated vehicle needs: marks of
/// calibrated sensors, no log (its thread would keep runs from repeating).
/// Names and meanings: ArduPilot 4.6.3.
std::vector<FirmwareParameter> vehicle_parameters(const FirmwareParams& params,
                                                  const AutopilotContext& context);

}  // namespace vinerow::controllers
