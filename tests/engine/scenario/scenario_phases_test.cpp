/// The mission's graph in scenario files: what is read, and every fault by its sentence.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "tests/engine/scenario/scenario_fakes.h"

namespace vinerow::scenario::scenario_phases_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Registry mission_registry() {
  Registry registry = test::fake_registry();
  PartSpec camera = test::fake_spec("camera", {}, 20.0);
  camera.gives = ProductKind::kPictures;
  registry.add_sensor(camera, nullptr);
  PartSpec cloud =
      test::fake_spec("stereo", {positive_parameter("density_per_m2", "1/m2", 100.0, "of points")});
  cloud.takes = {{"pictures", ProductKind::kPictures, true, "to match"}};
  cloud.gives = ProductKind::kCloud;
  registry.add_job(cloud, nullptr);
  PartSpec map = test::fake_spec("mapper", {});
  map.takes = {{"cloud", ProductKind::kCloud, true, "to map"}};
  map.gives = ProductKind::kMap;
  registry.add_job(map, nullptr);
  PartSpec plan = test::fake_spec("plan", {required(text_parameter("vehicle", "", "to plan for"))});
  plan.takes = {{"map", ProductKind::kMap, false, "to plan on"}};
  plan.gives = ProductKind::kPlan;
  registry.add_job(plan, nullptr);
  return registry;
}

const char* const kVehicles = R"(vinerow: 1
world: {type: flat}
vehicles:
  plane: {type: cart, wheel_radius_m: 0.2, spawn: {alley: 0}, sensors: {eye: {type: camera}}, controller: {type: stop}}
  rover: {type: cart, wheel_radius_m: 0.2, spawn: {alley: 0}, controller: {type: stop}}
)";

Scenario read(const std::string& rest) {
  return parse_scenario(kVehicles + rest, ".", mission_registry());
}

std::string fault_of(const std::string& rest) {
  try {
    read(rest);
  } catch (const ConfigError& fault) {
    return fault.what();
  }
  return "";
}

const char* const kChain = R"(phases:
  survey: {vehicles: [plane], timeout_s: 700}
  cloud: {job: {type: stereo, density_per_m2: 500}, pictures: from survey}
  map: {job: {type: mapper}, cloud: from cloud, duration_s: 60}
  spray:
    vehicles: [rover]
    map: from map
    on_failure: continue
    weather: {max_wind_mps: 4}
    criteria: [{metric: rover.time_s, max: 9}]
)";

TEST(ScenarioPhases, AreReadWithWhatTheyWaitFor) {
  const Scenario scenario = read(kChain);
  ASSERT_EQ(scenario.phases.size(), 4u);
  EXPECT_THAT(scenario.phases[0].vehicles, ElementsAre("plane"));
  EXPECT_EQ(scenario.phases[0].timeout_s, 700.0);
  EXPECT_EQ(scenario.phases[1].job->type, "stereo");
  EXPECT_EQ(scenario.phases[1].job->parameters.number("density_per_m2"), 500.0);
  EXPECT_THAT(scenario.phases[1].after, ElementsAre("survey")) << "a product's giver is waited for";
  EXPECT_EQ(scenario.phases[2].duration_s, 60.0);
  EXPECT_EQ(scenario.phases[2].takes[0].kind, ProductKind::kCloud);
  EXPECT_EQ(scenario.phases[3].on_failure, OnFailure::kContinue);
  ASSERT_TRUE(scenario.phases[3].weather.has_value());
  EXPECT_EQ(scenario.phases[3].weather->max_wind_mps, 4.0);
  EXPECT_EQ(scenario.phases[3].weather->over_s, 30.0) << "its default";
  EXPECT_EQ(scenario.phases[3].criteria[0].metric, "rover.time_s");
}

TEST(ScenarioPhases, TheResolvedScenarioReadsBackTheSame) {
  const Scenario once = read(kChain);
  const Scenario again = parse_scenario(once.resolved_yaml, ".", mission_registry());
  EXPECT_EQ(again.resolved_yaml, once.resolved_yaml);
  EXPECT_EQ(again.phases.size(), 4u);
}

TEST(ScenarioPhases, AJobsNumbersCanBeCriteriaOfTheRun) {
  const std::string chain = kChain;
  EXPECT_EQ(read(chain + "criteria: [{metric: map.rows, min: 16}]\n").criteria.size(), 1u);
  EXPECT_THAT(fault_of(chain + "criteria: [{metric: mapp.rows, min: 16}]\n"),
              HasSubstr("unknown vehicle 'mapp'; did you mean 'map'?"));
}

struct Fault {
  const char* rest;
  const char* sentence;
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.sentence;
}

class ScenarioPhaseFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(ScenarioPhaseFaults, AreToldWithPlaceAndReason) {
  EXPECT_THAT(fault_of(GetParam().rest), HasSubstr(GetParam().sentence));
}

INSTANTIATE_TEST_SUITE_P(
    All, ScenarioPhaseFaults,
    ::testing::Values(
        Fault{
            "phases:\n  a: {vehicles: [plane], after: [b]}\n  b: {vehicles: [rover], after: [a]}\n",
            "scenario:7: phases.a: waits for itself: a waits for b waits for a"},
        Fault{"phases:\n  a: {vehicles: [plane, rover], after: [a]}\n",
              "phases.a: waits for itself: a waits for a"},
        Fault{"phases:\n  a: {vehicles: [plane], after: [bb]}\n  b: {vehicles: [rover]}\n",
              "scenario:7: phases.a.after: unknown phase 'bb'; did you mean 'b'? (known: a, b)"},
        Fault{
            "phases:\n  p: {job: {type: plan, vehicle: rover}}\n  a: {vehicles: [plane], plan: "
            "from "
            "p}\n  b: {vehicles: [rover]}\n",
            "scenario:8: phases.a.plan: phase 'p' plans for 'rover', but this phase uses 'plane'"},
        Fault{"phases:\n  a: {vehicles: [plane]}\n  b: {vehicles: [rovr]}\n",
              "phases.b.vehicles: unknown vehicle 'rovr'; did you mean 'rover'?"},
        Fault{"phases:\n  a: {vehicles: [plane]}\n",
              "vehicles.rover: is in no phase; add it to one, or remove its controller to keep "
              "it parked"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\n  b: {vehicles: [rover]}\n",
              "phases.b: uses 'rover' like phase 'a', but neither phase waits for the other"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\n  m: {job: {type: mapper}}\n",
              "scenario:8: phases.m.cloud must be given: 'from <phase>', the phase whose cloud the "
              "job 'mapper' takes"},
        Fault{
            "phases:\n  a: {vehicles: [plane, rover]}\n  m: {job: {type: mapper}, cloud: from a}\n",
            "phases.m.cloud: phase 'a' gives pictures, must give a cloud"},
        Fault{"phases:\n  a: {vehicles: [plane]}\n  b: {vehicles: [rover], map: from a}\n",
              "phases.b.map: phase 'a' gives pictures, must give a map"},
        Fault{"phases:\n  a: {vehicles: [plane], map: from b}\n  b: {vehicles: [rover]}\n",
              "phases.a.map: phase 'b' gives nothing, must give a map"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\n  c: {job: {type: stereo}, pictures: "
              "survey}\n",
              "phases.c.pictures = 'survey', must be 'from <phase>': the phase that gives the "
              "pictures"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\n  c: {job: {type: stereo}, pictures: from "
              "a/plane/ey}\n",
              "phases.c.pictures: phase 'a' gives pictures of plane/eye; write 'from a/plane/eye'"},
        Fault{"phases:\n  a: {vehicles: [plane, rover], job: {type: mapper}, cloud: from a}\n",
              "phases.a: has both vehicles and a job, must have one of them"},
        Fault{"phases:\n  a: {after: []}\n",
              "phases.a: has neither vehicles nor a job, must have one of them"},
        Fault{"phases:\n  a: {vehicles: [plane, rover], duration_s: 3}\n",
              "phases.a.duration_s: allowed for jobs only"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\n  m: {job: {type: mapr}, cloud: from a}\n",
              "phases.m.job.type = 'mapr': unknown job; did you mean 'mapper'?"},
        Fault{"phases:\n  a: {vehicles: [plane, rover], cloud: from a}\n",
              "phases.a.cloud: unknown key"},
        Fault{"phases:\n  rover: {vehicles: [plane, rover]}\n",
              "phases.rover: a phase cannot have the name of a vehicle"},
        Fault{"phases:\n  a: {vehicles: [plane, plane, rover]}\n",
              "phases.a.vehicles: 'plane' is named twice"},
        Fault{
            "phases:\n  a: {vehicles: [plane, rover]}\n  p: {job: {type: plan, vehicle: drone}}\n",
            "phases.p.job.vehicle: unknown vehicle 'drone'"},
        Fault{"traffic: {reserve_alleys: [rover, dron]}\n",
              "traffic.reserve_alleys: unknown vehicle 'dron'"},
        Fault{"traffic: {reserve_alleys: [rover, rover]}\n", "'rover' is named twice"},
        Fault{"traffic: {reserve_alleys: [rover]}\n",
              "traffic.reserve_alleys: 'rover' is named alone, must be at least 2 vehicles"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\npictures: {moments: [a + x]}\n",
              "pictures.moments: 'a + x', must be '<phase>' or '<phase> + <seconds>'"},
        Fault{"phases:\n  a: {vehicles: [plane, rover]}\npictures: {moments: [b + 3]}\n",
              "pictures.moments: 'b + 3': unknown phase 'b'"}));

}  // namespace
}  // namespace vinerow::scenario::scenario_phases_test
