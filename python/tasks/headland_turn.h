#pragma once
/// A rover turns on the headland into the next alley.

#include <memory>

#include "python/tasks/task.h"

namespace vinerow::tasks {

/// Task headland_turn. The agent knows the vehicle's estimate and the place of the next alley, and
/// commands speed and yaw rate.
TaskSpec headland_turn_spec();
std::unique_ptr<Task> make_headland_turn(const ParameterSet& parameters,
                                         const TaskContext& context);

}  // namespace vinerow::tasks
