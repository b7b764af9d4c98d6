#pragma once
/// Position of a vehicle between the true rows, independent of its map.
///
/// The walls of an alley are the sides of its two rows' canopy: the true centre lines, moved
/// towards each other by half the canopy's width. A vehicle is in the alley if its origin is
/// between the two lines, beside both of them (not beyond an end), lower than the higher canopy
/// and, if it has a plan, on a leg of it. This excludes take-off, landing and flight above the
/// rows. Alleys with a row on one side only are ignored. Results:
///   alley_offset_mean_m: mean signed distance from the middle between the walls, positive to the
///     left of the alley's own direction, in whichever direction it is passed; it shows a map that
///     is shifted against the vineyard
///   alley_offset_rms_m, alley_offset_max_m: of the absolute value of that distance
///   alley_height_min_m, alley_height_max_m: for flying vehicles, origin above the true ground
///   alleys_passed: number of true alleys passed from one end to the other
/// NaN if the vehicle never was in an alley. Cost: two nearest points on rows for each tick;
/// outside all alleys, up to two for each alley.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& alley_place_results();
PartSpec alley_place_spec();
std::unique_ptr<Metric> make_alley_place(const ParameterSet& parameters,
                                         const MetricContext& context);

}  // namespace vinerow::metrics
