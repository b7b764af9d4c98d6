#pragma once
/// A rover follows an alley from its range sensors.

#include <memory>

#include "python/tasks/task.h"

namespace vinerow::tasks {

/// Task row_following. Sensors `left_front`, `left_rear`, `right_front`, `right_rear` (RangeSample)
/// and `imu` (ImuSample); no position. The agent commands speed and yaw rate.
TaskSpec row_following_spec();
std::unique_ptr<Task> make_row_following(const ParameterSet& parameters,
                                         const TaskContext& context);

/// Task spraying: the same rover with payload `sprayer`, rewarded for canopy that received its
/// dose, and charged for time.
TaskSpec spraying_spec();
std::unique_ptr<Task> make_spraying(const ParameterSet& parameters, const TaskContext& context);

}  // namespace vinerow::tasks
