#include "engine/metrics/register_metrics.h"

#include <memory>
#include <vector>

#include "engine/metrics/air_tracking.h"
#include "engine/metrics/alley_place.h"
#include "engine/metrics/clearance.h"
#include "engine/metrics/estimation.h"
#include "engine/metrics/flight_metric.h"
#include "engine/metrics/path_deviation.h"
#include "engine/metrics/survey_coverage.h"
#include "engine/metrics/travel.h"
#include "engine/metrics/wheel_slip.h"

namespace vinerow::metrics {

namespace {

struct BuiltInMetric {
  PartSpec (*spec)();
  std::unique_ptr<Metric> (*make)(const ParameterSet&, const MetricContext&);
  const std::vector<MetricNumber>& (*numbers)();
};

constexpr BuiltInMetric kMetrics[] = {
    {path_deviation_spec, make_path_deviation, path_deviation_numbers},
    {clearance_spec, make_clearance, clearance_numbers},
    {alley_place_spec, make_alley_place, alley_place_numbers},
    {travel_spec, make_travel, travel_numbers},
    {wheel_slip_spec, make_wheel_slip, wheel_slip_numbers},
    {flight_spec, make_flight, flight_numbers},
    {estimation_spec, make_estimation, estimation_numbers},
    {air_tracking_spec, make_air_tracking, air_tracking_numbers},
    {survey_coverage_spec, make_survey_coverage, coverage_numbers}};

}  // namespace

void register_metrics(Registry& registry) {
  for (const BuiltInMetric& metric : kMetrics) registry.add_metric(metric.spec(), metric.make);
}

const MetricNumber* find_metric_number(const std::string& type, std::string_view name) {
  for (const BuiltInMetric& metric : kMetrics) {
    if (metric.spec().name == type) return find_number(metric.numbers(), name);
  }
  return nullptr;
}

}  // namespace vinerow::metrics
