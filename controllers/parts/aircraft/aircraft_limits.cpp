#include "controllers/parts/aircraft/aircraft_limits.h"

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

constexpr AircraftRangesInDeg kRelaxed = {2.4, 3.0,   150.0, 20.0, 15.0, 0.25, 10.0,
                                          5.0, 250.0, 120.0, 45.0, 30.0, 12.0};

}  // namespace

AircraftLimits::AircraftLimits() : AircraftRanges(kRelaxed.to_si()) {}

const ParameterTable<AircraftLimits>& aircraft_limit_table() {
  using L = AircraftLimits;
  static const ParameterTable<L> table = ParameterTable<L>().group(
      "limits", [](L& limits) -> AircraftRanges& { return limits; }, aircraft_range_table(),
      "largest deviations from the reference's steady flight, on either side (paper A, section 2; "
      "defaults: the relaxed reading of its percentages)");
  return table;
}

}  // namespace vinerow::controllers
