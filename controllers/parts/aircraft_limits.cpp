#include "controllers/parts/aircraft_limits.h"

namespace vinerow {
namespace {

constexpr AircraftRangesInDeg kRelaxed = {2.4, 3.0,   150.0, 20.0, 15.0, 0.25, 10.0,
                                          5.0, 250.0, 120.0, 45.0, 30.0, 12.0};

}  // namespace

AircraftLimits::AircraftLimits() : AircraftRanges(kRelaxed.to_si()) {}

ParameterSpec aircraft_limit_parameter() {
  return aircraft_range_parameter(
      "limits", kRelaxed,
      "largest deviations from the reference's steady flight, to either side (paper A, section 2; "
      "defaults: the relaxed reading of its percentages)");
}

AircraftLimits read_aircraft_limits(const ParameterSet& parameters) {
  return AircraftLimits(read_aircraft_ranges(parameters, "limits", kRelaxed));
}

}  // namespace vinerow
