/// Observers in a run: estimators beside the one that the vehicle acts on.

#include <gtest/gtest.h>

#include <memory>

#include "engine/record/log_reader.h"
#include "tests/engine/sim/small_run.h"

namespace vinerow::run::observer_run_test {
namespace {

/// The truth with an offset to the east and a covariance of one; writes one event.
class OffsetEstimator final : public Estimator {
 public:
  explicit OffsetEstimator(double offset_m) : offset_m_(offset_m) {}
  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    estimate_ = ports.write<Odometry>("estimate");
    state_ = ports.write<NamedValues>("estimator_state");
    event_ = ports.write<Event>("estimator_event");
  }
  void step(Time now) override {
    Odometry estimate = truth_.value();
    estimate.X_WB.p.x() += offset_m_;
    estimate.set_position_covariance(Eigen::Matrix3d::Identity());
    estimate_.write(now, estimate);
    state_.write(now, {{"nis_range"}, {2.0 * offset_m_}});
    if (now.ns == 100'000'000) event_.write(now, {Event::Level::kInfo, "", "looks on"});
  }

 private:
  double offset_m_;
  SignalReader<Odometry> truth_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<NamedValues> state_;
  SignalWriter<Event> event_;
};

const char* const kScenario = R"(
vinerow: 1
name: observed
duration_s: 1
world: {type: plain}
vehicles:
  rover:
    type: statue
    spawn: {x_m: 0, y_m: 0}
    estimator: {type: beside, offset_m: 0.5, rate_Hz: 10}
    observers:
      near: {type: beside, offset_m: 0.25, rate_Hz: 40}
      exact: {type: truth}
metrics: {estimation: {type: estimation, from_s: 0}}
)";

class ObserverRun : public test::RunFixture {
 protected:
  ObserverRun() : RunFixture(kScenario) {
    PartSpec offset_part;
    offset_part.name = "beside";
    offset_part.parameters = {
        number_parameter("offset_m", "m", 0.0, -10.0, 10.0, "to the east"),
        choice_parameter("heading", "gyro", {"gyro", "truth"}, "where it is from")};
    registry_.add_estimator(
        offset_part, [](const ParameterSet& parameters, const EstimatorContext&) {
          return std::make_unique<OffsetEstimator>(parameters.number("offset_m"));
        });
  }
};

TEST_F(ObserverRun, WritesUnderItsOwnNameAndIsJudgedByIt) {
  const auto metrics = run().metrics.at("rover");
  // The statue looks east and stands far from rows: what lies to the east is ahead.
  EXPECT_DOUBLE_EQ(metrics.at("estimate_longitudinal_rms_m"), 0.5);
  EXPECT_DOUBLE_EQ(metrics.at("near_longitudinal_rms_m"), 0.25);
  EXPECT_DOUBLE_EQ(metrics.at("near_lateral_rms_m"), 0.0);
  EXPECT_DOUBLE_EQ(metrics.at("nees_mean"), 0.25);
  EXPECT_DOUBLE_EQ(metrics.at("near_nees_mean"), 0.0625);
  EXPECT_DOUBLE_EQ(metrics.at("nis_range_mean"), 1.0);
  EXPECT_DOUBLE_EQ(metrics.at("near_nis_range_mean"), 0.5);
  EXPECT_TRUE(std::isnan(metrics.at("exact_longitudinal_rms_m"))) << "the truth has no error";

  const record::LogReader log(folder_ / "log.mcap");
  int own = 0, nears = 0, exacts = 0, states = 0;
  log.read<Odometry>("/rover/estimate", [&](Time, const Odometry& estimate) {
    EXPECT_DOUBLE_EQ(estimate.X_WB.p.x(), 0.5);
    ++own;
  });
  log.read<Odometry>("/rover/near", [&](Time, const Odometry& estimate) {
    EXPECT_DOUBLE_EQ(estimate.X_WB.p.x(), 0.25);
    ++nears;
  });
  log.read<Odometry>("/rover/exact", [&](Time, const Odometry&) { ++exacts; });
  log.read<NamedValues>("/rover/near_state", [&](Time, const NamedValues&) { ++states; });
  EXPECT_EQ(own, 11) << "0 to 1 s at 10 Hz";
  EXPECT_EQ(nears, 21) << "at 40 Hz, in the log as often as the truth";
  EXPECT_EQ(states, 41);
  EXPECT_EQ(exacts, 21) << "as often as a controller would, where no rate is said";
  std::vector<std::string> sources;
  log.read<Event>("/run/events", [&](Time, const Event& event) {
    if (event.text == "looks on") sources.push_back(event.source);
  });
  EXPECT_EQ(sources, (std::vector<std::string>{"rover.estimator", "rover.observers.near"}));
}

TEST_F(ObserverRun, TheSummarySaysWhatAVehicleTakesFromTheTruth) {
  const auto of_rover = [&](const std::string& set) {
    run({set});
    return summary()["estimation"]["rover"];
  };
  EXPECT_EQ(of_rover("rover.estimator.offset_m=0.5"),
            (nlohmann::json{{"estimator", "beside"}, {"truth", nlohmann::json::array()}}));
  EXPECT_EQ(of_rover("rover.estimator.heading=truth"),
            (nlohmann::json{{"estimator", "beside"}, {"truth", {"heading"}}}));
  EXPECT_EQ(of_rover("rover.estimator=null"),
            (nlohmann::json{{"estimator", nullptr}, {"truth", {"state"}}}));
  EXPECT_EQ(of_rover("rover.estimator={type: truth}"),
            (nlohmann::json{{"estimator", "truth"}, {"truth", {"state"}}}));
}

TEST_F(ObserverRun, ChangesNothingForTheVehicle) {
  const auto with = run().metrics.at("rover");
  const auto without = run({"rover.observers.near=null", "rover.observers.exact=null"});
  for (const auto& [name, value] : without.metrics.at("rover")) {
    EXPECT_TRUE(with.at(name) == value || (std::isnan(value) && std::isnan(with.at(name)))) << name;
  }
  EXPECT_FALSE(without.metrics.at("rover").contains("near_nees_mean"));
}

TEST_F(ObserverRun, NamesTheObserverThatWritesNaN) {
  registry_.add_estimator(
      [] {
        PartSpec spec;
        spec.name = "mad";
        return spec;
      }(),
      [](const ParameterSet&, const EstimatorContext&) {
        return std::make_unique<OffsetEstimator>(std::nan(""));
      });
  const RunResult result = run({"rover.observers.wild.type=mad"});
  EXPECT_EQ(result.status, RunStatus::kBrokenOff);
  EXPECT_EQ(result.error,
            "t = 0.000000 s: rover.observers.wild (mad): wrote NaN into signal 'rover/wild'");
}

}  // namespace
}  // namespace vinerow::run::observer_run_test
