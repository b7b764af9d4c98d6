#pragma once
/// Where a vehicle is between the rows as they are: against the true world, whatever its map and
/// its plan say.
///
/// The walls of an alley are the sides of its two rows' canopy: their true centre lines moved
/// towards each other by half of the canopy's width. A vehicle is in the alley where its origin
/// lies between the two lines, beside both of them (not beyond an end), lower than the higher
/// canopy, and, if it has a plan, on a leg of it: take-off, landing and ways above the rows are
/// left out. Alleys with a row on one side only have no middle and are left out. Results:
///   alley_offset_mean_m  of the signed distance from the middle between the walls, positive to the
///     left of the alley's own direction, whichever way it is passed: a map that lies beside the
///     vineyard shows here
///   alley_offset_rms_m, alley_offset_max_m  size of that distance
///   alley_height_min_m, alley_height_max_m  of what flies: origin above the true ground
///   alleys_passed  true alleys passed from one end to the other
/// NaN where it never was in an alley. Cost: two nearest points on rows a tick; in no alley, two
/// for each alley.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& alley_place_numbers();
PartSpec alley_place_spec();
std::unique_ptr<Metric> make_alley_place(const ParameterSet& parameters,
                                         const MetricContext& context);

}  // namespace vinerow::metrics
