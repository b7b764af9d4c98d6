#pragma once
/// Common implementation of the controllers `trmpc` and `mpc_nominal`: a Controller that runs
/// AircraftTube. It reads "estimate" and "reference" and writes "actuators", "deviation" and
/// "follower" through AircraftPorts. It also writes "tube" (NamedValues, see kTubeValues in the
/// source) and "controller_event": the strongest feasible gusts once, and when an axis leaves the
/// set of states for which its problem is feasible and when it returns.

#include <memory>
#include <string>

#include "controllers/parts/aircraft/aircraft_tube.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// @throws ConfigError as AircraftPorts and AircraftTube
std::unique_ptr<Controller> make_aircraft_mpc(const ControllerContext& context,
                                              const std::string& type,
                                              const AircraftTubeParams& params);

/// Declares the signal "tube" of a part.
void describe_aircraft_mpc_signals(PartSpec& spec);

}  // namespace vinerow::controllers
