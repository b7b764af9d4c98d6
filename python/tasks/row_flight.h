#pragma once
/// A quadrotor flies along an alley in gusts.

#include <memory>

#include "python/tasks/task.h"

namespace vinerow::tasks {

/// Task row_flight. Sensors `left`, `right` and `down` (RangeSample); velocity, attitude and yaw
/// rate of the estimate, as an autopilot has them. The agent commands velocity and yaw rate to the
/// scenario's controller (ReferenceTrajectory), as a companion computer does.
TaskSpec row_flight_spec();
std::unique_ptr<Task> make_row_flight(const ParameterSet& parameters, const TaskContext& context);

}  // namespace vinerow::tasks
