#pragma once
/// A fixture for runs of the small parts (small_parts.h), each in a folder of its own.

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/metrics/register_metrics.h"
#include "engine/sim/truth_estimator.h"
#include "engine/run/run.h"
#include "tests/engine/sim/small_parts.h"
#include "tests/support/folder_test.h"

namespace vinerow::test {

class RunFixture : public FolderTest {
 protected:
  /// @param yaml  the scenario
  explicit RunFixture(std::string yaml, Registry registry = small_registry())
      : FolderTest("run"), registry_(std::move(registry)), yaml_(std::move(yaml)) {
    metrics::register_metrics(registry_);
    register_truth_estimator(registry_);
  }

  run::RunResult run(const std::vector<std::string>& sets = {}) {
    scenario::Overrides overrides;
    overrides.sets = sets;
    options_.out = folder_;
    return run::run_scenario(scenario::parse_scenario(yaml_, ".", registry_, overrides), registry_, options_);
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(std::ifstream(folder_ / "summary.json"));
  }

  Registry registry_;
  run::RunOptions options_ = [] {
    run::RunOptions options;
    options.pictures = false;
    return options;
  }();

 private:
  std::string yaml_;
};

}  // namespace vinerow::test
