#pragma once
/// Autopilots `ardupilot` and `replay`: an ArduPilot that runs, and the recording of one.

#include <memory>

#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec ardupilot_spec();
std::unique_ptr<Autopilot> make_ardupilot(const ParameterSet& parameters,
                                          const AutopilotContext& context);

PartSpec autopilot_replay_spec();
std::unique_ptr<Autopilot> make_autopilot_replay(const ParameterSet& parameters,
                                                 const AutopilotContext& context);

}  // namespace vinerow::controllers
