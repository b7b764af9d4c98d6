#pragma once
/// Autopilot `replay`: the recording of one.

#include <memory>

#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec autopilot_replay_spec();
std::unique_ptr<Autopilot> make_autopilot_replay(const ParameterSet& parameters,
                                                 const AutopilotContext& context);

}  // namespace vinerow::controllers
