#pragma once
/// Physical limits of a unit, for parameters without a narrower range of their own.
///
/// Without them 9.2e18 m for a sensor's place and 1e-308 m/s2 for an acceleration are valid, and
/// the first ray or plan overflows.

#include "engine/api/parameters.h"

namespace vinerow {

/// Closes the open ends of the spec's range by its unit: a length at 10,000 km, a time at 30 years,
/// a speed at 10 km/s (parameter_limits.cpp has all limits), other units at 1e15. A minimum that
/// excludes 0 becomes 1e-9 (1e-15 in other units). Integers keep their range.
ParameterSpec with_limits_of_unit(ParameterSpec spec);

}  // namespace vinerow
