#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/sim/judge.h"

namespace vinerow::judge_test {
namespace {

io::Criterion criterion(const std::string& metric, std::optional<double> min,
                        std::optional<double> max) {
  io::Criterion result;
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
}

TEST(Judge, UnknownMetricsAreRefusedWithTheNearest) {
  io::Criterion wrong = criterion("rover.cross_track_rms", {}, 0.1);
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

}  // namespace
}  // namespace vinerow::judge_test
