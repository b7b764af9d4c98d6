#pragma once
/// Consistency check of a vehicle's description. The kernel does not call it; tests of vehicles do,
/// such as tests/vehicles/conformance_test.cpp for every registered vehicle.

#include <optional>
#include <string>

#include "engine/api/vehicle.h"

namespace vinerow {

/// Checks the fields that every vehicle has and each record that it fills: finite numbers of the
/// right sign, actuator names that match the record, an outline that contains the wheels, a
/// collision box clear of level ground, rotors within the circle of their tips, a cruise speed
/// above the stall speed.
/// @returns the first fault as a sentence, "wheeled.track_m = -1, must be > 0"; nullopt if there is
/// none
std::optional<std::string> find_fault(const VehicleDescription& vehicle);

}  // namespace vinerow
