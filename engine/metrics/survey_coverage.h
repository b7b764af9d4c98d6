#pragma once
/// What the pictures of a survey show of the parcel: coverage, overlap, ground sampling distance.
/// The results are those of engine/metrics/picture_coverage.h, where each is defined.
///
/// Vehicles without wings have no such results, unless the file names their camera. Every picture
/// that the camera writes counts; which lane it was taken on is told by the plan
/// (PlanStretch::lane), by where the vehicle truly was and went. Without a plan all pictures belong
/// to one lane. Pictures that are taken faster than the metric's rate are missed.

#include <memory>

#include "engine/api/registry.h"
#include "engine/metrics/picture_coverage.h"

namespace vinerow::metrics {

PartSpec survey_coverage_spec();
/// Of its parameters; the parcel is empty where none is given.
/// @throws ConfigError if polygon_x_m and polygon_y_m differ in length
CoverageOptions read_coverage_options(const ParameterSet& parameters);
/// @throws ConfigError if only one of polygon_x_m and polygon_y_m is given, or they differ in
/// length, or as check_coverage_options()
std::unique_ptr<Metric> make_survey_coverage(const ParameterSet& parameters,
                                             const MetricContext& context);

}  // namespace vinerow::metrics
