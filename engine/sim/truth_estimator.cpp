#include "engine/sim/truth_estimator.h"

#include <memory>

namespace vinerow {

void register_truth_estimator(Registry& registry) {
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
