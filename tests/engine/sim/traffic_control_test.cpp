/// Reservation of alleys in a run: where who waits for whom, and what a wreck leaves behind, with
/// distances computed by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "engine/core/error.h"
#include "engine/metrics/register_metrics.h"
#include "engine/sim/simulation.h"
#include "engine/sim/truth_estimator.h"
#include "tests/engine/sim/small_parts.h"

namespace vinerow::traffic_control_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kHalfLength_m = 0.9;
constexpr double kStopBefore_m = 1.0;  // the scenario's default
constexpr double kApproach_m = 4.0;    // AlleyUse's default
// Every plan: 10 m to the rows, 20 m in alley 7, 20 m on.
constexpr double kToTheRows_m = 10.0, kAlley_m = 20.0, kOn_m = 20.0;
/// Where the stretch that needs the alley begins, and where who has not got it stands: its front
/// kStopBefore_m short of there.
constexpr double kNeeds_m = kToTheRows_m - kApproach_m;
constexpr double kStand_m = kNeeds_m - kStopBefore_m - kHalfLength_m;
/// Its tail has left the alley and the way out of it.
constexpr double kLeft_m = kToTheRows_m + kAlley_m + kApproach_m + 2.0 * kHalfLength_m;

/// Wrecked where `crash_s` says so; 1.8 m long.
class Cart final : public Vehicle {
 public:
  explicit Cart(double crash_s) : crash_s_(crash_s) {
    description_.type = "cart";
    description_.collision_half_extents_m = {kHalfLength_m, 0.4, 0.3};
    description_.max_speed_mps = 1.0;
  }
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose& X_WB) override { X_WB_ = X_WB; }
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time now, Duration) override {
    crashed_ = crashed_ || (crash_s_ > 0.0 && now.s() >= crash_s_);
  }
  std::string_view crash() const override { return crashed_ ? "turned over" : std::string_view(); }
  void read_truth(Odometry& truth) const override { truth.X_WB = X_WB_; }
  Eigen::Vector3d specific_force_B() const override { return {0, 0, 9.8}; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  Pose X_WB_;
  double crash_s_;
  bool crashed_ = false;
};

class OneAlley final : public Planner {
 public:
  Result<PlannedPath> plan(const Pose&) override {
    PlannedPath path;
    double x = 0.0;
    const auto add = [&](PathKind kind, int alley, double on_m) {
      PathPoint point;
      point.p_W = {x, 0, 0};
      point.kind = kind;
      point.alley = alley;
      path.points.push_back(point);
      x += on_m;
    };
    add(PathKind::kTransit, -1, kToTheRows_m);
    add(PathKind::kLeg, 0, kAlley_m);
    add(PathKind::kTransit, -1, kOn_m);
    add(PathKind::kTransit, -1, 0.0);
    path.length_m = x;
    return path;
  }
};

/// Drives at `speed_mps`, no farther than its authority, and has finished at `end_m`.
class Driver final : public Controller {
 public:
  Driver(const ParameterSet& parameters, const ControllerContext& context)
      : period_s_(context.period.s()),
        speed_mps_(parameters.number("speed_mps")),
        end_m_(parameters.number("end_m")) {}
  void connect(Ports& ports) override {
    authority_ = ports.read_optional<MovementAuthority>("authority");
    plan_ = ports.read<PlannedPath>("plan");
    actuators_ = ports.write<NamedValues>("actuators");
    follower_ = ports.write<FollowerState>("follower");
  }
  bool finished() const override { return state_.finished; }
  void step(Time now) override {
    double wanted_m = state_.distance_m + speed_mps_ * period_s_;
    if (authority_.has_value()) wanted_m = std::min(wanted_m, authority_.value().stop_at_m);
    state_.distance_m = std::max(state_.distance_m, wanted_m);
    state_.finished = state_.distance_m >= end_m_;
    follower_.write(now, state_);
  }

 private:
  double period_s_, speed_mps_, end_m_;
  FollowerState state_;
  SignalReader<MovementAuthority> authority_;
  SignalReader<PlannedPath> plan_;
  SignalWriter<NamedValues> actuators_;
  SignalWriter<FollowerState> follower_;
};

Registry alley_registry() {
  Registry registry = test::small_registry();
  const auto spec = [](const char* name, std::vector<ParameterSpec> parameters) {
    PartSpec result;
    result.name = name;
    result.description = "for tests";
    result.parameters = std::move(parameters);
    return result;
  };
  registry.add_world(spec("alley", {}), [](const ParameterSet&, const WorldContext& context) {
    auto world = test::make_plain(
        ParameterSet({boolean_parameter("has_map", false, "whether it has an occupancy grid")}),
        context);
    world->rows->alleys.push_back(
        {7, {{kToTheRows_m, 0, 0}, {kToTheRows_m + kAlley_m, 0, 0}}, 2.5});
    return world;
  });
  registry.add_vehicle(
      spec("cart", {number_parameter("crash_s", "s", 0.0, 0.0, 1e3, "wrecked from then on")}),
      [](const ParameterSet& parameters, const VehicleContext&) {
        return std::make_unique<Cart>(parameters.number("crash_s"));
      });
  registry.add_planner(spec("one_alley", {}), [](const ParameterSet&, const PlannerContext&) {
    return std::make_unique<OneAlley>();
  });
  PartSpec driver =
      spec("driver", {number_parameter("speed_mps", "m/s", 1.0, 0.0, 10.0, "along its plan"),
                      number_parameter("end_m", "m", 50.0, 0.0, 1e3, "finished from there on")});
  driver.default_rate_Hz = 20.0;
  driver.reads = {"plan", "authority (optional)"};
  registry.add_controller(driver,
                          [](const ParameterSet& parameters, const ControllerContext& context) {
                            return std::make_unique<Driver>(parameters, context);
                          });
  metrics::register_metrics(registry);
  register_truth_estimator(registry);
  return registry;
}

/// `first` drives ahead at 1 m/s; `second` is half as fast at the start of the same plan.
const char* const kScenario = R"(
vinerow: 1
name: one_alley
duration_s: 60
world: {type: alley}
traffic: {reserve_alleys: [first, second]}
vehicles:
  first:
    type: cart
    on_crash: fail
    spawn: {x_m: 0, y_m: 0}
    planner: {type: one_alley}
    controller: {type: driver}
  second:
    type: cart
    on_crash: fail
    spawn: {x_m: 0, y_m: 5}
    planner: {type: one_alley}
    controller: {type: driver, speed_mps: 0.5}
metrics: {travel: {type: travel}}
)";

const char* const kPhases = R"(
phases:
  ahead: {vehicles: [first], on_failure: continue}
  behind: {vehicles: [second], on_failure: continue}
)";

class AlleyRun : public RunObserver {
 public:
  explicit AlleyRun(const std::vector<std::string>& sets = {}, const std::string& more = "")
      : registry_(alley_registry()) {
    scenario::Overrides overrides;
    overrides.sets = sets;
    simulation_ = std::make_unique<Simulation>(
        scenario::parse_scenario(kScenario + more, ".", registry_, overrides), registry_);
    simulation_->add_observer(this);
  }
  void until(double t_s) { simulation_->run_until(Time{} + duration_from_s(t_s)); }
  template <class T>
  const T& value(const std::string& signal) const {
    return dynamic_cast<const Signal<T>&>(*simulation_->bus().find(signal)).value();
  }
  const MovementAuthority& authority(const std::string& vehicle) const {
    return value<MovementAuthority>(vehicle + "/authority");
  }
  double distance_m(const std::string& vehicle) const {
    return value<FollowerState>(vehicle + "/follower").distance_m;
  }
  void on_event(Time, const Event& event) override {
    if (event.level == Event::Level::kError) errors_.push_back(event.source + ": " + event.text);
  }
  const std::vector<std::string>& errors() const { return errors_; }
  std::vector<Crash> crashes() const { return simulation_->crashes(); }
  double now_s() const { return simulation_->now().s(); }

 private:
  Registry registry_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<std::string> errors_;
};

TEST(TrafficControl, WhoWaitsStandsWithItsFrontBeforeTheAlley) {
  AlleyRun run;
  run.until(20.0);
  EXPECT_NEAR(run.distance_m("first"), 20.0, 0.11);
  EXPECT_TRUE(std::isinf(run.authority("first").stop_at_m));
  const MovementAuthority& second_authority = run.authority("second");
  EXPECT_DOUBLE_EQ(second_authority.stop_at_m, kStand_m);
  EXPECT_EQ(second_authority.alley, 7);
  EXPECT_EQ(second_authority.holder, "first");
  EXPECT_DOUBLE_EQ(run.distance_m("second"), kStand_m);
}

TEST(TrafficControl, AnAlleyIsFreeWhenTheTailHasLeftIt) {
  AlleyRun run;
  double t_s = 20.0, first_m = 0.0;
  while (t_s < 60.0 && std::isfinite(run.authority("second").stop_at_m)) {
    first_m = run.distance_m("first");
    run.until(t_s += 0.05);
  }
  // One tick before it was free the tail was still in it; a tick is 5 cm.
  EXPECT_NEAR(first_m, kLeft_m, 0.11);
}

TEST(TrafficControl, AWreckKeepsItsAlleyClosed) {
  AlleyRun run({"first.crash_s=15"});
  run.until(59.0);
  EXPECT_DOUBLE_EQ(run.authority("second").stop_at_m, kStand_m);
  EXPECT_EQ(run.authority("second").holder, "first");
  EXPECT_DOUBLE_EQ(run.distance_m("second"), kStand_m);
  ASSERT_EQ(run.errors().size(), 2u);
  EXPECT_THAT(run.errors()[0], HasSubstr("crashed: turned over"));
  EXPECT_EQ(run.errors()[1],
            "second: gave up: second waits for alley 7, in which first has stopped");
  ASSERT_EQ(run.crashes().size(), 2u);
  EXPECT_EQ(run.crashes()[1].vehicle, "second");
}

TEST(TrafficControl, ADeadlockEndsARunLikeACrash) {
  AlleyRun run({"first.crash_s=15", "second.on_crash=end"});
  run.until(59.0);
  EXPECT_LT(run.now_s(), 30.0);
  ASSERT_EQ(run.crashes().size(), 2u);
}

TEST(TrafficControl, APhaseOfAMissionFailsByADeadlock) {
  AlleyRun run({"first.crash_s=15"}, kPhases);
  run.until(59.0);
  EXPECT_THAT(run.errors(), Contains("traffic: second waits for alley 7, in which first has "
                                     "stopped"));
  ASSERT_EQ(run.crashes().size(), 1u);
  EXPECT_EQ(run.crashes()[0].vehicle, "first");
}

TEST(TrafficControl, AWreckBeyondTheAlleyClosesNothing) {
  AlleyRun run({"first.crash_s=40"});
  run.until(59.0);
  EXPECT_GT(run.distance_m("first"), kLeft_m);
  EXPECT_TRUE(std::isinf(run.authority("second").stop_at_m));
}

TEST(TrafficControl, WhoIsStoppedInAnAlleyKeepsItAndWhoHasFinishedThereDoesNot) {
  AlleyRun stopped({"phases.ahead.timeout_s=15"}, kPhases);
  stopped.until(59.0);
  EXPECT_DOUBLE_EQ(stopped.authority("second").stop_at_m, kStand_m);
  EXPECT_EQ(stopped.authority("second").holder, "first");

  AlleyRun finished({"first.controller.end_m=15"}, kPhases);
  finished.until(40.0);
  EXPECT_TRUE(std::isinf(finished.authority("second").stop_at_m));
  EXPECT_GT(finished.distance_m("second"), kStand_m + 5.0);
}

TEST(TrafficControl, RefusesAControllerThatCannotWait) {
  try {
    AlleyRun run({"second.controller={type: teller}"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("neither guidance nor controller of 'second' reads the "
                                        "signal 'authority', so it cannot wait for an alley"));
  }
}

}  // namespace
}  // namespace vinerow::traffic_control_test
