#pragma once
/// Autopilot `ardupilot`: an ArduPilot that runs.

#include <memory>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/mavlink/firmware_link.h"
#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec ardupilot_spec();
std::unique_ptr<Autopilot> make_ardupilot(const ParameterSet& parameters,
                                          const AutopilotContext& context);

/// Its MAVLink. See firmware_link_options().
FirmwareLinkOptions ardupilot_link_options(const FirmwareParams& params);

}  // namespace vinerow::controllers
