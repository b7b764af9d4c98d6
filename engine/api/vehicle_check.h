#pragma once
/// Whether a vehicle's description is complete and consistent. The kernel does not ask: a test of a
/// vehicle does, as tests/vehicles/conformance_test.cpp does of every registered one.

#include <optional>
#include <string>

#include "engine/api/vehicle.h"

namespace vinerow {

/// Looks at what every vehicle tells and at each record that it fills: numbers finite and of the
/// right sign, actuators of the names that go with the record, an outline that holds the wheels, a
/// collision box clear of level ground, rotors within the circle of their tips, a cruise above the
/// stall.
/// @returns the first fault as a sentence, "wheeled.track_m = -1, must be > 0"; nullopt: none
std::optional<std::string> find_fault(const VehicleDescription& vehicle);

}  // namespace vinerow
