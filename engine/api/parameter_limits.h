#pragma once
/// What a number in a unit can mean at all, where its parameter has no narrower range of its own.
///
/// Without it 9.2e18 m for a sensor's place and 1e-308 m/s2 for an acceleration are valid, and the
/// first ray or the first plan ends in an overflow.

#include "engine/api/parameters.h"

namespace vinerow {

/// The spec with the ends of its range that are open closed by its unit: lengths within 10,000 km,
/// times within 30 years, all else within 1e15; what must be above 0 is at least 1e-9 (1e-15 of
/// units other than lengths, times, speeds, accelerations and rates). Whole numbers keep theirs.
ParameterSpec with_limits_of_unit(ParameterSpec spec);

}  // namespace vinerow
