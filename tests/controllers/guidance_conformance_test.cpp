// What every registered guidance keeps.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "controllers/register.h"
#include "engine/api/registry.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/dwa/course.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test {
namespace {

const Registry& all_parts() {
  static const Registry registry = [] {
    Registry r;
    register_controllers(r);
    return r;
  }();
  return registry;
}

constexpr Time tick(std::int64_t i) {
  return {i * 100'000'000};
}

/// A guidance alone between signals, in an alley of 2.5 m.
struct Bench {
  explicit Bench(const std::string& type, VehicleDescription d = make_four_wheel_rover())
      : description(std::move(d)) {
    ControllerContext context;
    context.vehicle = "rover";
    context.part = "rover.guidance";
    context.period = Duration{100'000'000};
    context.vehicle_description = &description;
    context.map = &map;
    context.sensors = make_rangers();
    Ports world(bus, "rover", "test");
    estimate = world.write<Odometry>("estimate");
    plan = world.write<PlannedPath>("plan");
    for (const SensorMounting& sensor : context.sensors) {
      ranges.push_back(world.write<RangeSample>(sensor.name));
    }
    const PartSpec& spec = all_parts().spec(PartKind::kGuidance, type);
    ParameterSet parameters(spec.parameters, spec.name);
    guidance = all_parts().make_guidance(type, parameters, context);
    Ports ports(bus, "rover", "rover.guidance");
    guidance->connect(ports);
    command = world.read<LocalCommand>("local_command");
  }

  /// One tick at a pose beside the plan, with echoes from 1.5 m ahead for a while.
  void step_at(std::int64_t i) {
    Odometry odometry;
    odometry.X_WB = {
        quaternion_from_rpy({0, 0, 0.1 * std::sin(0.3 * static_cast<double>(i))}),
        {0.05 * static_cast<double>(i), 0.1 * std::sin(0.2 * static_cast<double>(i)), 0}};
    odometry.v_WB_B.x() = 0.5;
    estimate.write(tick(i), odometry);
    for (SignalWriter<RangeSample>& range : ranges) {
      RangeSample sample;
      sample.range_m = i > 100 && i < 150 ? 1.5 : std::numeric_limits<double>::infinity();
      sample.max_range_m = 4.0;
      sample.half_angle_rad = rad_from_deg(15);
      range.write(tick(i), sample);
    }
    guidance->step(tick(i));
  }

  VehicleDescription description;
  RowMap map = make_map(make_alley());
  SignalBus bus;
  SignalWriter<Odometry> estimate;
  SignalWriter<PlannedPath> plan;
  std::vector<SignalWriter<RangeSample>> ranges;
  std::unique_ptr<Guidance> guidance;
  SignalReader<LocalCommand> command;
};

class EveryGuidance : public testing::TestWithParam<std::string> {};

TEST_P(EveryGuidance, StandsStillWithoutPlanOrEstimate) {
  Bench bench(GetParam());
  bench.guidance->step(tick(0));
  EXPECT_EQ(bench.command.value().mode, LocalCommand::Mode::kStop);
  EXPECT_EQ(bench.command.value().v_mps, 0.0);
  bench.estimate.write(tick(1), Odometry{});
  bench.guidance->step(tick(1));
  EXPECT_EQ(bench.command.value().mode, LocalCommand::Mode::kStop);
  Bench other(GetParam());
  other.plan.write(tick(0), make_alley().plan);
  other.guidance->step(tick(0));
  EXPECT_EQ(other.command.value().mode, LocalCommand::Mode::kStop);
}

TEST_P(EveryGuidance, TakesPlansOfOnePointAndOfNone) {
  for (const int points : {0, 1}) {
    Bench bench(GetParam());
    PlannedPath plan;
    plan.points.resize(points);
    bench.plan.write(tick(0), plan);
    bench.estimate.write(tick(0), Odometry{});
    bench.guidance->step(tick(0));
    EXPECT_EQ(bench.command.value().mode, LocalCommand::Mode::kStop);
  }
}

TEST_P(EveryGuidance, CommandsAreFiniteWithinLimitsAndTheSameTwice) {
  Bench a(GetParam()), b(GetParam());
  bool has_moved = false;
  for (Bench* bench : {&a, &b}) bench->plan.write(tick(0), make_alley().plan);
  for (std::int64_t i = 0; i < 400; ++i) {
    a.step_at(i);
    b.step_at(i);
    const LocalCommand &x = a.command.value(), &y = b.command.value();
    ASSERT_TRUE(std::isfinite(x.v_mps) && std::isfinite(x.front_axle_rad) &&
                std::isfinite(x.rear_axle_rad) && std::isfinite(x.clearance_m));
    ASSERT_LE(std::abs(x.v_mps), 1.6);
    ASSERT_LE(std::abs(x.front_axle_rad), rad_from_deg(23) + 1e-12);
    ASSERT_LE(std::abs(x.rear_axle_rad), rad_from_deg(23) + 1e-12);
    if (x.mode == LocalCommand::Mode::kStop) {
      ASSERT_EQ(x.v_mps, 0.0);
    }
    has_moved = has_moved || x.v_mps > 0.1;
    ASSERT_TRUE(x.mode == y.mode && x.v_mps == y.v_mps && x.front_axle_rad == y.front_axle_rad &&
                x.rear_axle_rad == y.rear_axle_rad && x.clearance_m == y.clearance_m)
        << i;
  }
  EXPECT_TRUE(has_moved);
}

TEST_P(EveryGuidance, AllocatesOnlyToTellAnEvent) {
  Bench bench(GetParam());
  bench.plan.write(tick(0), make_alley().plan);
  bench.step_at(0);
  const SignalBase* news = bench.bus.find("rover/guidance_event");
  std::size_t allocations = 0;
  for (std::int64_t i = 1; i < 400; ++i) {
    const std::uint64_t told = news != nullptr ? news->sequence() : 0;
    AllocationCounter counter;
    bench.step_at(i);
    if (news == nullptr || news->sequence() == told) allocations += counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST_P(EveryGuidance, RefusesVehiclesItDoesNotKnowHowToDrive) {
  VehicleDescription description;
  description.type = "quadrotor";
  description.numbers = {{"arm_m", 0.2}};
  try {
    Bench bench(GetParam(), description);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("rover.guidance (" + GetParam() + ") needs '"), 0u) << text;
    EXPECT_NE(text.find("'quadrotor' does not tell (it tells: arm_m)"), std::string::npos) << text;
  }
}

TEST_P(EveryGuidance, DocumentsItsParametersAndSignals) {
  const PartSpec& spec = all_parts().spec(PartKind::kGuidance, GetParam());
  EXPECT_GT(spec.default_rate_Hz, 0.0);
  EXPECT_FALSE(spec.reads.empty() || spec.writes.empty());
  for (const ParameterSpec& parameter : spec.parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Guidances, EveryGuidance,
                         testing::ValuesIn(all_parts().names(PartKind::kGuidance)),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vinerow::test
