#pragma once
/// Autopilot `px4`: a PX4 that runs.

#include <memory>

#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/mavlink/firmware_link.h"
#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec px4_spec();
std::unique_ptr<Autopilot> make_px4(const ParameterSet& parameters,
                                    const AutopilotContext& context);

/// Its MAVLink. See firmware_link_options().
FirmwareLinkOptions px4_link_options(const FirmwareParams& params);

}  // namespace vinerow::controllers
