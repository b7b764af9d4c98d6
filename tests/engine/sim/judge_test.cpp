#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/metrics/register_metrics.h"
#include "engine/sim/judge.h"

namespace vinerow::judge_test {
namespace {

scenario::Criterion criterion(const std::string& metric, std::optional<double> min,
                              std::optional<double> max) {
  scenario::Criterion result;
  result.name = result.metric = metric;
  result.min = min;
  result.max = max;
  return result;
}

TEST(Judge, LimitsAreInclusiveAndWhatWasNotMeasuredFails) {
  const std::map<std::string, std::map<std::string, double>> metrics{
      {"rover", {{"a_m", 1.0}, {"b", std::nan("")}}}};
  const auto verdicts = judge({criterion("rover.a_m", {}, 1.0), criterion("rover.a_m", 1.5, {}),
                               criterion("rover.b", {}, 1e9), criterion("rover.b", -1e9, {}),
                               criterion("rover.a_m", 1.0, {})},
                              metrics);
  ASSERT_EQ(verdicts.size(), 5u);
  EXPECT_TRUE(verdicts[0].met);
  EXPECT_FALSE(verdicts[1].met);
  EXPECT_EQ(verdicts[1].kind, "min");
  EXPECT_FALSE(verdicts[2].met);
  EXPECT_FALSE(verdicts[3].met) << "not measured is not enough";
  EXPECT_TRUE(verdicts[4].met);
  EXPECT_EQ(sentence_of(verdicts[1]), "rover.a_m = 1 (at least 1.5)");
  const auto zero = judge({criterion("rover.a_m", 0.0, {})}, {{"rover", {{"a_m", -0.0}}}});
  EXPECT_EQ(sentence_of(zero[0]), "rover.a_m = 0 (at least 0)");
}

TEST(Judge, UnknownMetricsAreRefusedWithTheNearest) {
  scenario::Criterion wrong = criterion("rover.cross_track_rms", {}, 0.1);
  wrong.where = {"x.yaml", 7};
  try {
    judge({wrong}, {{"rover", {{"cross_track_rms_m", 0.0}, {"distance_m", 0.0}}}});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "x.yaml:7: criteria: metric 'rover.cross_track_rms' does not exist; did you mean "
                 "'rover.cross_track_rms_m'? (known: rover.cross_track_rms_m, rover.distance_m)");
  }
}

TEST(Judge, ALongListOfMetricsIsCutWhereOneIsNear) {
  std::map<std::string, double> metrics{{"cross_track_rms_m", 0.0}, {"cross_track_max_m", 0.0}};
  for (int i = 0; i < 12; ++i) metrics[fmt::format("slip_rms_wheel_{}", i)] = 0.0;
  const auto refusal = [&](const std::string& metric) -> std::string {
    try {
      judge({criterion(metric, {}, 0.1)}, {{"rover", metrics}});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const std::string near = refusal("rover.cross_track_rms");
  EXPECT_NE(near.find("did you mean 'rover.cross_track_rms_m'? (known: rover.cross_track_rms_m, "
                      "rover.cross_track_max_m, "),
            std::string::npos)
      << near;
  EXPECT_TRUE(near.ends_with(" and 4 more; see 'vinerow list metric')")) << near;
  const std::string far = refusal("rover.temperature_of_the_motor_K");
  EXPECT_EQ(far.find("did you mean"), std::string::npos) << far;
  EXPECT_NE(far.find("rover.slip_rms_wheel_9)"), std::string::npos) << far;
}

/// The message about a criterion before the run, for a scenario with these metrics.
std::string refusal_of(const std::string& metric, std::optional<double> min,
                       std::optional<double> max, const std::vector<std::string>& types) {
  Registry registry;
  metrics::register_metrics(registry);
  scenario::Scenario scenario;
  for (const std::string& type : types) {
    scenario.metrics.push_back({type, {}});
    scenario.metrics.back().part.type = type;
    if (type != "a_plugin_s") continue;
    PartSpec of_a_plugin;
    of_a_plugin.name = type;
    registry.add_metric(of_a_plugin, {});
  }
  scenario::Criterion wanted = criterion(metric, min, max);
  wanted.where = {"x.yaml", 7};
  const std::string name = metric.substr(metric.find('.') + 1);
  try {
    check_criteria({wanted}, {{"rover", {{name, std::nan("")}}}}, [&](const std::string& full) {
      return find_declared_result(scenario, registry, full);
    });
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckCriteria, RefusesWhatNoValueMeets) {
  const auto refusal = [](const std::string& metric, std::optional<double> min,
                          std::optional<double> max) {
    return refusal_of("rover." + metric, min, max,
                      {"travel", "path_deviation", "survey", "wheel_slip", "estimation"});
  };
  EXPECT_EQ(refusal("finished", 1e9, {}),
            "x.yaml:7: criteria: no value of rover.finished meets min = 1e+09 (possible: 0 or 1)");
  EXPECT_EQ(refusal("finished", 0.2, 0.8),
            "x.yaml:7: criteria: no value of rover.finished meets min = 0.2 and max = 0.8 "
            "(possible: 0 or 1)");
  EXPECT_EQ(refusal("covered_share", 1.01, {}),
            "x.yaml:7: criteria: no value of rover.covered_share meets min = 1.01 (possible: "
            "0 to 1)");
  EXPECT_EQ(refusal("cross_track_rms_m", {}, -0.05),
            "x.yaml:7: criteria: no value of rover.cross_track_rms_m meets max = -0.05 "
            "(possible: from 0)");
  EXPECT_EQ(refusal("alleys_driven", 8.2, 8.8),
            "x.yaml:7: criteria: no value of rover.alleys_driven meets min = 8.2 and max = 8.8 "
            "(possible: whole numbers from 0)");
  // Of a wheel, of an observer, of a source.
  EXPECT_NE(refusal("slip_max_front_left", 2.5, {}), "");
  EXPECT_NE(refusal("no_map_consistent", 2, {}), "");
  EXPECT_NE(refusal("nis_range_mean", {}, -1), "");
  EXPECT_NE(refusal("no_map_nis_range_mean", {}, -1), "");
}

TEST(CheckCriteria, TheEndsOfARangeCanBeMet) {
  const std::vector<std::string> types{"travel", "alley_place", "survey"};
  EXPECT_EQ(refusal_of("rover.finished", 1, {}, types), "");
  EXPECT_EQ(refusal_of("rover.finished", {}, 0, types), "");
  EXPECT_EQ(refusal_of("rover.covered_share", 1, 1, types), "");
  EXPECT_EQ(refusal_of("rover.distance_m", 1e12, {}, types), "");
  EXPECT_EQ(refusal_of("rover.distance_m", {}, 0, types), "");
  EXPECT_EQ(refusal_of("rover.alleys_passed", 9, 9, types), "");
  // Either sign, and taken in where there is more to gain than to draw.
  EXPECT_EQ(refusal_of("rover.alley_offset_mean_m", -0.03, -0.01, types), "");
  EXPECT_EQ(refusal_of("rover.energy_J", {}, -10, types), "");
  // Says at least that it was measured.
  EXPECT_EQ(refusal_of("rover.standing_drift_m", 0, {}, types), "");
}

TEST(CheckCriteria, KnowsNoRangeOfWhatOthersMeasure) {
  EXPECT_EQ(refusal_of("rover.finished", 5, {}, {"a_plugin_s"}), "");
  EXPECT_EQ(refusal_of("rover.sprayer_litres_lost", {}, -1, {"travel"}), "");
}

TEST(CheckCriteria, KnowsWhatPayloadsDeclare) {
  Registry registry;
  PartSpec tank;
  tank.name = "tank";
  tank.results = {{"litres_left", "l", ResultRange::from_zero(), "left", "What is left.", ""}};
  registry.add_payload(tank, {});
  scenario::Scenario scenario;
  scenario.vehicles.resize(2);
  scenario.vehicles[0].name = "rover";
  scenario.vehicles[1].name = "drone";
  scenario.vehicles[0].payloads.push_back({"spray", {}});
  scenario.vehicles[0].payloads[0].part.type = "tank";
  const auto declared = [&](const char* metric) {
    return find_declared_result(scenario, registry, metric);
  };
  ASSERT_TRUE(declared("rover.spray_litres_left"));
  EXPECT_FALSE(declared("rover.spray_litres_left")->range.can_be_in(-2.0, -1.0));
  EXPECT_FALSE(declared("drone.spray_litres_left"));
  EXPECT_FALSE(declared("rover.spray_litres_lost"));
  EXPECT_FALSE(declared("rover.litres_left"));
  ASSERT_TRUE(declared("drone.min_vehicle_distance_m"));
}

TEST(CheckCriteria, RefusesMetricsThatDoNotExist) {
  EXPECT_THROW(check_criteria({criterion("rover.b", {}, 1.0)}, {{"rover", {{"a", 0.0}}}},
                              [](const std::string&) { return nullptr; }),
               ConfigError);
}

}  // namespace
}  // namespace vinerow::judge_test
