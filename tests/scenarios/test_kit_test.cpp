/// The test kit: every kind of part comes by factory, without a plug-in; missions have phases and
/// jobs. The parts do the least that shows that they were built, wired and stepped.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "tests/support/spec_makers.h"
#include "vinerow/testing.h"

namespace vinerow::test_kit_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::SmallWorld;
using testing::TestRun;

PartSpec spec(const char* name, std::vector<ParameterSpec> parameters = {}) {
  PartSpec result;
  result.name = name;
  result.description = "for tests";
  result.parameters = std::move(parameters);
  result.default_rate_Hz = 20.0;
  return result;
}

ParameterSpec size_parameter() {
  return number_parameter("size_m", "m", 1.0, 0.0, 100.0, "of what it makes");
}

SmallWorld rover() {
  return std::move(SmallWorld().vehicle("rover", "diff_drive_rover"));
}

/// A message type of a plugin, not one of Vinerow.
struct SoilSample {
  static constexpr const char* kType = "acme/SoilSample";
  double depth_m = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"depth", "m"}, self.depth_m);
  }
};

/// Writes a SoilSample under its own name.
class Probe final : public Sensor {
 public:
  Probe(const ParameterSet& parameters, const SensorContext& context)
      : name_(context.name), depth_m_(parameters.number("size_m")) {}
  void connect(Ports& ports) override { sample_ = ports.write<SoilSample>(name_); }
  void step(Time now) override { sample_.write(now, {depth_m_}); }

 private:
  std::string name_;
  double depth_m_;
  SignalWriter<SoilSample> sample_;
};

/// The truth, so much too far to the east.
class Shifted final : public Estimator {
 public:
  explicit Shifted(const ParameterSet& parameters) : shift_m_(parameters.number("size_m")) {}
  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    estimate_ = ports.write<Odometry>("estimate");
  }
  void step(Time now) override {
    Odometry estimate = truth_.value();
    estimate.X_WB.p.x() += shift_m_;
    estimate_.write(now, estimate);
  }

 private:
  double shift_m_;
  SignalReader<Odometry> truth_;
  SignalWriter<Odometry> estimate_;
};

/// A straight path of that length.
class StraightOn final : public Planner {
 public:
  explicit StraightOn(const ParameterSet& parameters) : length_m_(parameters.number("size_m")) {}
  Result<PlannedPath> plan(const Pose& start) override {
    PlannedPath path;
    path.points.resize(2);
    path.points[0].p_W = start.p;
    path.points[1].p_W = start * Eigen::Vector3d(length_m_, 0, 0);
    path.length_m = length_m_;
    return path;
  }

 private:
  double length_m_;
};

/// Wants to stand still, that far from anything.
class StandStill final : public Guidance {
 public:
  explicit StandStill(const ParameterSet& parameters) : clear_m_(parameters.number("size_m")) {}
  void connect(Ports& ports) override { command_ = ports.write<LocalCommand>("local_command"); }
  void step(Time now) override {
    LocalCommand command;
    command.clearance_m = clear_m_;
    command_.write(now, command);
  }

 private:
  double clear_m_;
  SignalWriter<LocalCommand> command_;
};

/// Drives nothing, publishes how many alleys its map has, and has finished at its tenth tick.
class MapReader final : public Controller {
 public:
  explicit MapReader(const ControllerContext& context)
      : alleys_(static_cast<double>(context.map->alleys.size())) {}
  void connect(Ports& ports) override {
    actuators_ = ports.write<NamedValues>("actuators");
    seen_ = ports.write<NamedValues>("map_alleys");
  }
  void step(Time now) override {
    ++ticks_;
    seen_.write(now, {{"alleys"}, {alleys_}});
  }
  bool finished() const override { return ticks_ >= 10; }

 private:
  double alleys_;
  int ticks_ = 0;
  SignalWriter<NamedValues> actuators_, seen_;
};

/// Counts its ticks.
class TickPayload final : public Payload {
 public:
  void connect(Ports&) override {}
  void step(Time) override { ++ticks_; }
  std::map<std::string, double> results() const override { return {{"ticks", ticks_}}; }

 private:
  double ticks_ = 0.0;
};

class TickMetric final : public Metric {
 public:
  void connect(Ports&) override {}
  void step(Time) override { ++ticks_; }
  std::map<std::string, double> results() const override { return {{"metric_ticks", ticks_}}; }

 private:
  double ticks_ = 0.0;
};

/// Stands where it was put.
class Statue final : public Vehicle {
 public:
  explicit Statue(const ParameterSet& parameters) {
    description_.type = "statue";
    description_.mass_kg = parameters.number("mass_kg");
  }
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose& X_WB) override { X_WB_ = X_WB; }
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time, Duration) override {}
  void read_truth(Odometry& truth) const override { truth.X_WB = X_WB_; }
  Eigen::Vector3d specific_force_B() const override { return {0, 0, 9.8}; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  Pose X_WB_;
};

std::shared_ptr<RowMap> map_of(int alleys) {
  auto map = std::make_shared<RowMap>();
  for (int id = 0; id < alleys; ++id) {
    const double x_m = 2.5 * id;
    map->alleys.push_back({id, {{x_m, 0, 0}, {x_m, 20, 0}}, 2.5});
  }
  return map;
}

/// Gives a map with that many alleys.
class Surveyor final : public Job {
 public:
  explicit Surveyor(const ParameterSet& parameters) : alleys_(parameters.integer("alleys")) {}
  Result<JobOutcome> run(const std::map<std::string, Product>&) override {
    JobOutcome outcome;
    outcome.product.kind = ProductKind::kMap;
    outcome.product.map = map_of(static_cast<int>(alleys_));
    outcome.numbers["alleys"] = static_cast<double>(alleys_);
    return outcome;
  }

 private:
  std::int64_t alleys_;
};

/// A factory for parts of class T, whatever of parameters and context it takes.
template <class Base, class T, class Context>
PartFactory<Base, Context> factory() {
  return [](const ParameterSet& parameters, const Context& context) -> std::unique_ptr<Base> {
    if constexpr (std::is_constructible_v<T, const ParameterSet&, const Context&>) {
      return std::make_unique<T>(parameters, context);
    } else if constexpr (std::is_constructible_v<T, const ParameterSet&>) {
      return std::make_unique<T>(parameters);
    } else if constexpr (std::is_constructible_v<T, const Context&>) {
      return std::make_unique<T>(context);
    } else {
      return std::make_unique<T>();
    }
  };
}

const auto make_map_reader = factory<Controller, MapReader, ControllerContext>();
const auto make_shifted = factory<Estimator, Shifted, EstimatorContext>();
const auto make_statue = factory<Vehicle, Statue, VehicleContext>();

PartSpec statue_spec() {
  return spec("statue", {number_parameter("mass_kg", "kg", 10.0, 0.0, 1e3, "of all of it")});
}

double reported_alleys(const TestRun& run) {
  return run.signal<NamedValues>("rover/map_alleys").values.at(0);
}

TEST(TestKit, TakesASensorWithAMessageOfItsOwn) {
  TestRun run = rover()
                    .sensor("rover", "probe", spec("probe", {size_parameter()}),
                            factory<Sensor, Probe, SensorContext>(), "size_m: 0.25")
                    .sensor("rover", "deep_probe", "probe", "size_m: 4")
                    .build();
  run.run_for_s(0.2);
  EXPECT_EQ(run.signal<SoilSample>("rover/probe").depth_m, 0.25);
  EXPECT_EQ(run.signal<SoilSample>("rover/deep_probe").depth_m, 4.0);
  EXPECT_THROW(run.signal<RangeSample>("rover/probe"), ConfigError);
}

TEST(TestKit, TakesAnEstimatorAndAnObserver) {
  TestRun run = rover()
                    .estimator("rover", spec("shifted", {size_parameter()}), make_shifted)
                    .observer("rover", "other", "shifted", "size_m: 2")
                    .observer("rover", "third", spec("shifted_too", {size_parameter()}),
                              make_shifted, "size_m: 3")
                    .build();
  run.run_for_s(0.2);
  const double x_m = run.signal<Odometry>("rover/estimate").X_WB.p.x();
  EXPECT_NEAR(x_m - run.truth("rover").X_WB.p.x(), 1.0, 0.01);
  EXPECT_DOUBLE_EQ(run.signal<Odometry>("rover/other").X_WB.p.x(), x_m + 1.0);
  EXPECT_DOUBLE_EQ(run.signal<Odometry>("rover/third").X_WB.p.x(), x_m + 2.0);
}

TEST(TestKit, TakesAPlannerAndDrivesItsPath) {
  TestRun run = rover()
                    .planner("rover", spec("straight_on", {size_parameter()}),
                             factory<Planner, StraightOn, PlannerContext>(), "size_m: 5")
                    .controller("rover", "pure_pursuit")
                    .build();
  run.run_for_s(4.0);
  EXPECT_EQ(run.signal<PlannedPath>("rover/plan").length_m, 5.0);
  EXPECT_GT(run.metric("rover", "distance_m"), 1.0);
}

TEST(TestKit, TakesGuidance) {
  TestRun run = rover()
                    .guidance("rover", spec("stand_still", {size_parameter()}),
                              factory<Guidance, StandStill, ControllerContext>(), "size_m: 0.5")
                    .controller("rover", spec("map_reader"), make_map_reader)
                    .build();
  run.run_for_s(0.2);
  EXPECT_EQ(run.signal<LocalCommand>("rover/local_command").clearance_m, 0.5);
}

TEST(TestKit, TakesAMapAndAController) {
  const auto four_alleys = [](const ParameterSet&, const MapContext& context) {
    EXPECT_EQ(context.world->rows->alleys.size(), 1u);
    return std::make_unique<RowMap>(*map_of(4));
  };
  TestRun run = rover()
                    .map("rover", spec("four_alleys"), four_alleys)
                    .controller("rover", spec("map_reader"), make_map_reader)
                    .build();
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(reported_alleys(run), 4.0);
}

TEST(TestKit, TakesAPayloadAndAMetric) {
  TestRun run = rover()
                    .payload("rover", "counter", spec("tick_payload"),
                             factory<Payload, TickPayload, PayloadContext>(), "rate_Hz: 10")
                    .metric(spec("tick_metric"), factory<Metric, TickMetric, MetricContext>())
                    .build();
  run.run_for_s(1.0);
  EXPECT_EQ(run.metric("rover", "counter_ticks"), 10.0);
  EXPECT_EQ(run.metric("rover", "metric_ticks"), 20.0);
}

TEST(TestKit, TakesAWorldAndAVehicle) {
  const auto make_plain = [](const ParameterSet& parameters, const WorldContext&) {
    auto world = std::make_unique<WorldModel>();
    world->name = "plain";
    HeightField ground;
    ground.columns = ground.rows = 3;
    ground.cell_m = 10.0;
    ground.corner_W = {-10, -10};
    ground.heights_m.assign(9, static_cast<float>(parameters.number("size_m")));
    world->terrain = ground;
    return world;
  };
  TestRun run =
      SmallWorld()
          .world(spec("plain", {size_parameter()}), make_plain, "size_m: 7")
          .vehicle("hermes", statue_spec(), make_statue, "mass_kg: 5, spawn: {x_m: 3, y_m: -2}")
          .build();
  run.run_for_s(0.2);
  EXPECT_EQ(run.truth("hermes").X_WB.p, Eigen::Vector3d(3, -2, 7));
}

TEST(TestKit, RunsAMissionWithAJobOfItsOwn) {
  PartSpec job = spec("surveyor", {integer_parameter("alleys", 1, 0, 100, "of the map")});
  job.default_rate_Hz = 0.0;
  job.gives = ProductKind::kMap;
  TestRun run =
      rover()
          .vehicle("hermes", statue_spec(), make_statue, "spawn: {alley: 0, offset_m: -10}")
          .controller("rover", spec("map_reader"), make_map_reader)
          .controller("hermes", "map_reader")
          .phase("wait", {"hermes"})
          .job("survey", job, factory<Job, Surveyor, JobContext>(), "alleys: 6",
               "after: [wait], duration_s: 2")
          .phase("work", {"rover"}, "map: from survey, timeout_s: 30")
          .build();
  run.run_to_end();
  std::vector<std::string> states;
  for (const SessionPhase& phase : run.session().phases()) {
    states.push_back(phase.name + " " + phase.state);
  }
  EXPECT_THAT(states, ElementsAre("wait succeeded", "survey succeeded", "work succeeded"));
  EXPECT_EQ(reported_alleys(run), 6.0);
  // Ten ticks of 50 ms, the first at once, before and after the 2 s of the job.
  EXPECT_NEAR(run.time_s(), 0.45 + 2.0 + 0.45, 0.01);
}

TEST(TestKit, NamesABuiltInJobAsAFileDoes) {
  const SmallWorld world = std::move(rover()
                                         .controller("rover", spec("map_reader"), make_map_reader)
                                         .planner("rover", "coverage")
                                         .job("plan", "plan", "vehicle: rover")
                                         .phase("work", {"rover"}, "plan: from plan"));
  EXPECT_THAT(world.yaml(), HasSubstr("phases:\n  plan: {job: {type: plan, vehicle: rover}}\n"
                                      "  work: {vehicles: [rover], plan: from plan}\n"));
  EXPECT_TRUE(world.build().run_to_end().finished());
}

TEST(TestKit, RefusesWhatAFileMayNotSay) {
  EXPECT_THROW(rover()
                   .sensor("rover", "probe", spec("probe", {size_parameter()}),
                           factory<Sensor, Probe, SensorContext>(), "size_m: -1")
                   .build(),
               ConfigError);
  EXPECT_THROW(rover().payload("drone", "sprayer", "sprayer"), ConfigError);
  EXPECT_THROW(rover().phase("work", {"drone"}).build(), ConfigError);
}

}  // namespace
}  // namespace vinerow::test_kit_test
