/// Every scenario in assets/scenarios loads, runs for a short while and stays sane; the demo is
/// driven whole.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/nets/segmentation_net.h"
#include "engine/sim/judge.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"
#include "tests/scenarios/command.h"
#include "tests/support/paths.h"
#include "tools/parts/register_all.h"
#include "vinerow/testing.h"

namespace vinerow::shipped_scenarios_test {
namespace {

using testing::TestRun;

std::vector<std::string> shipped_scenarios() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(VINEROW_SOURCE_DIR) + "/assets/scenarios")) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Planting a large vineyard takes longer than all else here, under sanitizers minutes: four of its
/// rows do.
std::vector<std::string> with_few_rows(const scenario::Scenario& scenario) {
  if (scenario.world.type != "vineyard") return {};
  const bool is_large = scenario.world.parameters.integer("row_count") > 16;
  // A mission's vehicles are built on row meshes once before it begins.
  return is_large || !scenario.phases.empty() ? std::vector<std::string>{"world.row_count=4"}
                                              : std::vector<std::string>{};
}

/// Of a mission: whether its phase waits for another.
bool waits(const scenario::Scenario& scenario, const std::string& vehicle) {
  for (const scenario::PhaseConfig& phase : scenario.phases) {
    const bool works = std::count(phase.vehicles.begin(), phase.vehicles.end(), vehicle) > 0;
    if (works && (!phase.after.empty() || phase.weather)) return true;
  }
  return false;
}

/// Whether it sets out within 3 s: who has no controller stands, and who starts later or takes
/// commands from outside waits.
bool moves_soon(const scenario::VehicleConfig& vehicle) {
  if (!vehicle.controller || vehicle.controller->type.starts_with("remote_")) return false;
  if (!vehicle.guidance) return true;
  const auto& specs = vehicle.guidance->parameters.specs();
  const bool has_start = std::any_of(
      specs.begin(), specs.end(), [](const ParameterSpec& spec) { return spec.name == "start_s"; });
  return !has_start || vehicle.guidance->parameters.number("start_s") <= 2.0;
}

/// Whether a part of the scenario declares the result, with such a value.
void expect_declared(const scenario::Scenario& scenario, const Registry& registry,
                     const std::string& name, double value) {
  const ResultSpec* result = find_declared_result(scenario, registry, name);
  ASSERT_TRUE(result) << name << " is not declared";
  EXPECT_TRUE(std::isnan(value) || result->range.can_be_in(value, value)) << name << " = " << value;
}

class ShippedScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedScenario, RunsAShortWhile) {
  const std::string file = test::scenario_file(GetParam());
  if (GetParam() == "vineyard_row_net" && !nets::why_no_nets().empty()) {
    GTEST_SKIP() << nets::why_no_nets();
  }
  Registry registry;
  register_all(registry);
  TestRun run = TestRun::from_file(file, with_few_rows(scenario::load_scenario(file, registry)));
  run.run_for_s(3.0);
  for (const scenario::VehicleConfig& vehicle : run.simulation().scenario().vehicles) {
    if (waits(run.simulation().scenario(), vehicle.name)) {
      EXPECT_TRUE(std::isnan(run.metric(vehicle.name, "distance_m"))) << vehicle.name;
      continue;
    }
    // Who stands settles on its springs at most.
    if (moves_soon(vehicle)) {
      EXPECT_GT(run.metric(vehicle.name, "distance_m"), 0.5) << vehicle.name;
    } else {
      EXPECT_LT(run.metric(vehicle.name, "distance_m"), 0.05) << vehicle.name;
    }
    EXPECT_EQ(run.metric(vehicle.name, "contact_count"), 0.0) << vehicle.name;
  }
  for (const auto& vehicle : run.simulation().vehicles()) {
    for (const auto& [name, value] : vehicle->metric_results()) {
      expect_declared(run.simulation().scenario(), registry, vehicle->name() + "." + name, value);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(All, ShippedScenario, ::testing::ValuesIn(shipped_scenarios()),
                         [](const auto& parameter) { return parameter.param; });

/// Whether a vehicle that acts takes its state, or part of it, from the truth all the time.
bool goes_by_truth(const scenario::VehicleConfig& vehicle) {
  // Those that take commands from outside use no estimate.
  if (!vehicle.controller || vehicle.controller->type.starts_with("remote_")) return false;
  if (!vehicle.estimator || vehicle.estimator->type == "truth") return true;
  const ParameterSet& parameters = vehicle.estimator->parameters;
  const auto& specs = parameters.specs();
  if (std::none_of(specs.begin(), specs.end(), [](const auto& s) { return s.name == "heading"; })) {
    return false;
  }
  const ParameterSet::Value* heading = parameters.find("heading");
  const std::string* text = heading ? std::get_if<std::string>(heading) : nullptr;
  return text && *text == "truth";
}

/// Papers A and B judge driving and flying on the true state; paper C's filters watch a flight by
/// it. Everything else is to find its own way: who adds a scenario here says why in
/// docs/reference/scenario.md.
TEST(ShippedScenarios, OnlyTheseGoByTheTruth) {
  const std::vector<std::string> expected = {"localisation_m100",
                                             "localisation_sensors_0",
                                             "localisation_sensors_1",
                                             "localisation_sensors_2",
                                             "localisation_sensors_4",
                                             "localisation_sensors_8",
                                             "orchard_rover",
                                             "quadrotor_gust",
                                             "riseholme_rover",
                                             "trmpc_stress",
                                             "vineyard_4ws_obstacle",
                                             "vineyard_4ws_parcel",
                                             "vineyard_4ws_two_rows",
                                             "vineyard_quadrotor_parcel",
                                             "vineyard_quadrotor_two_rows",
                                             "wet_soil_turn"};
  Registry registry;
  register_all(registry);
  std::vector<std::string> found;
  for (const std::string& name : shipped_scenarios()) {
    const scenario::Scenario scenario =
        scenario::load_scenario(test::scenario_file(name), registry);
    if (std::any_of(scenario.vehicles.begin(), scenario.vehicles.end(), goes_by_truth)) {
      found.push_back(name);
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(RiseholmeRover, DrivesAllNineAlleysWithinItsLimits) {
  TestRun run = TestRun::from_file(test::scenario_file("riseholme_rover"));
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.metric("rover", "alleys_driven"), 9.0);
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  EXPECT_LE(run.metric("rover", "cross_track_rms_m"), 0.05);
  RecordProperty("cross_track_rms_m", std::to_string(run.metric("rover", "cross_track_rms_m")));
}

TEST(Readme, ItsScenarioDrivesToTheEndWithinItsLimit) {
  const std::string page = test::read_text(std::string(VINEROW_SOURCE_DIR) + "/README.md");
  const std::string fence = "```yaml\n";
  const std::size_t begin = page.find(fence) + fence.size();
  TestRun run = TestRun::from_yaml(page.substr(begin, page.find("```", begin) - begin));
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  EXPECT_LE(run.metric("rover", "cross_track_rms_m"), 0.05);
}

/// The listing of docs/guides/plugins.md.
TEST(TestKit, ItsListingPasses) {
  auto run = testing::SmallWorld()
                 .vehicle("rover", "diff_drive_rover")
                 .planner("rover", "coverage")
                 .controller("rover", "pure_pursuit", "lookahead_m: 0.5")
                 .build();
  run.run_for_s(20.0);
  EXPECT_GT(run.metric("rover", "distance_m"), 5.0);
  EXPECT_LT(run.metric("rover", "cross_track_max_m"), 0.2);
}

class VineyardRover : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(VineyardRover, DrivesTheHillsideOnFixesAntennasInertialUnitAndWheels) {
  TestRun run = TestRun::from_file(test::scenario_file("vineyard_rover"),
                                   {"seed=" + std::to_string(GetParam())});
  run.run_to_end();
  std::printf("cross-track %.4f m, clearance %.3f m, estimate %.4f / %.4f m, %.2f deg, NEES %.2f\n",
              run.metric("rover", "cross_track_rms_m"), run.metric("rover", "min_clearance_m"),
              run.metric("rover", "estimate_lateral_rms_m"),
              run.metric("rover", "estimate_longitudinal_rms_m"),
              run.metric("rover", "estimate_yaw_rms_deg"), run.metric("rover", "nees_mean"));
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.metric("rover", "alleys_driven"), 15.0);
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  EXPECT_LE(run.metric("rover", "cross_track_rms_m"), 0.026);
  // It drives on an estimate, which has an error; the truth would have no error.
  EXPECT_GT(run.metric("rover", "estimate_yaw_rms_deg"), 0.05);
}
INSTANTIATE_TEST_SUITE_P(Seeds, VineyardRover, ::testing::Values(1, 2, 3),
                         [](const auto& seed) { return std::to_string(seed.param); });

TEST(RiseholmeRover, DrivesOnRawRtkFixesWithoutAFilter) {
  TestRun run = TestRun::from_file(test::scenario_file("riseholme_rover"),
                                   {"rover.estimator={type: gps_pose, heading: truth}"});
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  // 1.3 times the worst of seeds 1 to 5.
  EXPECT_LE(run.metric("rover", "cross_track_rms_m"), 0.007);
}

}  // namespace
}  // namespace vinerow::shipped_scenarios_test
