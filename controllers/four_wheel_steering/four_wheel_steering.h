#pragma once
/// Controller `four_wheel_steering`: steering law and wheel speed QP of paper A, section 4.1.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec four_wheel_steering_spec();

/// @throws ConfigError if the vehicle lacks the two axle angles, the four wheel speeds or the
/// numbers that describe them
std::unique_ptr<Controller> make_four_wheel_steering(const ParameterSet& parameters,
                                                     const ControllerContext& context);

}  // namespace vinerow::controllers
