#pragma once
/// How an ArduPilot is started: its command line, its ports and its parameters.

#include <string>
#include <vector>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// Name of the file with the parameters, in the program's folder.
inline constexpr const char* kParameterFile = "vinerow.parm";

int lockstep_port_of(const FirmwareParams& params);
int mavlink_port_of(const FirmwareParams& params);

/// A command of one word gets all arguments that a repeatable run needs: the interface, home,
/// ports, a fixed start of the clock, an empty memory, the parameters. In longer ones {home},
/// {instance}, {address}, {mavlink} and {parameters} are replaced.
std::vector<std::string> start_command(const FirmwareParams& params,
                                       const AutopilotContext& context);

/// Parameters that fit the vehicle and its sensors, replaced by those of the user.
std::vector<FirmwareParameter> start_parameters(const FirmwareParams& params,
                                                const AutopilotContext& context);

}  // namespace vinerow::controllers
