#pragma once
/// How an ArduPilot is started: its command line, its ports and its parameters.

#include <string>
#include <vector>

#include "controllers/autopilot/ardupilot/ardupilot_params.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

int lockstep_port_of(const ArdupilotParams& params);
int mavlink_port_of(const ArdupilotParams& params);

/// A command of one word gets all arguments that a repeatable run needs: the interface, home,
/// ports, a fixed start of the clock, an empty memory, the parameters. In longer ones {home},
/// {instance}, {address}, {mavlink} and {parameters} are replaced.
std::vector<std::string> start_command(const ArdupilotParams& params,
                                       const AutopilotContext& context);

/// Parameters of the scenario: those of the file, replaced by those of the list.
/// @throws ConfigError if the file has a mistake
std::vector<FirmwareParameter> user_parameters(const ArdupilotParams& params);

/// Parameters that fit the vehicle and its sensors, replaced by those of the user.
std::vector<FirmwareParameter> start_parameters(const ArdupilotParams& params,
                                                const AutopilotContext& context);

}  // namespace vinerow::controllers
