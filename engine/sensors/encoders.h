#pragma once
/// Encoders on a vehicle's actuators: steering angles and wheel speeds as the vehicle measures
/// them.
///
/// reading = resolution * round((true + white noise) / resolution); a resolution of 0 does not
/// round. Writes NamedValues with the actuators' names, in their order. Actuators in rad use the
/// angle parameters, those in rad/s the speed parameters. In an outage every value is +infinity.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec encoders_spec();
/// @throws ConfigError if the vehicle does not model its actuator states, or one is neither an
/// angle nor a rate
std::unique_ptr<Sensor> make_encoders(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
