#pragma once
/// How a PX4 is started: its command line, its variables, its ports and its parameters.

#include <string>
#include <vector>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// Script with the parameters, in the program's folder. PX4's start script reads the first one of
/// this name in PATH.
inline constexpr const char* kPx4ParameterScript = "px4-rc.params";

int px4_port_of(const FirmwareParams& params);
int px4_mavlink_port_of(const FirmwareParams& params);

/// A command of one word gets the arguments of PX4's simulation in software: instance, no shell,
/// start script, PX4's files (the folder `etc` beside the program's `bin`). In longer ones
/// {instance} is replaced.
std::vector<std::string> px4_command(const FirmwareParams& params);

/// Variables of the program: "NAME=value".
std::vector<std::string> px4_environment(const FirmwareParams& params,
                                         const AutopilotContext& context);

/// Text of the script: parameters that fit the vehicle, replaced by those of the user.
/// @throws ConfigError if the user's file has a mistake
std::string px4_parameter_script(const FirmwareParams& params, const AutopilotContext& context);

}  // namespace vinerow::controllers
