#pragma once
/// What the controllers `trmpc` and `mpc_nominal` share: a Controller about AircraftTube, which
/// reads "estimate" and "reference", writes "actuators", "deviation" and "follower" through
/// AircraftPorts, and further "tube" (NamedValues, see kTubeValues in the source) and
/// "controller_event": the strongest feasible gusts once, and when an axis leaves the set of states
/// its problem is feasible for and is back.

#include <memory>
#include <string>

#include "controllers/parts/aircraft/aircraft_tube.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// @throws ConfigError as AircraftPorts and AircraftTube
std::unique_ptr<Controller> make_aircraft_mpc(const ControllerContext& context,
                                              const std::string& type,
                                              const AircraftTubeParams& params);

/// "tube" in scenario files' order of reading and writing.
void describe_aircraft_mpc_signals(PartSpec& spec);

}  // namespace vinerow::controllers
