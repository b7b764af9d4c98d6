#pragma once
/// Survey metric: coverage, overlap and ground sampling distance of a parcel's pictures.
/// engine/metrics/picture_coverage.h defines the results.
///
/// Vehicles without wings have no such results, unless the scenario names their camera. Every
/// picture that the camera writes counts. Its lane is that of the plan (PlanStretch::lane) at the
/// vehicle's true position and direction of motion. Without a plan, all pictures belong to one
/// lane. Pictures that are taken faster than the metric's rate are missed.

#include <memory>

#include "engine/api/registry.h"
#include "engine/metrics/picture_coverage.h"

namespace vinerow::metrics {

PartSpec survey_coverage_spec();
/// Coverage options from the metric's parameters; the parcel is empty if they contain none.
/// @throws ConfigError if polygon_x_m and polygon_y_m differ in length
CoverageOptions read_coverage_options(const ParameterSet& parameters);
/// @throws ConfigError if only one of polygon_x_m and polygon_y_m is given, or they differ in
/// length, or as check_coverage_options()
std::unique_ptr<Metric> make_survey_coverage(const ParameterSet& parameters,
                                             const MetricContext& context);

}  // namespace vinerow::metrics
