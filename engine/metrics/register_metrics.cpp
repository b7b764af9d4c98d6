#include "engine/metrics/register_metrics.h"

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

void register_metrics(Registry& registry) {
  registry.add_metric(path_deviation_spec(), make_path_deviation);
  registry.add_metric(clearance_spec(), make_clearance);
  registry.add_metric(alley_place_spec(), make_alley_place);
  registry.add_metric(travel_spec(), make_travel);
  registry.add_metric(wheel_slip_spec(), make_wheel_slip);
  registry.add_metric(flight_spec(), make_flight);
  registry.add_metric(estimation_spec(), make_estimation);
  registry.add_metric(air_tracking_spec(), make_air_tracking);
  registry.add_metric(survey_coverage_spec(), make_survey_coverage);
}

}  // namespace vinerow::metrics
