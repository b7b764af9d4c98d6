#include "engine/sim/metrics/register.h"

#include "engine/sim/metrics/air_tracking.h"
#include "engine/sim/metrics/alley_place.h"
#include "engine/sim/metrics/clearance.h"
#include "engine/sim/metrics/estimation.h"
#include "engine/sim/metrics/flight.h"
#include "engine/sim/metrics/path_deviation.h"
#include "engine/sim/metrics/survey_coverage.h"
#include "engine/sim/metrics/travel.h"
#include "engine/sim/metrics/wheel_slip.h"
#include "engine/sim/truth_estimator.h"

namespace vinerow {

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

  PartSpec truth;
  truth.name = "truth";
  truth.description = "The estimate is the truth";
  truth.reads = {"truth"};
  truth.writes = {"estimate"};
  registry.add_estimator(truth, [](const ParameterSet&, const EstimatorContext&) {
    return std::make_unique<TruthEstimator>();
  });
}

}  // namespace vinerow
