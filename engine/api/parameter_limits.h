#pragma once
/// What a number in a unit can mean at all, where its parameter has no narrower range of its own.
///
/// Without it 9.2e18 m for a sensor's place and 1e-308 m/s2 for an acceleration are valid, and the
/// first ray or the first plan ends in an overflow.

#include "engine/api/parameters.h"

namespace vinerow {

/// The spec with the ends of its range that are open closed by its unit: a length at 10,000 km, a
/// time at 30 years, a speed at 10 km/s (parameter_limits.cpp has them all), other units at 1e15.
/// What must be above 0 is at least 1e-9 (1e-15 in other units). Whole numbers keep theirs.
ParameterSpec with_limits_of_unit(ParameterSpec spec);

}  // namespace vinerow
